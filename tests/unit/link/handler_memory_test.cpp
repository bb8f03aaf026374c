// The blocks for Asio's operations: taken, given back, and the heap for the rest.
#include "link/handler_memory.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <vector>

namespace linefeed::link {
namespace {

TEST(HandlerMemory, shouldGiveABlockAgainOnceItIsReleased) {
    HandlerMemory memory;
    void* const first = memory.allocate(100);
    void* const second = memory.allocate(HandlerMemory::block_bytes);
    EXPECT_NE(first, second);
    memory.release(first);
    EXPECT_EQ(memory.allocate(HandlerMemory::block_bytes), first);
    memory.release(first);
    memory.release(second);
}

TEST(HandlerMemory, shouldTakeFromTheHeapWhatDoesNotFit) {
    HandlerMemory memory;
    void* const large = memory.allocate(HandlerMemory::block_bytes + 1);
    std::memset(large, 1, HandlerMemory::block_bytes + 1);
    std::array<void*, HandlerMemory::blocks> all{};
    for (void*& block : all) {
        block = memory.allocate(1);
    }
    void* const one_more = memory.allocate(1);
    std::memset(one_more, 1, 1);
    memory.release(one_more);
    memory.release(large);
    for (void* const block : all) {
        memory.release(block);
    }
    EXPECT_EQ(memory.allocate(1), all[0]);
    memory.release(all[0]);
}

TEST(HandlerAllocator, shouldKeepTheMemoryAlive) {
    auto memory = std::make_shared<HandlerMemory>();
    std::vector<int, HandlerAllocator<int>> numbers{HandlerAllocator<>{memory}};
    EXPECT_TRUE(numbers.get_allocator() == HandlerAllocator<>{memory});
    memory.reset();
    numbers.push_back(7);
    EXPECT_EQ(numbers.front(), 7);
}

} // namespace
} // namespace linefeed::link
