// The list of fixed capacity in which the core returns its actions.
#include "base/bounded_list.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace linefeed {
namespace {

using testing::ElementsAre;

TEST(BoundedList, shouldKeepTheOrder) {
    BoundedList<std::string, 3> list;
    list.push_back("!GO");
    list.push_back("?SM");
    EXPECT_THAT(std::vector<std::string>(list.begin(), list.end()), ElementsAre("!GO", "?SM"));
    EXPECT_EQ(list.size(), 2U);
    EXPECT_FALSE(list.full());
}

TEST(BoundedList, shouldBeEmptyAtFirstAndFullAtItsCapacity) {
    BoundedList<int, 2> list;
    EXPECT_TRUE(list.empty());
    list.push_back(1);
    EXPECT_FALSE(list.empty());
    list.push_back(2);
    EXPECT_TRUE(list.full());
}

TEST(BoundedList, shouldTakeValuesAgainAfterClear) {
    BoundedList<int, 1> list;
    list.push_back(1);
    list.clear();
    EXPECT_TRUE(list.empty());
    list.push_back(2);
    EXPECT_EQ(list[0], 2);
}

TEST(BoundedList, shouldAllowChangesThroughIndexAndIterator) {
    BoundedList<int, 2> list;
    list.push_back(1);
    list.push_back(2);
    list[0] = 10;
    for (int& value : list) {
        ++value;
    }
    const auto& unchanging = list;
    EXPECT_EQ(unchanging[0], 11);
    EXPECT_THAT(std::vector<int>(unchanging.begin(), unchanging.end()), ElementsAre(11, 3));
}

TEST(BoundedList, shouldTakeValuesThatCanOnlyBeMoved) {
    BoundedList<std::unique_ptr<int>, 1> list;
    list.push_back(std::make_unique<int>(7));
    EXPECT_EQ(*list[0], 7);
}

TEST(BoundedListDeathTest, shouldAbortBeyondTheCapacity) {
    BoundedList<int, 1> list;
    list.push_back(1);
    EXPECT_DEATH(list.push_back(2), "size_ < Capacity");
}

TEST(BoundedListDeathTest, shouldAbortOnAnIndexBehindTheEnd) {
    BoundedList<int, 2> list;
    list.push_back(1);
    const auto& unchanging = list;
    EXPECT_DEATH(static_cast<void>(list[1]), "index < size_");
    EXPECT_DEATH(static_cast<void>(unchanging[1]), "index < size_");
}

} // namespace
} // namespace linefeed
