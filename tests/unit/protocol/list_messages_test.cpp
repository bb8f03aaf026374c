// Error list and event list: entries, blocks, and the list put together from them.
#include "parsing.hpp"

#include <string>

namespace linefeed::protocol {
namespace {

ErrorEntry error(std::uint32_t number) {
    return {{2024, 5, 6, 7, 8, 9}, {static_cast<std::int32_t>(number)}};
}

ErrorListBlock block(std::uint32_t first, std::uint32_t total, std::uint32_t count) {
    ErrorListBlock made{first, total, {}};
    for (std::uint32_t i = 0; i < count; ++i) {
        made.entries.push_back(error(first + i));
    }
    return made;
}

TEST(ErrorList, shouldReadEntriesPaddedOrNotSignedOrNot) {
    const auto list = parsed_as<ErrorListBlock>("^0=EL1\t4\t4\t24-05-06 07:08:09/00005043\t24-05-06 07:08:09/5043\t"
                                                "24-05-06 07:08:09/-1711274809\t24-05-06 07:08:09/2583692487/new\r");
    EXPECT_EQ(list.entries[0], error(5043));
    EXPECT_EQ(list.entries[1], error(5043));
    EXPECT_EQ(list.entries[2].error.code(), 1223U);
    EXPECT_EQ(list.entries[3], list.entries[2]);
}

TEST(ErrorList, shouldRefuseWhatIsNoBlock) {
    EXPECT_EQ(reason("^0=EL1\t1\t1\r"), "=EL: parameter 4 is missing: an entry");
    EXPECT_EQ(reason("^0=EL1\t1\t1\tyesterday/5\r"), "=EL: parameter 4 is not an entry: \"yesterday/5\"");
    EXPECT_EQ(reason("^0=EL1\t1\t1\t24-05-06 07:08:09/x\r"),
              "=EL: parameter 4 is not an entry: \"24-05-06 07:08:09/x\"");
    EXPECT_EQ(reason("^0=EL1\t99\t33\r"), "=EL: parameter 3 is not a number of entries: \"33\"");
    EXPECT_EQ(parsed_as<ErrorListBlock>("^0=EL1\t0\t0\r"), (ErrorListBlock{1, 0, {}}));
}

TEST(EventList, shouldReadItsNineParts) {
    const auto list =
        parsed_as<EventListBlock>("^0=EV1\t1\t1\t24-05-06 07:08:09/30/2/11/40/2400/1000/7100/6/new\texcess\r");
    EXPECT_EQ(list.entries.at(0),
              (EventEntry{{2024, 5, 6, 7, 8, 9}, 30, 2, 11, 40, 2400, 1000, 7100, MachineState::printing}));
    EXPECT_EQ(reason("^0=EV1\t1\t1\t24-05-06 07:08:09/30/2/11/40/2400/1000/7100\r"),
              "=EV: parameter 4 is not an entry: \"24-05-06 07:08:09/30/2/11/40/2400/1000/7...\"");
    EXPECT_EQ(parsed_as<EventListBlock>("^0=EV1\t1\t1\t00-00-00 07:08::09/1/1/1/1/1/1/1/7\r").entries.at(0),
              (EventEntry{{2000, 0, 0, 7, 8, 9}, 1, 1, 1, 1, 1, 1, 1, MachineState::unknown}))
        << "a clock that was never set, the colons of the manual, and a state of other firmware";
    EXPECT_EQ(reason("^0=EV1\t1\t1\t24-05-06 07:08:09/x/1/1/1/1/1/1/6\r"),
              "=EV: parameter 4 is not an entry: \"24-05-06 07:08:09/x/1/1/1/1/1/1/6\"");
    EXPECT_EQ(reason("^0=EV1\t99\t17\r"), "=EV: parameter 3 is not a number of entries: \"17\"");
}

TEST(ListAssembly, shouldPutBlocksTogether) {
    ListAssembly<ErrorListBlock> list;
    EXPECT_EQ(list.add(block(1, 34, 32)), ListProgress::needs_more);
    EXPECT_EQ(list.add(block(33, 34, 2)), ListProgress::complete);
    ASSERT_EQ(list.entries().size(), 34U);
    EXPECT_EQ(list.entries().back(), error(34));
    EXPECT_EQ(list.add(block(1, 1, 1)), ListProgress::complete) << "the next answer";
    EXPECT_EQ(list.entries().size(), 1U);
}

TEST(ListAssembly, shouldTakeAnEmptyListHoweverItIsCounted) {
    ListAssembly<EventListBlock> list;
    EXPECT_EQ(list.add({1, 0, {}}), ListProgress::complete);
    EXPECT_EQ(list.add({0, 0, {}}), ListProgress::complete);
    EXPECT_TRUE(list.entries().empty());
}

TEST(ListAssembly, shouldNoticeALostBlockAndAListThatChanged) {
    ListAssembly<ErrorListBlock> list;
    EXPECT_EQ(list.add(block(33, 34, 2)), ListProgress::broken) << "the first block was lost";
    EXPECT_EQ(list.add(block(1, 66, 32)), ListProgress::needs_more);
    EXPECT_EQ(list.add(block(65, 66, 2)), ListProgress::broken) << "the second was";
    EXPECT_EQ(list.add(block(1, 34, 32)), ListProgress::needs_more);
    EXPECT_EQ(list.add(block(33, 35, 3)), ListProgress::broken) << "an error came in between";
    EXPECT_EQ(list.add(block(1, 1, 2)), ListProgress::broken) << "more than there are";
    EXPECT_EQ(list.add(block(1, 34, 0)), ListProgress::broken) << "would never end";
    EXPECT_EQ(list.add(block(1, 5000, 32)), ListProgress::broken) << "more than is believed";
    EXPECT_TRUE(list.entries().empty());
    EXPECT_EQ(list.add(block(1, 2, 2)), ListProgress::complete) << "asked again";
}

TEST(ListBlocks, shouldBeAsLargeAsTheManualAllows) {
    std::vector<ErrorEntry> entries(70, error(1));
    const auto blocks = to_blocks<ErrorListBlock>(entries);
    ASSERT_EQ(blocks.size(), 3U);
    EXPECT_EQ(blocks[2].first, 65U);
    EXPECT_EQ(blocks[2].total, 70U);
    EXPECT_EQ(blocks[2].entries.size(), 6U);
    ASSERT_EQ(to_blocks<EventListBlock>({}).size(), 1U);
    EXPECT_EQ(encoded(to_blocks<EventListBlock>({}).front()), "^0=EV1\t0\t0\r");
}

} // namespace
} // namespace linefeed::protocol
