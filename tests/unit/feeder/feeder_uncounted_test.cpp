// A printer without total print counter: nothing counts what it throws away when somebody stops it and starts it again.
// Only its stop point shows that, and the FIFO before the start.
#include "story.hpp"

namespace linefeed::feeder {
namespace {

using State = protocol::MachineState;
using std::chrono::milliseconds;

/// The first fill is sent.
Story filled() {
    Story story;
    story.identify();
    story.locate(77, std::nullopt);
    story.granted();
    story.flush_and_set_stop();
    story.supplied(Story::last);
    story.take();
    return story;
}

Story printing() {
    Story story = filled();
    story.sm(3, 77, 110);
    story.wait(milliseconds{4});
    story.rs(State::printing);
    story.take();
    return story;
}

FeederPlan takeover_plan() {
    FeederPlan plan = plan_with(earlier_run());
    plan.take_over = true;
    plan.open->total_before.reset();
    return plan;
}

TEST(FeederUncounted, shouldConfirmWhatIsReportedWhileTheStopPointStands) {
    Story story = printing();
    story.sm(2, 101, 110);
    story.expect("printed through 101; =MR 105-105");
    story.stop();
    story.expect("!ST; ?RS");
    story.judge(1, 103);
    story.expect(
        "settle this run so far: printed 102-103 by mail status; settle this run: printed none, in doubt none, "
        "unused 104-105 by mail status; end: stop_requested (ready for print start, error 0)");
}

TEST(FeederUncounted, shouldNotStartWithARecordLessThanWasSent) {
    Story story = filled();
    story.sm(2, 77, 110); // the first may be lost on a serial line
    story.sm(2, 77, 110);
    story.expect("?SM; !ST; ?RS");
}

TEST(FeederUncounted, shouldTakeAStopPointThatVanishesBehindTheStartForAStop) {
    Story story = printing();
    story.sm(2, 101, 0);
    story.expect("?RS");
    story.rs(State::printing);
    story.wait(milliseconds{500});
    story.take();
    story.rs(State::printing);
    story.expect("!ST; ?RS");
    story.judge(0, 104);
    EXPECT_NE(story.take().find("in doubt 101-104"), std::string::npos);
}

TEST(FeederUncounted, shouldDoubtWhatIsPrintedBetweenTheLooks) {
    Story story = printing();
    story.stop();
    story.judge_unsettled(2, 102);
    story.clear_fifo(104); // somebody has started it before the flush
    EXPECT_NE(story.take().find("in doubt 103-104"), std::string::npos);
}

TEST(FeederUncounted, shouldTakeOverOnlyWhereTheStopPointStands) {
    for (const std::uint32_t stop_at : {200U, 0U, 151U}) {
        Story story{quick_settings(), takeover_plan()};
        story.reported_depth = 16;
        story.identify(State::printing);
        story.sm(3, 150, stop_at);
        story.sm(3, 150, stop_at);
        story.take();
        story.cc(std::nullopt);
        story.sm(2, 151, stop_at);
        story.sm(2, 151, stop_at);
        const bool taken_over = story.take().find("adopt run") != std::string::npos;
        EXPECT_EQ(taken_over, stop_at == 200) << stop_at;
    }
}

} // namespace
} // namespace linefeed::feeder
