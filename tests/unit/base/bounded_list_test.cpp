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

TEST(BoundedList, shouldCloseTheGapOfAnErasedValue) {
    BoundedList<std::string, 3> list;
    list.push_back("?RS");
    list.push_back("?SM");
    list.push_back("?CC");
    list.erase(1);
    EXPECT_THAT(list, ElementsAre("?RS", "?CC"));
}

TEST(BoundedList, shouldCopyAndMoveWhatIsInIt) {
    using List = BoundedList<std::shared_ptr<int>, 3>;
    const auto value = std::make_shared<int>(7);
    List list;
    list.push_back(value);
    list.push_back(value);
    List copy{list};
    EXPECT_EQ(value.use_count(), 5);
    copy = list;
    EXPECT_EQ(value.use_count(), 5);
    const List moved{std::move(copy)};
    EXPECT_EQ(value.use_count(), 5);
    EXPECT_THAT(moved, ElementsAre(value, value));
    list = List{};
    EXPECT_EQ(value.use_count(), 3);
}

TEST(BoundedList, shouldEndTheLifeOfWhatLeavesIt) {
    const auto value = std::make_shared<int>(7);
    {
        BoundedList<std::shared_ptr<int>, 3> list;
        list.push_back(value);
        list.push_back(value);
        list.push_back(value);
        EXPECT_EQ(value.use_count(), 4);
        list.erase(0);
        EXPECT_EQ(value.use_count(), 3);
        list.clear();
        EXPECT_EQ(value.use_count(), 1);
        list.push_back(value);
    }
    EXPECT_EQ(value.use_count(), 1);
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
