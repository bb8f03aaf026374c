// The feeder from the connection to the first print: in the manual's order, and every reason not to start.
#include "feeder/mailing_error.hpp"
#include "story.hpp"

namespace linefeed::feeder {
namespace {

using State = protocol::MachineState;
using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(FeederArming, shouldFollowTheManualUpToTheFirstPrint) {
    Story story;
    story.start();
    story.expect("?RS");
    story.rs(State::ready_to_print);
    story.expect("?VS; ?JL");
    story.vs("S1");
    story.expect("");
    story.jl();
    story.expect("?SM");
    story.sm(0, 77, 0);
    story.expect("?SM");
    story.sm(0, 77, 0);
    story.expect("?CC");
    story.cc(1000);
    story.expect("begin run, last printed before 77");
    story.granted();
    story.expect("!FF; ?SM");
    story.sm(0, 77, 0);
    story.expect("=CM 110; ?SM");
    story.sm(0, 77, 110);
    story.expect("");
    story.supplied(103);
    story.expect("");
    story.supplied(105);
    story.expect("=MR 101-104; ?SM");
    story.sm(3, 77, 110);
    story.wait(milliseconds{4});
    story.expect("!GO; ?RS; ?SM");
    story.rs(State::printing);
    story.expect("notice: printing");
    EXPECT_EQ(story.phase(), Phase::printing);
}

TEST(FeederArming, shouldTellTheLedgerWhichPrinterItIs) {
    Story story;
    story.identify();
    story.locate();
    ASSERT_EQ(story.actions.size(), 1U);
    const auto& begin = std::get<BeginRun>(story.actions[0]);
    EXPECT_EQ(begin.printer.version->serial_number, "S1");
    EXPECT_EQ(begin.printer.job_name, "\\FFSDISK\\JOBS\\A.job");
    EXPECT_EQ(begin.printer.total_prints, 1000U);
    EXPECT_EQ(begin.last_printed_before, RecordNumber{77});
}

TEST(FeederArming, shouldStartWithoutIdentityAndCounter) {
    Story story;
    story.start();
    story.rs(State::ready_to_print);
    story.take();
    story.lost(protocol::Parameter::JL);
    story.expect("");
    story.lost(protocol::Parameter::VS);
    story.expect("?SM");
    story.sm(0, 77, 0);
    story.sm(0, 77, 0);
    story.take();
    story.lost(protocol::Parameter::CC);
    story.expect("?CC"); // the answer may be damaged: once more
    story.lost(protocol::Parameter::CC);
    ASSERT_EQ(story.actions.size(), 1U);
    EXPECT_EQ(std::get<BeginRun>(story.actions[0]).printer, PrinterFacts{});
}

TEST(FeederArming, shouldAskAgainForASerialNumberThatOnlyGotLost) {
    Story story;
    story.start();
    story.rs(State::ready_to_print);
    story.jl();
    story.take();
    story.lost(protocol::Parameter::VS);
    story.expect("?VS");
    story.lost(protocol::Parameter::VS);
    story.expect("?SM");

    Story damaged;
    damaged.start();
    damaged.rs(State::ready_to_print);
    damaged.take();
    damaged.vs(""); // a TAB less
    damaged.expect("?VS");
    damaged.vs("S1");
    damaged.jl();
    damaged.expect("?SM");

    Story nameless;
    nameless.start();
    nameless.rs(State::ready_to_print);
    nameless.vs("");
    nameless.jl();
    nameless.take();
    nameless.vs(""); // it has none
    nameless.expect("?SM");
}

// Every refusal before the start.

TEST(FeederArming, shouldRefuseAPrinterInStandbyAtOnce) {
    Story story;
    story.start();
    story.take();
    story.rs(State::standby);
    story.expect("end: not_ready (standby, error 0)");
}

TEST(FeederArming, shouldRefuseAPrinterThatIsNotReady) {
    for (const auto& [state, words] :
         {std::pair{State::initialising, "initialising"}, std::pair{State::service, "interval or service panel"},
          std::pair{State::ready, "ready for action"}}) {
        Story story;
        story.identify(state);
        story.locate();
        story.expect(std::string{"end: not_ready ("} + words + ", error 0)");
    }
}

TEST(FeederArming, shouldOpenTheNozzleWhenItMay) {
    FeederSettings settings = quick_settings();
    settings.open_nozzle = true;
    Story story{settings};
    story.identify(State::ready);
    story.locate();
    story.expect("notice: opening the nozzle: this takes 30 to 60 s; !NO; ?RS");
    for (int second = 0; second < 40; ++second) {
        story.rs(State::ready);
        story.expect("");
        story.wait(settings.retry_interval);
        story.expect("?RS");
    }
    story.rs(State::ready_to_print);
    story.expect("begin run, last printed before 77");
}

TEST(FeederArming, shouldGiveUpANozzleThatDoesNotOpen) {
    FeederSettings settings = quick_settings();
    settings.open_nozzle = true;
    Story story{settings};
    story.identify(State::ready);
    story.locate();
    story.rs(State::ready);
    story.take();
    story.wait(settings.nozzle_timeout);
    story.expect("end: not_ready (ready for action, error 0)");
}

TEST(FeederArming, shouldSeeTroubleWhileTheNozzleOpens) {
    Story story = reach(Phase::opening_nozzle);
    story.rs(State::ready, raw_error(4711));
    story.expect("end: error_pending (ready for action, error " + std::to_string(raw_error(4711)) + ")");

    story = reach(Phase::opening_nozzle);
    story.rs(State::ready, 0, true);
    story.wait(milliseconds{20});
    story.rs(State::service);
    story.expect("?RS; end: not_ready (interval or service panel, error 0)");

    // A warning is told once, and the nozzle goes on opening.
    story = reach(Phase::opening_nozzle);
    story.rs(State::ready, raw_error(10202, 1));
    EXPECT_EQ(story.take().find("notice: the printer reports 10202"), 0U);
    story.rs(State::ready, raw_error(10202, 1));
    story.expect("");
    story.rs(State::ready_to_print, raw_error(10202, 1));
    story.expect("begin run, last printed before 77");
}

TEST(FeederArming, shouldRefuseAnOpenCover) {
    Story story;
    story.start();
    story.rs(State::ready_to_print, 0, true);
    story.vs("S1");
    story.jl();
    story.actions.clear();
    story.locate();
    story.expect("end: cover_open (ready for print start, error 0)");
}

TEST(FeederArming, shouldRefuseToStartOverAPendingError) {
    Story story;
    story.identify(State::ready_to_print, raw_error(4711));
    story.locate();
    story.expect("end: error_pending (ready for print start, error " + std::to_string(raw_error(4711)) + ")");
}

TEST(FeederArming, shouldStartOverAWarningAndSayIt) {
    for (const std::uint32_t window : {1U, 2U, 3U}) {
        Story story;
        story.identify(State::ready_to_print, raw_error(10202, window));
        story.locate();
        EXPECT_EQ(story.take().find("notice: the printer reports 10202 (battery low)"), 0U);
        EXPECT_EQ(story.phase(), Phase::granting);
    }
}

TEST(FeederArming, shouldAcknowledgeAnErrorThatTheOperatorAllows) {
    for (const std::uint32_t bit_24 : {0U, 1U << 24U}) {
        FeederSettings settings = quick_settings();
        settings.acknowledge.push_back(4711);
        Story story{settings};
        story.identify(State::ready_to_print, raw_error(4711 | bit_24));
        story.locate();
        const std::string told = story.take();
        EXPECT_NE(told.find("acknowledged 4711"), bit_24 == 0 ? std::string::npos : 0U);
        EXPECT_NE(told.find("!EQ; ?RS"), std::string::npos);
        story.rs(State::ready_to_print);
        story.expect("begin run, last printed before 77");
    }
}

TEST(FeederArming, shouldAcknowledgeWhatMailingLeftOnlyBehindTheTruth) {
    for (const std::uint32_t code : {1015U, 1018U, 1019U, 1223U, 5043U, 1223U | 1U << 24U}) {
        Story story{quick_settings(), plan_with(earlier_run())};
        story.identify(State::ready_to_print, raw_error(code));
        story.locate(150, 950);
        story.clear_fifo(150, true, 950, raw_error(code));
        const std::string told = story.take();
        const auto settle = told.find("settle the earlier run: printed none, in doubt none, unused 151-200");
        const auto acknowledge = told.find("!EQ");
        ASSERT_NE(settle, std::string::npos) << told;
        ASSERT_NE(acknowledge, std::string::npos) << told;
        EXPECT_LT(settle, acknowledge);
        story.rs(State::ready_to_print);
        story.expect("begin run, last printed before 150");
    }
}

TEST(FeederArming, shouldKnowMailingErrors) {
    for (const std::uint32_t code : {1015U, 1018U, 1019U, 1223U, 5043U}) {
        EXPECT_TRUE(is_mailing_error({raw_error(code)}));
        EXPECT_TRUE(is_mailing_error({raw_error(code | 1U << 24U)}));
        EXPECT_TRUE(is_error({raw_error(code)}, code));
    }
    EXPECT_FALSE(is_mailing_error({raw_error(1305)}));
    EXPECT_FALSE(is_mailing_error({}));
}

TEST(FeederArming, shouldAskUntilTheErrorIsGone) {
    Story story = reach(Phase::acknowledging);
    story.rs(State::ready_to_print, end_message);
    story.expect("");
    story.wait(milliseconds{20});
    story.expect("?RS");
    story.rs(State::ready_to_print, end_message);
    story.wait(milliseconds{20});
    story.take();
    story.rs(State::ready_to_print);
    story.expect("begin run, last printed before 77");
}

TEST(FeederArming, shouldGiveUpAnErrorThatStays) {
    Story story = reach(Phase::acknowledging);
    story.rs(State::ready_to_print, end_message);
    story.take();
    story.wait(seconds{2});
    story.expect("end: error_pending (ready for print start, error " + std::to_string(end_message) + ")");
}

TEST(FeederArming, shouldLookAtTheErrorBehindTheAcknowledgedOne) {
    Story story = reach(Phase::acknowledging);
    story.rs(State::ready_to_print, raw_error(4711));
    EXPECT_EQ(story.take().find("end: error_pending"), 0U);

    story = reach(Phase::acknowledging);
    story.rs(State::ready_to_print, raw_error(10202, 1));
    EXPECT_NE(story.take().find("battery low), warning from RIP; begin run"), std::string::npos);

    // One mailing error behind another is acknowledged too, but not for ever.
    story = reach(Phase::acknowledging);
    story.rs(State::ready_to_print, raw_error(5043));
    EXPECT_NE(story.take().find("!EQ; ?RS"), std::string::npos);
    story.wait(seconds{1});
    story.rs(State::ready_to_print, end_message);
    EXPECT_NE(story.take().find("!EQ; ?RS"), std::string::npos);
    story.wait(seconds{1});
    EXPECT_EQ(story.take().find("end: error_pending"), 0U);
}

TEST(FeederArming, shouldRefuseAFifoWithoutDepthBeforeAnythingIsGranted) {
    Story story;
    story.reported_depth = 0;
    story.identify();
    story.locate();
    story.expect("end: records_not_taken (ready for print start, error 0)");
}

TEST(FeederArming, shouldEndWhenTheLedgerGrantsNothing) {
    for (const OutcomeCode why : {OutcomeCode::nothing_to_print, OutcomeCode::records_in_doubt}) {
        Story story = reach(Phase::granting);
        story.refused(why);
        story.expect("end: " + std::string{to_string(why)} + " (ready for print start, error 0)");
    }
    Story story = reach(Phase::loading);
    story.refused(OutcomeCode::nothing_to_print);
    story.expect("");
    story.granted(); // nobody asked a second time
    story.expect("");
}

} // namespace
} // namespace linefeed::feeder
