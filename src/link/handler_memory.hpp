// Memory for what Asio keeps of an operation under way. Its own cache has two blocks for a whole thread: with several
// printers on the feed thread it would go to the heap again and again, and the heap may lock.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <new>
#include <utility>

namespace linefeed::link {

/// A few blocks, for the operations of one owner, on one thread. What does not fit comes from the heap.
class HandlerMemory {
public:
    static constexpr std::size_t block_bytes = 512; ///< more than Asio takes for any operation here
    static constexpr std::size_t blocks = 8;        ///< a read, a wait, and a timer that is set anew several times

    HandlerMemory() = default;
    HandlerMemory(const HandlerMemory&) = delete;
    HandlerMemory& operator=(const HandlerMemory&) = delete;

    [[nodiscard]] void* allocate(std::size_t bytes) {
        for (std::size_t i = 0; i < blocks && bytes <= block_bytes; ++i) {
            if (!used_[i]) {
                used_[i] = true;
                return blocks_[i].bytes.data();
            }
        }
        return ::operator new(bytes);
    }
    void release(void* memory) noexcept {
        for (std::size_t i = 0; i < blocks; ++i) {
            if (memory == blocks_[i].bytes.data()) {
                used_[i] = false;
                return;
            }
        }
        ::operator delete(memory);
    }

private:
    struct alignas(std::max_align_t) Block {
        std::array<std::byte, block_bytes> bytes;
    };
    std::array<Block, blocks> blocks_;
    std::array<bool, blocks> used_{};
};

/// Lets a handler's operation live in a HandlerMemory: `asio::bind_allocator(HandlerAllocator<>{memory}, handler)`. The
/// memory lives as long as any operation in it.
template <typename T = std::byte>
class HandlerAllocator {
public:
    using value_type = T;

    explicit HandlerAllocator(std::shared_ptr<HandlerMemory> memory) noexcept
        : memory_(std::move(memory)) {}
    template <typename Other>
    HandlerAllocator(
        const HandlerAllocator<Other>& other) noexcept // NOLINT(google-explicit-constructor): allocators are converted
        : memory_(other.memory()) {}

    [[nodiscard]] T* allocate(std::size_t count) { return static_cast<T*>(memory_->allocate(count * sizeof(T))); }
    void deallocate(T* values, std::size_t) noexcept { memory_->release(values); }

    [[nodiscard]] const std::shared_ptr<HandlerMemory>& memory() const { return memory_; }
    template <typename Other>
    friend bool operator==(const HandlerAllocator& one, const HandlerAllocator<Other>& other) {
        return one.memory_ == other.memory();
    }

private:
    std::shared_ptr<HandlerMemory> memory_;
};

} // namespace linefeed::link
