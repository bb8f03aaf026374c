#include "spool/ledger.hpp"
#include "spool_fixture.hpp"

#include <gmock/gmock.h>

namespace linefeed::spool {

static std::ostream& operator<<(std::ostream& out, const LedgerSegment& segment) {
    return out << segment.range << ' ' << to_string(segment.state) << " run " << static_cast<std::int64_t>(segment.run);
}

namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr RunId run_1{1};
constexpr RunId run_2{2};

LedgerEntry entry(LedgerKind kind, RecordRange records, RunId run = run_1) {
    return {kind, run, records, {}};
}

/// The state after rows that must all fit.
LedgerState after(std::initializer_list<LedgerEntry> entries) {
    LedgerState state;
    for (const LedgerEntry& row : entries) {
        EXPECT_TRUE(state.apply(row)) << to_string(row.kind) << ' ' << row.range;
    }
    return state;
}

/// Records 11…20 brought into a state.
LedgerState with(RecordState wanted) {
    const RecordRange records = range(11, 20);
    const LedgerEntry intent = entry(LedgerKind::intent, records);
    const LedgerEntry in_doubt = entry(LedgerKind::in_doubt, records);
    switch (wanted) {
    case RecordState::fresh:
        return {};
    case RecordState::open:
        return after({intent});
    case RecordState::printed:
        return after({intent, entry(LedgerKind::printed, records)});
    case RecordState::unused:
        return after({intent, entry(LedgerKind::unused, records)});
    case RecordState::in_doubt:
        return after({intent, in_doubt});
    case RecordState::skipped:
        return after({intent, in_doubt, entry(LedgerKind::skipped, records)});
    case RecordState::released:
        return after({intent, in_doubt, entry(LedgerKind::released, records)});
    }
    return {};
}

constexpr RecordState all_states[] = {RecordState::fresh,   RecordState::open,     RecordState::printed,
                                      RecordState::unused,  RecordState::in_doubt, RecordState::skipped,
                                      RecordState::released};

struct Law {
    LedgerKind kind;
    RecordState result;
    std::vector<RecordState> may_follow;
};

const std::vector<Law>& laws() {
    using enum RecordState;
    static const std::vector<Law> all{
        {LedgerKind::intent, open, {fresh, unused, released}},
        {LedgerKind::printed, printed, {open, in_doubt}},
        {LedgerKind::unused, unused, {open, in_doubt}},
        {LedgerKind::in_doubt, in_doubt, {open}},
        {LedgerKind::skipped, skipped, {in_doubt}},
        {LedgerKind::released, released, {in_doubt}},
        {LedgerKind::reprint, released, {printed, skipped}},
    };
    return all;
}

TEST(LedgerState, shouldAllowExactlyTheTransitionsOfTheLaw) {
    for (const Law& law : laws()) {
        for (const RecordState before : all_states) {
            LedgerState state = with(before);
            const LedgerState unchanged = state;
            const bool lawful = std::find(law.may_follow.begin(), law.may_follow.end(), before) != law.may_follow.end();
            ASSERT_EQ(state.apply(entry(law.kind, range(11, 20), run_2)), lawful)
                << to_string(law.kind) << " after " << to_string(before);
            if (lawful) {
                EXPECT_THAT(state.segments(), ElementsAre(LedgerSegment{range(11, 20), law.result, run_2}));
            } else {
                EXPECT_EQ(state, unchanged);
            }
        }
    }
}

TEST(LedgerState, shouldRefuseARowIfASingleRecordContradictsIt) {
    for (const Law& law : laws()) {
        for (const RecordRange records : {range(10, 20), range(11, 21)}) {
            LedgerState state =
                with(law.may_follow.front() == RecordState::fresh ? RecordState::unused : law.may_follow.front());
            // The record beside the ten is made one that the row must not name.
            const RecordNumber odd{records.first().value() == 10 ? 10U : 21U};
            ASSERT_TRUE(state.apply(entry(LedgerKind::intent, RecordRange::closed(odd, odd))));
            const LedgerKind fate = law.kind == LedgerKind::reprint ? LedgerKind::unused : LedgerKind::printed;
            ASSERT_TRUE(state.apply(entry(fate, RecordRange::closed(odd, odd))));
            const LedgerState unchanged = state;
            EXPECT_FALSE(state.apply(entry(law.kind, records))) << to_string(law.kind);
            EXPECT_EQ(state, unchanged);
        }
    }
}

TEST(LedgerState, shouldRefuseAResultForRecordsThatWereNeverIssued) {
    for (const RecordRange records : {range(10, 20), range(11, 21), range(1, 5), range(30, 31)}) {
        LedgerState state = with(RecordState::open);
        EXPECT_FALSE(state.apply(entry(LedgerKind::printed, records)));
    }
    LedgerState gap = after({entry(LedgerKind::intent, range(1, 3)), entry(LedgerKind::intent, range(5, 7))});
    EXPECT_FALSE(gap.apply(entry(LedgerKind::printed, range(1, 7))));
    EXPECT_TRUE(gap.apply(entry(LedgerKind::intent, range(4, 4))));
    EXPECT_TRUE(gap.apply(entry(LedgerKind::printed, range(1, 7))));
}

TEST(LedgerState, shouldNotChangeWithTheRowsThatFrameARun) {
    LedgerState state = with(RecordState::open);
    const LedgerState unchanged = state;
    EXPECT_TRUE(state.apply(entry(LedgerKind::run_started, range(1, 100), run_2)));
    EXPECT_TRUE(state.apply(entry(LedgerKind::run_ended, {}, run_2)));
    EXPECT_EQ(state, unchanged);
}

TEST(LedgerState, shouldNotChangeWithARowAboutNoRecords) {
    LedgerState state = with(RecordState::printed);
    const LedgerState unchanged = state;
    EXPECT_TRUE(state.apply(entry(LedgerKind::intent, RecordRange{RecordNumber{15}, RecordCount{0}})));
    EXPECT_EQ(state, unchanged);
}

TEST(LedgerState, shouldJoinStridesOfOneRun) {
    const LedgerState state =
        after({entry(LedgerKind::intent, range(1, 10)), entry(LedgerKind::intent, range(11, 30)),
               entry(LedgerKind::printed, range(1, 4)), entry(LedgerKind::printed, range(5, 12))});
    EXPECT_THAT(state.segments(), ElementsAre(LedgerSegment{range(1, 12), RecordState::printed, run_1},
                                              LedgerSegment{range(13, 30), RecordState::open, run_1}));
}

TEST(LedgerState, shouldJoinWithBothNeighboursWhenAGapIsFilled) {
    const LedgerState state = after({entry(LedgerKind::intent, range(1, 3)), entry(LedgerKind::intent, range(7, 9)),
                                     entry(LedgerKind::intent, range(4, 6))});
    EXPECT_THAT(state.segments(), ElementsAre(LedgerSegment{range(1, 9), RecordState::open, run_1}));
}

TEST(LedgerState, shouldNotJoinAcrossAGapOrAnotherRun) {
    const LedgerState state = after({entry(LedgerKind::intent, range(1, 3)), entry(LedgerKind::intent, range(5, 6)),
                                     entry(LedgerKind::intent, range(7, 9), run_2)});
    EXPECT_THAT(state.segments(), ElementsAre(LedgerSegment{range(1, 3), RecordState::open, run_1},
                                              LedgerSegment{range(5, 6), RecordState::open, run_1},
                                              LedgerSegment{range(7, 9), RecordState::open, run_2}));
}

TEST(LedgerState, shouldSplitAStretchInThree) {
    const LedgerState state = after({entry(LedgerKind::intent, range(1, 9)), entry(LedgerKind::in_doubt, range(4, 6))});
    EXPECT_THAT(state.segments(), ElementsAre(LedgerSegment{range(1, 3), RecordState::open, run_1},
                                              LedgerSegment{range(4, 6), RecordState::in_doubt, run_1},
                                              LedgerSegment{range(7, 9), RecordState::open, run_1}));
}

TEST(LedgerState, shouldReplaceSeveralStretchesAtOnce) {
    LedgerState state = after({entry(LedgerKind::intent, range(1, 20)), entry(LedgerKind::in_doubt, range(3, 5)),
                               entry(LedgerKind::in_doubt, range(9, 12))});
    ASSERT_TRUE(state.apply(entry(LedgerKind::printed, range(4, 15), run_2)));
    EXPECT_THAT(state.segments(), ElementsAre(LedgerSegment{range(1, 2), RecordState::open, run_1},
                                              LedgerSegment{range(3, 3), RecordState::in_doubt, run_1},
                                              LedgerSegment{range(4, 15), RecordState::printed, run_2},
                                              LedgerSegment{range(16, 20), RecordState::open, run_1}));
}

TEST(LedgerState, shouldReachFromTheFirstToTheLastNumber) {
    const std::uint32_t max = RecordNumber::max().value();
    LedgerState state = after({entry(LedgerKind::intent, range(0, max))});
    EXPECT_TRUE(state.apply(entry(LedgerKind::printed, range(max, max))));
    EXPECT_TRUE(state.apply(entry(LedgerKind::printed, range(0, max - 1))));
    EXPECT_THAT(state.segments(), ElementsAre(LedgerSegment{range(0, max), RecordState::printed, run_1}));
    EXPECT_THAT(state.next_printable(range(0, max)), RecordRange{});
    EXPECT_THAT(state.ranges(RecordState::printed), ElementsAre(range(0, max)));
}

TEST(LedgerState, shouldKnowTheStateOfEachRecord) {
    const LedgerState state = after({entry(LedgerKind::intent, range(5, 9)), entry(LedgerKind::printed, range(5, 6))});
    EXPECT_EQ(state.state_of(RecordNumber{4}), RecordState::fresh);
    EXPECT_EQ(state.state_of(RecordNumber{5}), RecordState::printed);
    EXPECT_EQ(state.state_of(RecordNumber{6}), RecordState::printed);
    EXPECT_EQ(state.state_of(RecordNumber{7}), RecordState::open);
    EXPECT_EQ(state.state_of(RecordNumber{9}), RecordState::open);
    EXPECT_EQ(state.state_of(RecordNumber{10}), RecordState::fresh);
}

TEST(LedgerState, shouldCountAndListAStateWhateverItsRun) {
    const LedgerState state =
        after({entry(LedgerKind::intent, range(1, 9)), entry(LedgerKind::printed, range(1, 2)),
               entry(LedgerKind::printed, range(3, 4), run_2), entry(LedgerKind::printed, range(8, 8))});
    EXPECT_EQ(state.count(RecordState::printed), RecordCount{5});
    EXPECT_EQ(state.count(RecordState::open), RecordCount{4});
    EXPECT_EQ(state.count(RecordState::in_doubt), RecordCount{0});
    EXPECT_THAT(state.ranges(RecordState::printed), ElementsAre(range(1, 4), range(8, 8)));
    EXPECT_THAT(state.ranges(RecordState::open), ElementsAre(range(5, 7), range(9, 9)));
    EXPECT_THAT(state.ranges(RecordState::in_doubt), IsEmpty());
}

TEST(LedgerState, shouldOfferAllThatIsWantedOfANewJob) {
    EXPECT_EQ(LedgerState{}.next_printable(range(5, 50)), range(5, 50));
    EXPECT_EQ(LedgerState{}.next_printable({}), RecordRange{});
}

TEST(LedgerState, shouldOfferTheFirstStretchThatMayBeIssued) {
    const LedgerState state =
        after({entry(LedgerKind::intent, range(1, 30)), entry(LedgerKind::printed, range(1, 10)),
               entry(LedgerKind::unused, range(11, 15)), entry(LedgerKind::in_doubt, range(16, 25)),
               entry(LedgerKind::released, range(18, 19)), entry(LedgerKind::skipped, range(20, 25))});
    EXPECT_EQ(state.next_printable(range(1, 100)), range(11, 15));
    EXPECT_EQ(state.next_printable(range(13, 100)), range(13, 15));
    EXPECT_EQ(state.next_printable(range(12, 13)), range(12, 13));
    EXPECT_EQ(state.next_printable(range(16, 100)), range(18, 19));
    EXPECT_EQ(state.next_printable(range(20, 100)), range(31, 100));
    EXPECT_EQ(state.next_printable(range(1, 10)), RecordRange{});
    EXPECT_EQ(state.next_printable(range(26, 30)), RecordRange{});
}

TEST(LedgerState, shouldOfferFreshUnusedAndReleasedRecordsInOneStretch) {
    const LedgerState state = after({entry(LedgerKind::intent, range(5, 8)), entry(LedgerKind::unused, range(5, 6)),
                                     entry(LedgerKind::in_doubt, range(7, 8)), entry(LedgerKind::released, range(7, 8)),
                                     entry(LedgerKind::intent, range(20, 20))});
    EXPECT_EQ(state.next_printable(range(1, 100)), range(1, 19));
}

} // namespace
} // namespace linefeed::spool
