// The stop point in all its ways: kept, kept late, ignored, gone, and somebody else's.
#include "story.hpp"

#include <gmock/gmock.h>

namespace linefeed::feeder {
namespace {

using State = protocol::MachineState;
using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(FeederStopPoint, shouldStopBehindTheLastRecordWhenThePrinterKeepsItsStopPointButPrintsOn) {
    Story story = reach(Phase::printing);
    story.print_through(108);
    story.take();
    story.sm(0, 110, 110);
    story.expect("printed through 110; ?RS");
    story.sm(0, 110, 110);
    story.expect(""); // asked already
    story.rs(State::printing);
    story.now += milliseconds{501};
    story.sm(0, 110, 110);
    story.expect("!ST; ?RS");
    story.judge(0, 110, true, 1010);
    story.expect("settle this run: printed none, in doubt none, unused none by nothing was issued; "
                 "end: finished (ready for print start, error 0)");
}

/// Prints up to the answer in which the stop point is missing for the first time; the printer ignored it before the
/// start.
Story printing_without_stop_point() {
    Story story = reach(Phase::setting_stop);
    story.sm(0, 77, 0);
    story.sm(0, 77, 0);
    story.supplied(110);
    story.sm(3, 77, 0);
    story.wait(milliseconds{4});
    story.rs(State::printing);
    story.actions.clear();
    return story;
}

/// The time until `?RS` is asked while nothing but polls happens.
Duration until_status(Story& story, std::uint32_t stop_at) {
    const Instant begun = story.now;
    for (int wakes = 0; wakes < 1000; ++wakes) {
        EXPECT_TRUE(story.wake());
        const std::string asked = story.take();
        if (asked.find("?RS") != std::string::npos) {
            return story.now - begun;
        }
        if (asked.find("?SM") != std::string::npos) {
            story.sm(3, 77, stop_at);
        }
    }
    return Duration::max();
}

TEST(FeederStopPoint, shouldLookMoreOftenForAStopThatNoStopPointWouldShow) {
    Story guarded = reach(Phase::printing);
    EXPECT_GT(until_status(guarded, 110), milliseconds{450});
    guarded.rs(State::printing);
    guarded.take();
    EXPECT_GE(until_status(guarded, 110), milliseconds{500});

    Story unguarded = printing_without_stop_point();
    EXPECT_LE(until_status(unguarded, 0), milliseconds{110});
    unguarded.rs(State::printing);
    unguarded.take();
    EXPECT_LE(until_status(unguarded, 0), milliseconds{110});
}

TEST(FeederStopPoint, shouldSetTheStopPointAgainForAPrinterThatKeepsItOnlyWhilePrinting) {
    Story story = printing_without_stop_point();
    story.sm(3, 77, 0); // one inquiry old
    story.expect("");
    story.sm(3, 77, 110);
    story.expect("");
    story.sm(2, 101, 110);
    story.expect("printed through 101; =MR 105-105");
    story.print_through(108);
    story.sm(0, 110, 0);
    story.take();
    story.rs(State::ready_to_print, end_message);
    story.judge(0, 110, true, 1010, end_message);
    EXPECT_NE(story.take().find("by end message 1223; !EQ"), std::string::npos);
}

TEST(FeederStopPoint, shouldQueueAnEndMarkerForAPrinterThatIgnoresTheStopPoint) {
    Story story = printing_without_stop_point();
    story.sm(3, 77, 0); // asked before `=CM`
    story.sm(3, 77, 0); // may be one inquiry old
    story.expect("");
    story.sm(3, 77, 0);
    story.expect("=CM 110");
    story.sm(3, 77, 0);
    story.expect("");
    story.sm(3, 77, 0);
    story.expect("=CM 110");
    story.sm(3, 77, 0);
    story.expect("");
    story.sm(3, 77, 0);
    EXPECT_EQ(story.take().find("notice: the printer does not keep the stop point"), 0U);
    story.sm(3, 77, 0);
    story.expect("");
    story.sm(0, 103, 0);
    story.expect("=MR 105-107; ?CC; ?SM; ?SM"); // no stop would show: the counter has to bear the number out
    story.cc(1003);
    story.sm(1, 103, 0);
    story.expect("");
    story.sm(1, 105, 0); // printed on since the count
    story.expect("=MR 108-109");
    story.wait(milliseconds{40});
    story.take();
    story.sm(1, 106, 0);
    story.expect("=MR 110-110; ?CC; ?SM; ?SM"); // full: the marker must wait for room
    story.cc(1006);
    story.sm(1, 106, 0);
    story.sm(1, 106, 0);
    story.expect("printed through 106");
    story.sm(2, 107, 0);
    story.expect("end marker 111");
    story.sm(0, 110, 0);
    story.expect("!ST; ?RS");
    story.judge(0, 110, true, 1010);
    story.expect("settle this run: printed 107-110, in doubt none, unused none by mail status and total print counter; "
                 "end: finished (ready for print start, error 0)");
}

/// Records up to 108 are reported as printed, and the counter is asked for.
Story printing_with_marker() {
    Story story = printing_without_stop_point();
    for (int answers = 0; answers < 7; ++answers) {
        story.sm(3, 77, 0);
    }
    story.sm(0, 104, 0);
    story.sm(0, 108, 0);
    EXPECT_NE(story.take().find("end marker 111"), std::string::npos);
    story.cc(1008);
    return story;
}

TEST(FeederStopPoint, shouldTakeAPrintedEndMarkerForTheProofOfTheLastRecord) {
    Story story = printing_with_marker();
    story.sm(0, 111, 0, false);
    story.expect("!ST; ?RS");
    story.rs(State::ready_to_print);
    story.rs(State::ready_to_print);
    story.sm(0, 111, 0, false);
    story.expect("?RS; ?SM; ?SM");
    story.sm(0, 111, 0, false);
    story.expect(""); // the blank product is given the time to be finished
    story.wait(milliseconds{20});
    story.sm(0, 111, 0);
    story.expect("?SM; ?CC");
}

TEST(FeederStopPoint, shouldFinishWithAPrintedEndMarker) {
    Story story = printing_with_marker();
    story.sm(0, 111, 0);
    story.expect("!ST; ?RS");
    story.judge(0, 111, true, 1011);
    story.expect("settle this run: printed 101-110, in doubt none, unused none by mail status and total print counter; "
                 "end: finished (ready for print start, error 0)");
}

TEST(FeederStopPoint, shouldDoubtTheRecordsWhenTheCounterHasNotSeenTheMarkerToo) {
    Story story = printing_with_marker();
    story.sm(0, 111, 0);
    story.expect("!ST; ?RS");
    story.judge(0, 111, true, 1010); // a record before the marker was thrown away
    EXPECT_NE(story.take().find("in doubt"), std::string::npos);
}

TEST(FeederStopPoint, shouldFindTheEndMarkerPrintedOnlyWhenJudging) {
    Story story = printing_with_marker();
    story.rs(State::ready_to_print, raw_error(5043));
    story.judge(0, 111, true, 1011, raw_error(5043));
    story.expect("settle this run: printed 101-110, in doubt none, unused none by mail status and total print counter; "
                 "!EQ; ?RS");
}

TEST(FeederStopPoint, shouldTakeTheEndMarkerForProofThoughNoNumberOfTheRunWasSeen) {
    Story story;
    story.arm_to_grant();
    story.granted(101, 102, 102);
    story.sm(0, 77, 0);
    story.sm(0, 77, 0);
    story.sm(0, 77, 0);
    story.supplied(102);
    story.sm(1, 77, 0);
    story.wait(milliseconds{4});
    story.rs(State::printing);
    for (int answers = 0; answers < 7; ++answers) {
        story.sm(1, 77, 0);
    }
    EXPECT_NE(story.take().find("end marker 103"), std::string::npos);
    story.rs(State::ready_to_print, raw_error(5043));
    story.judge(0, 103, true, 1003, raw_error(5043));
    story.expect("settle this run: printed 101-102, in doubt none, unused none by mail status and total print counter; "
                 "!EQ; ?RS");
}

TEST(FeederStopPoint, shouldCountOnlyOnceAtATime) {
    Story story = printing_without_stop_point();
    story.sm(3, 77, 0);
    story.sm(2, 101, 0);
    EXPECT_NE(story.take().find("?CC; ?SM; ?SM"), std::string::npos);
    story.sm(2, 102, 0);
    EXPECT_EQ(story.take().find("?CC"), std::string::npos) << "the answer is still under way";
}

TEST(FeederStopPoint, shouldNotTakeANumberFromBeforeTheRunForItsEndMarker) {
    Story story;
    story.identify();
    story.locate(111);
    story.granted(109, 110, 110);
    story.sm(0, 111, 0);
    story.sm(0, 111, 0);
    story.sm(0, 111, 0);
    story.supplied(110);
    story.sm(1, 111, 0);
    story.wait(milliseconds{4});
    story.take();
    story.rs(State::printing);
    for (int answers = 0; answers < 7; ++answers) {
        story.sm(1, 111, 0);
    }
    EXPECT_NE(story.take().find("end marker 111"), std::string::npos);
    story.sm(0, 111, 0);
    story.expect(""); // nothing is printed yet
    story.rs(State::ready_to_print, raw_error(4711));
    story.judge(0, 111, true, 1000, raw_error(4711));
    EXPECT_NE(story.take().find("settle this run: printed none, in doubt none, unused 109-110 by"), std::string::npos);
}

TEST(FeederStopPoint, shouldNotTakeAnyNumberBehindTheLastForItsEndMarker) {
    Story story = printing_with_marker();
    story.sm(0, 112, 0);
    story.expect(""); // a damaged answer?
    story.sm(0, 112, 0);
    story.expect("!ST; ?RS");
    story.judge(0, 112, true, 1012);
    story.expect("settle this run so far: printed none by no evidence; settle this run: printed none, in doubt "
                 "101-110, unused none by no evidence; end: impossible_report (ready for print start, error 0)");
}

TEST(FeederStopPoint, shouldQueueNoEndMarkerBehindTheLargestNumber) {
    constexpr std::uint32_t max = 4294967295U;
    Story story;
    story.arm_to_grant();
    story.granted(max - 1, max, max);
    story.sm(0, 77, 0);
    story.sm(0, 77, 0);
    story.sm(0, 77, 0);
    story.supplied(max);
    story.sm(1, 77, 0);
    story.wait(milliseconds{4});
    story.rs(State::printing);
    story.take();
    for (int answers = 0; answers < 7; ++answers) {
        story.sm(1, 77, 0);
    }
    const std::string told = story.take();
    EXPECT_NE(told.find("does not keep the stop point"), std::string::npos);
    EXPECT_EQ(told.find("; end marker"), std::string::npos);
    story.sm(0, max, 0);
    story.expect("?CC; ?SM; ?SM; !ST; ?RS");
}

TEST(FeederStopPoint, shouldStopAtOnceBehindTheLastRecordWhileTheStopPointIsUncertain) {
    Story story = printing_without_stop_point();
    story.sm(3, 77, 0);
    story.sm(0, 104, 0);
    story.sm(0, 108, 0);
    story.cc(1008);
    story.take();
    story.sm(0, 110, 0);
    story.expect("!ST; ?RS");
}

TEST(FeederStopPoint, shouldSuspectAStopWhenTheStopPointVanishes) {
    Story story = reach(Phase::printing);
    story.sm(0, 103, 0);
    story.expect("?RS"); // no refill into a FIFO that the stop has emptied, and no number is believed
    story.sm(0, 104, 0);
    story.supplied(110);
    story.durable(110);
    story.expect("");
    story.rs(State::ready_to_print);
    story.expect("?RS");
    story.judge(0, 104, true, 1004);
    story.expect("settle this run: printed 101-104, in doubt none, unused none by mail status and total print counter; "
                 "end: stopped_at_printer (ready for print start, error 0)");
}

TEST(FeederStopPoint, shouldForgetTheSuspicionWhenTheStopPointIsBack) {
    Story story = reach(Phase::printing);
    story.sm(0, 103, 0);
    story.sm(0, 103, 110);
    story.expect("?RS; printed through 103; =MR 105-107");
    story.rs(State::printing);
    story.expect("");
    EXPECT_EQ(story.phase(), Phase::printing);
}

TEST(FeederStopPoint, shouldSetAStopPointAgainThatWasKeptOnlyBeforeTheStart) {
    Story story = reach(Phase::starting);
    story.rs(State::printing);
    story.take();
    story.sm(3, 77, 0);
    story.expect("?RS");
    story.rs(State::printing);
    story.expect("");
    story.sm(3, 77, 0);
    story.expect("=CM 110");
    story.sm(2, 101, 0); // may be from before that
    story.expect("=MR 105-105; ?CC; ?SM; ?SM");
    story.cc(1001);
    story.sm(2, 101, 0); // may be from before the count
    story.expect("=CM 110");
    story.sm(2, 101, 110);
    story.expect("printed through 101"); // no stop would have shown, but the counter bears the number out
    story.sm(0, 105, 110);
    story.expect("=MR 106-109");
    story.wait(milliseconds{40});
    story.take();
    story.sm(3, 105, 110);
    story.expect("?CC; ?SM; ?SM");
    story.cc(1005);
    story.sm(3, 105, 110);
    story.sm(3, 105, 110);
    story.expect("printed through 105"); // from here on the stop point shows a stop
    story.sm(2, 106, 110);
    story.expect("printed through 106; =MR 110-110");
}

TEST(FeederStopPoint, shouldStopWhenTheCounterShowsRecordsThrownAwayUnseen) {
    Story story = printing_with_marker();
    // A stop has thrown 109 away; somebody started the printer again, which prints 110 as its 9th product.
    story.sm(0, 110, 0);
    story.expect("!ST; ?RS");
    story.judge(0, 110, true, 1009);
    story.expect("settle this run so far: printed none by no evidence; "
                 "settle this run: printed none, in doubt 101-110, unused none by no evidence; "
                 "end: stopped_at_printer (ready for print start, error 0)");

    story = printing_without_stop_point();
    story.sm(3, 77, 0);
    story.sm(0, 103, 0);
    story.cc(1003);
    story.take();
    story.sm(1, 105, 0); // 104 was thrown away
    story.sm(1, 105, 0);
    story.wait(milliseconds{40});
    story.sm(1, 106, 0);
    story.take();
    story.cc(1005); // enough for 105, were nothing missing
    story.sm(1, 106, 0);
    story.sm(1, 106, 0);
    story.wait(milliseconds{40});
    story.sm(1, 106, 0);
    EXPECT_EQ(story.take().find("printed through"), std::string::npos);
    story.cc(1005);
    story.sm(1, 106, 0);
    story.sm(1, 106, 0);
    story.wait(milliseconds{100});
    story.sm(1, 106, 0);
    EXPECT_EQ(story.take().find("printed through"), std::string::npos);
    story.cc(1005);
    story.expect("!ST; ?RS");
}

TEST(FeederStopPoint, shouldStopWhenTheWholeFifoWasThrownAwayUnseen) {
    for (const std::uint32_t entries : {0U, 1U}) {
        Story story = printing_without_stop_point();
        story.sm(3, 77, 0);
        story.sm(0, 103, 0); // 104 is loaded
        story.cc(1003);
        story.sm(3, 103, 0); // 105-107 are behind it
        story.sm(3, 103, 0);
        story.wait(milliseconds{500});
        story.take();
        story.sm(entries, 103, 0); // a stop, and a start at the panel, or another client's flush
        story.rs(State::printing);
        story.expect("");
        story.wait(milliseconds{500});
        story.sm(entries, 103, 0);
        story.take();
        story.rs(State::printing);
        story.expect(entries == 0 ? "!ST; ?RS" : ""); // the counter will tell as it prints on
        if (entries == 0) {
            story.judge(0, 103, true, 1003);
            EXPECT_THAT(story.take(), testing::HasSubstr("unused 104-107"));
        }
    }
}

TEST(FeederStopPoint, shouldNotMissAGapBecauseANumberFromBeforeTheRunCouldBeOneOfIt) {
    for (const std::uint32_t entries : {3U, 1U}) {
        Story story;
        story.identify();
        story.locate(104); // and 101-104 are sent
        story.granted();
        story.sm(0, 104, 0);
        story.sm(0, 104, Story::last);
        story.supplied(Story::last);
        story.sm(3, 104, 110);
        story.wait(milliseconds{4});
        story.rs(State::printing);
        story.sm(entries, 104, 110);
        story.sm(entries, 104, 110);
        story.take();
        story.sm(1, 102, 110);
        const std::string seen = story.take();
        EXPECT_EQ(seen.find("printed through 102") == std::string::npos, entries == 1) << seen;
        EXPECT_EQ(seen.find("?CC") != std::string::npos, entries == 1) << seen;
    }
}

TEST(FeederStopPoint, shouldStopAPrinterThatWasStoppedAndStartedAgainBehindOurBack) {
    Story story = reach(Phase::printing);
    story.sm(0, 103, 110);
    story.expect("printed through 103; =MR 105-107");
    // A stop has thrown 104 away; 105-107 arrived behind it; then somebody started the printer again.
    story.sm(1, 105, 0);
    story.expect("?RS");
    story.rs(State::printing);
    story.expect("");
    story.wait(milliseconds{20});
    story.expect("?RS; ?SM");
    story.rs(State::printing);
    story.sm(0, 106, 0);
    story.expect("");
    story.wait(milliseconds{500});
    story.take();
    story.rs(State::printing);
    story.expect("!ST; ?RS");
    story.judge(0, 106, true, 1005);
    story.expect("settle this run so far: printed none by no evidence; settle this run: printed none, in doubt "
                 "104-107, unused none by no evidence; end: stopped_at_printer (ready for print start, error 0)");
}

TEST(FeederStopPoint, shouldFinishWhenAPrinterClearsTheStopPointBehindTheLastRecordAndSaysThatItPrints) {
    Story story = reach(Phase::printing);
    story.print_through(108);
    story.take();
    story.sm(0, 110, 0);
    story.expect("?RS");
    story.rs(State::printing);
    story.wait(milliseconds{501});
    story.take();
    story.rs(State::printing);
    story.expect("!ST; ?RS");
    story.judge(0, 110);
    story.expect("settle this run: printed 109-110, in doubt none, unused none by mail status; "
                 "end: finished (ready for print start, error 0)");
}

TEST(FeederStopPoint, shouldStopWhenSomebodyElseSetsTheStopPoint) {
    Story story = reach(Phase::printing);
    story.sm(0, 103, 500);
    story.expect("?RS");
    story.rs(State::printing);
    story.wait(milliseconds{501});
    story.take();
    story.rs(State::printing);
    story.expect("!ST; ?RS");
    story.judge(0, 104, true, 1004);
    EXPECT_NE(story.take().find("end: impossible_report"), std::string::npos);
}

TEST(FeederStopPoint, shouldBelieveTheNumberWhereTheCounterDoesNotMove) {
    Story story;
    story.fill_without_stop_point();
    story.sm(3, 77, 0);
    story.wait(FeederSettings{}.fill_lead);
    story.rs(Story::State::printing);
    story.sm(3, 77, 0);
    story.sm(2, 101, 0);
    ASSERT_NE(story.take().find("?CC"), std::string::npos) << "no stop point bears it out";
    story.cc(1000);
    story.expect("printed through 101");
}

} // namespace
} // namespace linefeed::feeder
