// A list with storage of its own and a fixed capacity: effects and actions are returned in it without allocation. Only
// the values in it exist, so that an empty list costs nothing, however large its capacity.
#pragma once

#include "base/assert.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>

namespace linefeed {

/// Up to `Capacity` values in order. Going beyond the capacity is a programming error and aborts.
template <typename T, std::size_t Capacity>
class BoundedList {
    static_assert(std::is_nothrow_move_constructible_v<T>);

public:
    using value_type = T;
    using const_iterator = const T*;

    BoundedList() noexcept {} // NOLINT(modernize-use-equals-default): defaulted, `{}` would fill the storage with zeros
    BoundedList(const BoundedList& other)
        : BoundedList() {
        append(other.begin(), other.end());
    }
    BoundedList(BoundedList&& other) noexcept
        : BoundedList() {
        append(std::make_move_iterator(other.begin()), std::make_move_iterator(other.end()));
    }
    BoundedList& operator=(const BoundedList& other) {
        if (this != &other) {
            clear();
            append(other.begin(), other.end());
        }
        return *this;
    }
    BoundedList& operator=(BoundedList&& other) noexcept {
        if (this != &other) {
            clear();
            append(std::make_move_iterator(other.begin()), std::make_move_iterator(other.end()));
        }
        return *this;
    }
    ~BoundedList() { clear(); }

    /// The value is made in its place: an alternative does not go through a temporary variant.
    template <typename Value = T>
    void push_back(Value&& value) {
        LINEFEED_ASSERT(size_ < Capacity);
        std::construct_at(storage_.items + size_, std::forward<Value>(value));
        ++size_;
    }
    /// Removes one value; the order of the rest stays.
    void erase(std::size_t index) {
        LINEFEED_ASSERT(index < size_);
        std::move(begin() + static_cast<std::ptrdiff_t>(index) + 1, end(),
                  begin() + static_cast<std::ptrdiff_t>(index));
        --size_;
        std::destroy_at(storage_.items + size_);
    }
    void clear() noexcept {
        std::destroy_n(storage_.items, size_);
        size_ = 0;
    }
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] bool empty() const { return size_ == 0; }
    [[nodiscard]] bool full() const { return size_ == Capacity; }
    [[nodiscard]] const T& operator[](std::size_t index) const {
        LINEFEED_ASSERT(index < size_);
        return storage_.items[index];
    }
    [[nodiscard]] T& operator[](std::size_t index) {
        LINEFEED_ASSERT(index < size_);
        return storage_.items[index];
    }
    [[nodiscard]] const T* begin() const { return storage_.items; }
    [[nodiscard]] const T* end() const { return storage_.items + size_; }
    [[nodiscard]] T* begin() { return storage_.items; }
    [[nodiscard]] T* end() { return storage_.items + size_; }

private:
    template <typename Iterator>
    void append(Iterator from, Iterator to) {
        for (; from != to; ++from) {
            std::construct_at(storage_.items + size_, *from);
            ++size_;
        }
    }

    /// Room for the values, which come to life one by one.
    union Storage {
        Storage() noexcept {}
        ~Storage() {}
        T items[Capacity];
    };

    Storage storage_;
    std::size_t size_ = 0;
};

} // namespace linefeed
