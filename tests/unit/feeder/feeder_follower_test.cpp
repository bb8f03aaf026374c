// A job that follows without a stop: its records behind those of the job, the first with number 0, and the stop point
// moved only when they lie in the FIFO. The job is the standard run, 101-110; the follower has the numbers 1-20 and
// lies at the places behind, 111-130. One product in 10 ms.
#include "story.hpp"

#include <algorithm>
#include <utility>

namespace linefeed::feeder {
namespace {

using State = protocol::MachineState;
using std::chrono::milliseconds;

constexpr std::uint32_t follower_last = 20; ///< number
constexpr std::uint32_t deep = 8;

RecordRange places(std::uint32_t first, std::uint32_t last) {
    return RecordRange::closed(RecordNumber{first}, RecordNumber{last});
}

/// With a printer that keeps what it is told.
class FeederFollower : public testing::Test {
protected:
    FeederFollower() {
        story.reported_depth = deep;
        story.answer_time = milliseconds{10};
    }
    void print(std::uint32_t supplied = Story::last) {
        story.arm_to_grant();
        story.granted();
        story.flush_and_set_stop();
        story.supplied(supplied);
        const std::uint32_t waiting = std::min(story.reported_depth, 10U) - 1;
        story.sm(waiting, 77, Story::last);
        story.wait(FeederSettings{}.fill_lead);
        story.rs(State::printing);
        story.sm(waiting, 77, Story::last);
        story.actions.clear();
    }
    void offer(std::uint32_t records = follower_last) { story.feeder.on_follower_known(RecordCount{records}); }
    /// `=SM` when the record at `place` is printed. What the feeder wants done before is done, and kept in `done`.
    void printed(std::uint32_t place) {
        act();
        const feeder::Feeder& feeder = story.feeder;
        const std::uint32_t waiting = feeder.refill().sent_through().value() - place;
        story.sm(waiting > 0 ? waiting - 1 : 0, feeder.numbering().on_wire(RecordNumber{place}).value(), stop_at);
    }
    void act() {
        for (const Action& action : std::exchange(story.actions, {})) {
            done.push_back(text_of(action));
            const auto* stop = std::get_if<SetStopAt>(&action);
            stop_at = stop != nullptr && moves_stop_point ? stop->number.value() : stop_at;
        }
    }
    /// The actions of one kind since the last call.
    std::string sent(const std::string& kind) {
        act();
        std::string found;
        for (const std::string& words : std::exchange(done, {})) {
            found += words.starts_with(kind) ? (found.empty() ? "" : "; ") + words : "";
        }
        return found;
    }
    static std::string text_of(const Action& action) {
        std::ostringstream out;
        out << action;
        return out.str();
    }
    /// Up to the inquiry whether the counter moves; 103 is printed.
    void print_to_the_question(std::uint32_t supplied = Story::last) {
        print(supplied);
        offer();
        for (std::uint32_t place = 101; place <= 103; ++place) {
            printed(place);
            printed(place);
        }
    }
    void begin(std::uint32_t supplied = Story::last) {
        print_to_the_question(supplied);
        story.cc(1003);
        printed(103);
        sent("");
        story.feeder.on_follower_begun(places(111, 130), RecordNumber{1}, story.actions);
    }
    /// The follower lies at `where`, and its first record has the number `number`; all of it may be sent.
    void begin_with(RecordRange where, std::uint32_t number = 1) {
        print_to_the_question();
        story.cc(1003);
        printed(103);
        sent("");
        story.feeder.on_follower_begun(where, RecordNumber{number}, story.actions);
        story.durable(where.last().value());
        story.supplied(where.last().value());
        printed(104);
        printed(105);
    }
    void send_behind() {
        begin();
        story.durable(130);
        story.supplied(130);
        printed(104);
        printed(105);
    }
    /// The line goes over to the follower: 113 is printed.
    void cross_over() {
        send_behind();
        for (std::uint32_t place = 106; place <= 113; ++place) {
            printed(place);
            printed(place);
        }
    }

    Story story;
    std::vector<std::string> done;
    std::uint32_t stop_at = Story::last;
    bool moves_stop_point = true;
};

TEST_F(FeederFollower, shouldAskWhetherTheCounterMovesBeforeItBeginsTheFollower) {
    print_to_the_question();
    EXPECT_EQ(sent("?CC"), "?CC") << "once, until it is answered";
    story.cc(1003);
    printed(103);
    EXPECT_EQ(sent("begin"), "begin the follower's run, last printed before 110");
    printed(104);
    EXPECT_EQ(sent("begin"), "");
}

TEST_F(FeederFollower, shouldTellTheLedgerHowTheCounterWillStandThen) {
    print_to_the_question();
    story.cc(1003);
    printed(103);
    const auto begin = std::ranges::find_if(
        story.actions, [](const Action& action) { return std::holds_alternative<BeginRun>(action); });
    ASSERT_NE(begin, story.actions.end());
    EXPECT_EQ(std::get<BeginRun>(*begin).printer.total_prints, 1010U);
    EXPECT_TRUE(std::get<BeginRun>(*begin).follower);
}

TEST_F(FeederFollower, shouldNotFollowAPrinterWhoseCounterDoesNotMove) {
    print_to_the_question();
    story.cc(1000);
    printed(104);
    EXPECT_EQ(sent("begin"), "");
}

TEST_F(FeederFollower, shouldNotFollowWithOneRecord) {
    print();
    offer(1); // with number 0 it would be printed again and again by an empty FIFO
    printed(102);
    printed(103);
    EXPECT_EQ(sent("?CC"), "");
}

TEST_F(FeederFollower, shouldNotFollowWhereTheStopPointIsNotKept) {
    story.fill_without_stop_point();
    story.sm(7, 77, 0);
    story.wait(FeederSettings{}.fill_lead);
    story.rs(State::printing);
    offer();
    moves_stop_point = false;
    stop_at = 0;
    for (std::uint32_t place = 101; place < 109; ++place) {
        printed(place);
        story.cc(1000 + place - 100);
    }
    EXPECT_EQ(sent("begin"), "");
}

TEST_F(FeederFollower, shouldTakeOneOfferAtATime) {
    print();
    offer();
    offer(1);
    for (std::uint32_t place = 101; place <= 103; ++place) {
        printed(place);
        printed(place);
    }
    EXPECT_EQ(sent("?CC"), "?CC") << "that of 20 records";
}

TEST_F(FeederFollower, shouldNeverSendTheFirstRecordOfTheFollowerAlone) {
    begin(109);
    printed(103);
    story.durable(130);
    story.supplied(111);
    printed(105);
    printed(106);
    EXPECT_EQ(sent("=MR 111"), "");
    story.supplied(112);
    EXPECT_EQ(sent("=MR 111"), "=MR 111-112");
}

TEST_F(FeederFollower, shouldNameTheRecordsOfTwoJobsApart) {
    begin(109);
    story.durable(130);
    ASSERT_LT(story.feeder.refill().sent_through(), RecordNumber{110});
    printed(106);
    sent("");
    story.supplied(130);
    EXPECT_EQ(sent("=MR"), "=MR 110-110; =MR 111-114");
}

TEST_F(FeederFollower, shouldMoveTheStopPointOnlyWhenTheFollowerLiesInTheFifo) {
    begin();
    story.durable(130);
    story.supplied(130);
    EXPECT_EQ(story.feeder.job_places(), places(101, 110));
    printed(103);
    printed(103);
    printed(103);
    EXPECT_EQ(sent("=CM"), "") << "nothing of the follower is there";
    for (int answers = 0; answers < 6; ++answers) {
        printed(107);
    }
    EXPECT_EQ(sent("=CM"), "=CM 4294967295");
}

TEST_F(FeederFollower, shouldGoOverToTheFollowerAndSetTheStopPointAtItsEnd) {
    cross_over();
    EXPECT_EQ(sent("notice"), "notice: the next job follows without a stop");
    EXPECT_EQ(story.feeder.job_places(), places(111, 130));
    EXPECT_EQ(story.feeder.numbering().number_of(RecordNumber{112}), RecordNumber{2});
    sent("");
    for (int answers = 0; answers < 10; ++answers) {
        printed(114);
    }
    EXPECT_EQ(stop_at, follower_last);
    printed(115);
    EXPECT_TRUE(sent("printed through").ends_with("printed through 115"));
}

TEST_F(FeederFollower, shouldFinishBehindTheLastRecordOfTheFollower) {
    cross_over();
    for (std::uint32_t place = 114; place < 130; ++place) {
        printed(place);
        printed(place);
    }
    stop_at = 0;
    printed(130);
    sent("");
    story.judge(0, 20, true, 1030, end_message);
    story.rs(State::ready_to_print);
    EXPECT_EQ(sent("end"), "end: finished (ready for print start, error 0)");
}

TEST_F(FeederFollower, shouldFinishTheJobThatTheFollowerCameTooLateFor) {
    begin();
    for (std::uint32_t place = 104; place < 110; ++place) {
        printed(place);
    }
    stop_at = 0;
    printed(110);
    sent("");
    story.judge(0, 110, true, 1010, end_message);
    story.rs(State::ready_to_print);
    EXPECT_EQ(sent("end"), "end: finished (ready for print start, error 0)");
}

TEST_F(FeederFollower, shouldCallTheFollowerUnusedWhenThePrinterStopsAtTheEndOfTheJob) {
    send_behind();
    moves_stop_point = false;
    for (std::uint32_t place = 106; place < 110; ++place) {
        printed(place);
    }
    stop_at = 0;
    printed(110);
    sent("");
    story.judge_unsettled(0, 110, true, 1010, end_message);
    story.settled();
    story.rs(State::ready_to_print, end_message);
    story.say_where(0, 110);
    story.cc(1010);
    const std::string words = story.take();
    EXPECT_NE(words.find("unused 111-"), std::string::npos) << words;
    EXPECT_NE(words.find("!EQ"), std::string::npos) << words;
}

TEST_F(FeederFollower, shouldGoOnWithAPrinterThatDoesNotStopAtTheEndOfTheJob) {
    send_behind();
    moves_stop_point = false;
    for (std::uint32_t place = 106; place <= 114; ++place) {
        printed(place);
    }
    EXPECT_EQ(sent("notice"), "notice: the next job follows without a stop");
}

/// Stopped as the printer reports `last_printed`; the counter says `total`.
std::string verdict_on_stop(Story& story, std::uint32_t last_printed, bool finished, std::uint32_t total) {
    story.stop();
    story.rs(State::ready_to_print);
    story.rs(State::ready_to_print);
    story.say_where(0, last_printed, finished);
    story.cc(total);
    return story.take();
}

TEST_F(FeederFollower, shouldBelieveNumberZeroIfTheCounterAgrees) {
    send_behind();
    printed(107);
    printed(111);
    printed(111);
    const std::string words = verdict_on_stop(story, 0, true, 1011);
    EXPECT_NE(words.find("by mail status and total print counter"), std::string::npos) << words;
}

TEST_F(FeederFollower, shouldNotBelieveAZeroSeenBeforeIfMoreWasPrintedSince) {
    send_behind();
    printed(107);
    printed(111);
    printed(111);
    const std::string words = verdict_on_stop(story, 0, true, 1013);
    EXPECT_EQ(words.find("by mail status"), std::string::npos) << words;
}

TEST_F(FeederFollower, shouldNotBelieveAFinishedZeroThatWasNotSeenWhileTheStopPointStood) {
    send_behind();
    printed(107);
    const std::string words = verdict_on_stop(story, 0, true, 1011);
    EXPECT_NE(words.find("printed none"), std::string::npos) << words;
}

TEST_F(FeederFollower, shouldNotBelieveOneAnswerThatLeapsBehindTheSecondJobEither) {
    cross_over();
    for (std::uint32_t place = 114; place <= 126; ++place) {
        printed(place);
        printed(place);
    }
    offer();
    printed(126);
    ASSERT_NE(sent("begin").find("last printed before 20"), std::string::npos);
    story.feeder.on_follower_begun(places(131, 150), RecordNumber{1}, story.actions);
    story.durable(150);
    story.supplied(150);
    ASSERT_GE(story.feeder.refill().sent_through(), RecordNumber{133});
    printed(132);
    EXPECT_EQ(story.feeder.refill().printed_through(), RecordNumber{126});
}

TEST_F(FeederFollower, shouldNotBelieveOneAnswerThatLeapsBehindTheJob) {
    send_behind();
    printed(107);
    sent("");
    printed(112); // 108 has lost a digit, or so
    EXPECT_EQ(sent("printed through"), "");
    printed(108);
    EXPECT_EQ(sent("printed through"), "printed through 108");
}

TEST_F(FeederFollower, shouldNotBelieveNumberZeroIfTheCounterDoesNotAgree) {
    send_behind();
    printed(107);
    const std::string words = verdict_on_stop(story, 0, true, 1010);
    EXPECT_NE(words.find("printed none"), std::string::npos) << words;
}

TEST_F(FeederFollower, shouldStopTheLineBeforeItFlushesARecordWithNumberZero) {
    send_behind();
    printed(107);
    static_cast<void>(verdict_on_stop(story, 107, true, 1007));
    story.settled();
    EXPECT_EQ(story.take(), "!ST; !FF; ?RS");
    story.rs(State::ready_to_print);
    story.say_where(0, 107);
    story.cc(1007);
    EXPECT_NE(story.text_of_actions().find("end: stop_requested"), std::string::npos) << story.text_of_actions();
}

TEST_F(FeederFollower, shouldNotBelieveNumberZeroOfAPrinterThatDoesNotCountAnyMore) {
    send_behind();
    printed(107);
    story.stop();
    story.rs(State::ready_to_print);
    story.rs(State::ready_to_print);
    story.say_where(0, 0);
    for (int lost = 0; lost < 5; ++lost) {
        story.cc(std::nullopt);
    }
    EXPECT_NE(story.text_of_actions().find("printed none"), std::string::npos) << story.text_of_actions();
}

TEST_F(FeederFollower, shouldCallNumberZeroDoubtfulIfItsPrintWasNotFinished) {
    send_behind();
    printed(107);
    const std::string words = verdict_on_stop(story, 0, false, 1010);
    EXPECT_NE(words.find("printed 108-110"), std::string::npos) << words;
}

TEST_F(FeederFollower, shouldNotBelieveAnUnfinishedZeroThatIsFarFromTheCounter) {
    send_behind();
    printed(107);
    const std::string words = verdict_on_stop(story, 0, false, 1005);
    EXPECT_NE(words.find("printed none"), std::string::npos) << words;
}

TEST_F(FeederFollower, shouldNotTakeTheEndMessageForProofWhileTwoJobsAreInThePrinter) {
    begin_with(places(111, 112));
    printed(107);
    act();
    story.rs(State::ready_to_print, end_message);
    story.rs(State::ready_to_print, end_message);
    story.say_where(0, 2);
    story.cc(1012);
    const std::string words = story.take();
    EXPECT_NE(words.find("printed 108-112, in doubt none, unused none by mail status and total print counter"),
              std::string::npos)
        << words;
}

TEST_F(FeederFollower, shouldStopInBetweenWhereTheNumbersDoNotTellTheJobsApart) {
    begin_with(places(111, 130), 100);
    for (int answers = 0; answers < 6; ++answers) {
        printed(106);
    }
    EXPECT_EQ(sent("=CM"), "") << "101 may be a record of either";
}

TEST_F(FeederFollower, shouldGoOverToAFollowerThatLiesInTheFifoAsAWhole) {
    story.reported_depth = 32;
    begin();
    story.durable(130);
    story.supplied(130);
    for (int answers = 0; answers < 6; ++answers) {
        printed(105);
    }
    EXPECT_EQ(story.feeder.refill().sent_through(), RecordNumber{130});
    EXPECT_EQ(sent("=CM"), "=CM 4294967295");
}

TEST_F(FeederFollower, shouldNotGoOverWhileTheLineStands) {
    begin();
    story.durable(130);
    story.supplied(130);
    sent("");
    for (int answers = 0; answers < 4; ++answers) {
        story.now += std::chrono::seconds{3};
        printed(103);
    }
    EXPECT_EQ(sent("=CM"), "");
}

TEST_F(FeederFollower, shouldNotGoOverWithAnAlmostEmptyFifo) {
    begin();
    story.durable(113);
    story.supplied(113);
    for (int answers = 0; answers < 6; ++answers) {
        printed(109);
    }
    EXPECT_EQ(sent("=CM"), "");
}

TEST_F(FeederFollower, shouldIgnoreARunThatItHasNotAskedFor) {
    print();
    story.feeder.on_follower_begun(places(111, 130), RecordNumber{1}, story.actions);
    EXPECT_EQ(story.feeder.refill().range(), places(101, 110));
}

TEST_F(FeederFollower, shouldNotAskBehindTheLastRecord) {
    print();
    for (std::uint32_t place = 101; place <= 110; ++place) {
        printed(place);
    }
    sent("");
    offer();
    printed(110);
    EXPECT_EQ(sent("?CC"), "");
}

TEST_F(FeederFollower, shouldNotFollowWithMoreRecordsThanThereArePlaces) {
    print();
    offer(UINT32_MAX);
    for (std::uint32_t place = 101; place <= 104; ++place) {
        printed(place);
        printed(place);
    }
    EXPECT_EQ(sent("?CC"), "");
}

TEST_F(FeederFollower, shouldWaitUntilTheEndOfTheJobIsNear) {
    story.arm_to_grant();
    story.granted(101, 500, 500);
    EXPECT_EQ(story.feeder.job_places(), places(101, 500));
    stop_at = 500;
    story.sm(0, 77, 0);
    story.sm(0, 77, stop_at);
    story.supplied(500);
    story.sm(7, 77, stop_at);
    story.wait(FeederSettings{}.fill_lead);
    story.rs(State::printing);
    story.actions.clear();
    offer(100);
    for (std::uint32_t place = 101; place <= 470; ++place) {
        printed(place);
    }
    EXPECT_EQ(sent("?CC"), "");
    for (std::uint32_t place = 471; place <= 495; ++place) {
        printed(place);
    }
    EXPECT_EQ(sent("?CC"), "?CC");
}

TEST(FeederFollowerOffer, shouldComeToNothingWithoutACounter) {
    Story story;
    story.answer_time = milliseconds{10};
    story.identify();
    EXPECT_EQ(story.feeder.job_places(), RecordRange{});
    story.locate(77, std::nullopt);
    story.granted();
    story.flush_and_set_stop();
    story.supplied(Story::last);
    story.sm(3, 77, Story::last);
    story.wait(FeederSettings{}.fill_lead);
    story.rs(State::printing);
    story.sm(3, 77, Story::last);
    story.feeder.on_follower_known(RecordCount{20});
    for (std::uint32_t number = 101; number < 110; ++number) {
        story.actions.clear();
        story.sm(std::min(2U, 109 - number), number, Story::last);
        EXPECT_EQ(story.text_of_actions().find("?CC"), std::string::npos);
    }
}

TEST_F(FeederFollower, shouldStopWhereAnotherRecordIsReported) {
    send_behind();
    act();
    story.sm(0, 3000, stop_at);
    story.sm(0, 3000, stop_at);
    EXPECT_EQ(sent("!ST"), "!ST");
}

TEST_F(FeederFollower, shouldLeaveTheStopPointAloneOnAPrinterThatDoesNotMoveIt) {
    send_behind();
    moves_stop_point = false;
    for (int answers = 0; answers < 24; ++answers) {
        printed(107);
    }
    EXPECT_EQ(sent("=CM"), "=CM 4294967295; =CM 4294967295; =CM 4294967295");
}

TEST_F(FeederFollower, shouldNotBeginTheFollowerOfALineThatIsBeingStopped) {
    print_to_the_question();
    story.cc(1003);
    printed(103);
    story.stop();
    story.actions.clear();
    story.feeder.on_follower_begun(places(111, 130), RecordNumber{1}, story.actions);
    EXPECT_EQ(story.feeder.refill().range(), places(101, 110));
    story.expect("");
}

TEST_F(FeederFollower, shouldTakeTheNextOfferWhenTheFollowerPrints) {
    send_behind();
    sent("");
    for (std::uint32_t place = 106; sent("notice").empty() && place < 120; ++place) {
        printed(place);
        printed(place);
    }
    offer();
    printed(113);
    EXPECT_EQ(sent("begin"), "") << "the stop point has to be moved first";
    for (int answers = 0; answers < 10; ++answers) {
        printed(115);
    }
    EXPECT_EQ(sent("begin"), "begin the follower's run, last printed before 20");
}

/// The printer is asked about two jobs: 101-110, of which 105 is confirmed, and the follower's first 15 records.
FeederPlan plan_with_follower() {
    FeederPlan plan = plan_with(
        {RecordNumber{101}, RecordNumber{105}, RecordNumber{125}, "S1", 1000, RecordNumber{77}, RecordNumber{130}});
    plan.numbering.append(RecordNumber{111}, RecordNumber{1});
    return plan;
}

TEST(FeederFollowerEarlier, shouldAskAboutBothJobsAtOnce) {
    Story story{quick_settings(), plan_with_follower()};
    story.identify();
    story.sm(0, 3, 0);
    story.sm(0, 3, 0);
    story.actions.clear();
    story.cc(1013);
    story.expect("settle the earlier run so far: printed 106-113 by mail status and total print counter");
    story.settled();
    EXPECT_EQ(story.take(), "!FF; ?RS") << "the one with number 0 is printed, and not the last";
}

TEST(FeederFollowerEarlier, shouldTakeAFinishedZeroForALossOfMemory) {
    Story story{quick_settings(), plan_with_follower()};
    story.identify();
    story.sm(0, 0, 0);
    story.sm(0, 0, 0);
    story.actions.clear();
    story.cc(1011);
    story.settled();
    story.rs(State::ready_to_print);
    story.say_where(0, 0);
    story.cc(1011);
    const std::string words = story.take();
    EXPECT_NE(words.find("printed none, in doubt 106-112"), std::string::npos) << words;
}

TEST(FeederFollowerEarlier, shouldNotBelieveNumberZeroWhereNothingWasCountedBefore) {
    FeederPlan plan = plan_with_follower();
    plan.open->total_before.reset();
    Story story{quick_settings(), plan};
    story.identify();
    story.say_where(0, 0, false);
    story.cc(1011);
    EXPECT_NE(story.text_of_actions().find("printed none"), std::string::npos) << story.text_of_actions();
}

TEST(FeederFollowerEarlier, shouldTakeAnUnfinishedZeroForTheFirstRecordOfTheFollower) {
    Story story{quick_settings(), plan_with_follower()};
    story.identify();
    story.say_where(0, 0, false);
    story.cc(1011);
    const std::string words = story.take();
    EXPECT_NE(words.find("printed 106-110"), std::string::npos) << words;
}

} // namespace
} // namespace linefeed::feeder
