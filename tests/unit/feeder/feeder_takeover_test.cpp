// A printer found printing the earlier run is taken over without a stop, if it is clear where to go on; else it is
// halted.
#include "story.hpp"

namespace linefeed::feeder {
namespace {

using State = protocol::MachineState;

FeederPlan takeover_plan() {
    FeederPlan plan = plan_with(earlier_run());
    plan.take_over = true;
    return plan;
}

/// Found printing record 150; the FIFO of 16 holds 151-154.
Story found_printing(const FeederPlan& plan = takeover_plan(), std::uint32_t total = 950) {
    Story story{quick_settings(), plan};
    story.reported_depth = 16;
    story.identify(State::printing);
    story.sm(3, 150, 200);
    story.sm(3, 150, 200);
    story.take();
    story.cc(total);
    return story;
}

const std::string halted =
    "notice: the printer was still printing records of the earlier run: it is stopped to learn where "
    "it is; !ST; ?RS";
const std::string taken = "notice: the printer is still printing: taken over without a stop; notice: printing; ";

TEST(FeederTakeover, shouldGoOnBehindTheLastRecordInThePrinter) {
    Story story = found_printing();
    story.expect("?SM");
    story.sm(2, 151, 200);
    story.expect("?SM"); // one answer is no proof
    story.sm(1, 152, 200);
    // The counter was asked behind 150, whose print may not have finished; what came since it has not borne out.
    story.expect("adopt run, printed through 149, sent through 154");
    story.granted(1, 300, 200);
    story.expect(taken + "=CM 300; ?SM");
    story.supplied(300);
    story.expect("=MR 155-168");
    EXPECT_EQ(story.feeder.refill().level(), RecordCount{16});
    story.sm(15, 152, 300);
    story.expect("intent through 232; ?CC; ?SM; ?SM");
    story.sm(14, 153, 300);
    story.expect("=MR 169-169");
    story.cc(953);
    story.sm(15, 153, 300);
    story.sm(15, 153, 300);
    story.expect("printed through 153");
}

/// Between two answers the number became one of another job that is being printed. The counter knows.
TEST(FeederTakeover, shouldStopWhenItIsAnotherJobThatItHasTakenOver) {
    Story story = found_printing();
    story.sm(10, 154, 200);
    story.sm(10, 154, 200);
    story.take();
    story.granted(1, 200, 200);
    story.supplied(200);
    story.take();
    story.sm(10, 155, 200);
    story.cc(951);
    story.sm(9, 156, 200);
    story.sm(9, 156, 200);
    story.wait(std::chrono::milliseconds{100});
    story.sm(8, 157, 200);
    EXPECT_EQ(story.take().find("printed through"), std::string::npos);
    story.cc(953);
    story.expect("!ST; ?RS");
    story.judge(0, 157, true, 953);
    EXPECT_NE(story.take().find("in doubt 150-"), std::string::npos);
}

/// Its records are in the printer, whether the ledger's answer comes in time or not: nobody may call them unused.
TEST(FeederTakeover, shouldSayThatRecordsAreOutWhenItEndsBeforeTheLedgerAnswers) {
    Story story = found_printing();
    story.sm(2, 151, 200);
    story.sm(2, 151, 200);
    story.take();
    story.link_lost();
    ASSERT_TRUE(std::holds_alternative<End>(*story.actions.begin()));
    EXPECT_TRUE(std::get<End>(*story.actions.begin()).outcome.issued);
}

TEST(FeederTakeover, shouldFinishTheRunItHasTakenOver) {
    Story story = found_printing();
    story.sm(2, 151, 200);
    story.sm(2, 151, 200);
    story.take();
    story.granted(1, 200, 200);
    story.expect(taken + "?SM"); // the stop point stands already
    story.supplied(200);
    story.take();
    for (std::uint32_t number = 160; number < 200; number += 8) {
        story.sm(5, number, 200);
    }
    story.cc(992);
    story.sm(0, 200, 0);
    story.take();
    story.rs(State::ready_to_print, end_message);
    story.judge(0, 200, true, 1000, end_message);
    story.expect("settle this run: printed 150-200, in doubt none, unused none by end message 1223; !EQ; ?RS");
}

TEST(FeederTakeover, shouldJudgeTheRunItHasTakenOverByItsOwnCounter) {
    Story story = found_printing();
    story.sm(2, 151, 200);
    story.sm(2, 151, 200);
    story.granted(1, 200, 200);
    story.supplied(200);
    story.take();
    story.stop();
    story.judge(0, 160, true, 960);
    story.expect("settle this run so far: printed 150-160 by mail status and total print counter; settle this run: "
                 "printed none, in doubt none, unused 161-167 by mail status and total print counter; end: "
                 "stop_requested (ready for print start, error 0)");
}

TEST(FeederTakeover, shouldNotTakeAnUnfinishedPrintForSure) {
    Story story = found_printing();
    story.sm(2, 151, 200, false);
    story.sm(2, 151, 200, false);
    story.expect("?SM; ?SM; adopt run, printed through 149, sent through 154");
    story.granted(1, 200, 200);
    story.take();
    story.sm(2, 151, 200);
    story.expect("?CC; ?SM; ?SM");
    story.cc(951);
    story.sm(2, 151, 200);
    story.sm(2, 151, 200);
    story.expect("printed through 151");
}

TEST(FeederTakeover, shouldKeepWhatIsConfirmedAlready) {
    Story story{quick_settings(), takeover_plan()};
    story.reported_depth = 16;
    story.identify(State::printing);
    story.locate(100, 900);
    story.expect(halted); // nothing queued: the line would run dry

    OpenRun run = earlier_run();
    Story other{quick_settings(), FeederPlan{.open = run, .doubt_blocks = true, .take_over = true}};
    other.reported_depth = 16;
    other.identify(State::printing);
    other.sm(3, 100, 200, false);
    other.sm(3, 100, 200, false);
    other.cc(900);
    other.sm(3, 100, 200, false);
    other.sm(3, 100, 200, false);
    EXPECT_NE(other.take().find("adopt run, printed through 100, sent through 104"), std::string::npos);
    other.granted(1, 200, 200);
    other.take();
    other.sm(3, 100, 200);
    other.expect("");
}

TEST(FeederTakeover, shouldHaltWhenThePlanDoesNotAllowIt) {
    Story story = found_printing(plan_with(earlier_run()));
    story.expect(halted);
}

TEST(FeederTakeover, shouldHaltWhenTheAnswersDoNotComeToAgree) {
    Story story = found_printing();
    story.take();
    for (std::uint32_t entries = 2; entries < 8; ++entries) {
        story.sm(entries, 151, 200); // records of the old connection still arrive
        story.expect("?SM");
    }
    story.sm(8, 151, 200);
    story.expect(halted);
}

TEST(FeederTakeover, shouldHaltWhenAnAnswerCannotBe) {
    struct Answer {
        std::uint32_t entries;
        std::uint32_t last_printed;
        std::uint32_t depth;
    };
    for (const Answer& answer :
         {Answer{0, 151, 16}, Answer{3, 201, 16}, Answer{3, 99, 16}, Answer{3, 0, 16}, Answer{3, 197, 16},
          Answer{16, 151, 16}, Answer{4294967295U, 151, 16}, Answer{3, 151, 0}, Answer{3, 151, 3}}) {
        Story story = found_printing();
        story.take();
        story.reported_depth = answer.depth;
        story.sm(answer.entries, answer.last_printed, 200);
        story.expect(halted);
    }
}

TEST(FeederTakeover, shouldHaltWhenSomethingElseWasPrinted) {
    Story story = found_printing(takeover_plan(), 960);
    story.take();
    story.sm(3, 150, 200);
    story.expect(halted);

    FeederPlan without_counter = takeover_plan();
    without_counter.open->total_before.reset();
    story = found_printing(without_counter);
    story.take();
    story.sm(3, 150, 200);
    story.expect("?SM");
}

/// Between two answers a number came that was not in the printer before, and nobody has sent it: another job's.
TEST(FeederTakeover, shouldHaltWhenTheNumberLeapsOverWhatWasInThePrinter) {
    Story story = found_printing();
    story.take();
    story.sm(3, 155, 200); // it held 154 at most
    story.expect(halted);

    story = found_printing();
    story.take();
    story.sm(3, 153, 200); // records of the old connection still arrive
    story.expect("?SM");
    story.sm(1, 157, 200);
    story.expect("?SM");
}

TEST(FeederTakeover, shouldHaltAPrinterThatHasPrintedNoneOfTheRunYet) {
    FeederPlan plan = takeover_plan();
    plan.open->first = RecordNumber{160};
    plan.open->printed_through = RecordNumber{159};
    plan.open->last_printed_before = RecordNumber{150};
    Story story = found_printing(plan);
    story.expect(halted); // only the number of a record of the run tells where it is
}

TEST(FeederTakeover, shouldHaltAPrinterWhoseNumberStoodThereBeforeTheRun) {
    FeederPlan plan = takeover_plan();
    plan.open->printed_through = RecordNumber{0};
    plan.open->last_printed_before = RecordNumber{150}; // of another job, and by chance a number of this run
    found_printing(plan).expect(halted);
    plan.open->printed_through = RecordNumber{100};
    found_printing(plan).expect("?SM"); // once a record is confirmed, the number is of this run
}

TEST(FeederTakeover, shouldHaltWhenAPrintMayBeBrokenOff) {
    FeederPlan plan = takeover_plan();
    plan.open->broken_off = RecordNumber{149};
    Story story = found_printing(plan);
    story.expect(halted);
}

TEST(FeederTakeover, shouldDoWithoutTheCounter) {
    Story story{quick_settings(), takeover_plan()};
    story.reported_depth = 16;
    story.identify(State::printing);
    story.sm(3, 150, 200);
    story.sm(3, 150, 200);
    story.lost(protocol::Parameter::CC);
    story.lost(protocol::Parameter::CC);
    story.sm(2, 151, 200);
    story.take();
    story.sm(2, 151, 200);
    story.expect("adopt run, printed through 151, sent through 154");
}

TEST(FeederTakeover, shouldHaltWhenFewerWerePrintedThanTheNumberClaims) {
    const auto goes_on = [](std::uint32_t total) {
        Story story = found_printing(takeover_plan(), total); // 150 of the run before the count of 800
        story.take();
        story.sm(2, 151, 200);
        story.take();
        story.sm(2, 151, 200);
        return story.take().find("adopt run") == 0;
    };
    EXPECT_TRUE(goes_on(951)) << "printed on since";
    EXPECT_TRUE(goes_on(950));
    EXPECT_TRUE(goes_on(949)) << "the print in progress may not be counted";
    EXPECT_FALSE(goes_on(948)) << "another job prints its numbers here";
    EXPECT_TRUE(goes_on(800)) << "a counter that does not move tells nothing";
}

TEST(FeederTakeover, shouldStopThePrinterOnRequestWhileItIsTakenOver) {
    Story story = found_printing();
    story.sm(2, 151, 200);
    story.sm(2, 151, 200);
    story.take();
    ASSERT_EQ(story.phase(), Phase::granting);
    story.stop();
    story.expect("!ST; end: stop_requested (printing, error 0)");
}

} // namespace
} // namespace linefeed::feeder
