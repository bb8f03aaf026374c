// A list with storage of its own and a fixed capacity: effects and actions are returned in it without allocation.
#pragma once

#include "base/assert.hpp"

#include <array>
#include <cstddef>
#include <utility>

namespace linefeed {

/// Up to `Capacity` values in order. Going beyond the capacity is a programming error and aborts.
template <typename T, std::size_t Capacity>
class BoundedList {
public:
    void push_back(T value) {
        LINEFEED_ASSERT(size_ < Capacity);
        items_[size_++] = std::move(value);
    }
    /// Removes one value; the order of the rest stays.
    void erase(std::size_t index) {
        LINEFEED_ASSERT(index < size_);
        for (std::size_t i = index + 1; i < size_; ++i) {
            items_[i - 1] = std::move(items_[i]);
        }
        --size_;
    }
    void clear() { size_ = 0; }
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] bool empty() const { return size_ == 0; }
    [[nodiscard]] bool full() const { return size_ == Capacity; }
    [[nodiscard]] const T& operator[](std::size_t index) const {
        LINEFEED_ASSERT(index < size_);
        return items_[index];
    }
    [[nodiscard]] T& operator[](std::size_t index) {
        LINEFEED_ASSERT(index < size_);
        return items_[index];
    }
    [[nodiscard]] auto begin() const { return items_.begin(); }
    [[nodiscard]] auto end() const { return items_.begin() + static_cast<std::ptrdiff_t>(size_); }
    [[nodiscard]] auto begin() { return items_.begin(); }
    [[nodiscard]] auto end() { return items_.begin() + static_cast<std::ptrdiff_t>(size_); }

private:
    std::array<T, Capacity> items_{};
    std::size_t size_ = 0;
};

} // namespace linefeed
