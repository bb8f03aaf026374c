// What the plant has decided about single error numbers: while it prints, and before a start.
#include "story.hpp"

namespace linefeed::feeder {
namespace {

using State = protocol::MachineState;

constexpr std::uint32_t warning = 1;

FeederSettings stopping(StoppingErrors errors) {
    FeederSettings settings = quick_settings();
    settings.stop_on = std::move(errors);
    return settings;
}

TEST(StoppingErrorsTest, shouldContainWhatIsListedOrAllOthers) {
    const StoppingErrors listed{.numbers = {1018, 10202}, .all_others = false};
    const StoppingErrors others{.numbers = {1018, 10202}, .all_others = true};
    for (const std::uint32_t code : {1018U, 10202U, 10202U | 1U << 24U}) {
        EXPECT_TRUE(listed.contain({raw_error(code, warning)})) << code;
        EXPECT_FALSE(others.contain({raw_error(code, warning)})) << code;
    }
    EXPECT_FALSE(listed.contain({raw_error(4711, warning)}));
    EXPECT_TRUE(others.contain({raw_error(4711, warning)}));
    EXPECT_FALSE(StoppingErrors{}.contain({raw_error(4711)}));
}

TEST(FeederErrors, shouldStopTheLineForANumberThatStopsItAndTakeDownTheTruth) {
    Story story{stopping({.numbers = {10202}, .all_others = false})};
    story.print();
    story.rs(State::printing, raw_error(4711, warning));
    EXPECT_EQ(story.take().find("notice: the printer reports 4711"), 0U);
    story.rs(State::printing, raw_error(10202, warning));
    story.expect("!ST; ?RS");
    story.judge(2, 102, true, 1002, raw_error(10202, warning));
    const std::string told = story.take();
    EXPECT_NE(told.find("settle this run so far: printed 101-102"), std::string::npos) << told;
    EXPECT_NE(told.find("end: printer_error"), std::string::npos) << told;
    EXPECT_EQ(told.find("!EQ"), std::string::npos) << told;
}

TEST(FeederErrors, shouldStopForEveryNumberThatIsNotListedIfToldSo) {
    Story story{stopping({.numbers = {10202}, .all_others = true})};
    story.print();
    story.rs(State::printing, raw_error(10202, warning));
    EXPECT_EQ(story.take().find("notice: the printer reports 10202"), 0U);
    story.rs(State::printing, raw_error(4711, warning));
    story.expect("!ST; ?RS");
}

TEST(FeederErrors, shouldStopForSuchANumberThatComesWithTheStart) {
    Story story{stopping({.numbers = {10202}, .all_others = false})};
    story.arm();
    story.rs(State::ready_to_print, raw_error(10202, warning));
    story.expect("!ST; ?RS");
}

TEST(FeederErrors, shouldNotStartWhileSuchANumberIsPending) {
    Story story{stopping({.numbers = {10202}, .all_others = false})};
    story.identify(State::ready_to_print, raw_error(10202, warning));
    story.locate();
    EXPECT_NE(story.take().find("end: error_pending"), std::string::npos);
}

TEST(FeederErrors, shouldAcknowledgeWhileItPrintsOnlyWhatItMayAndEachTimeItComes) {
    FeederSettings settings = quick_settings();
    for (const std::uint32_t code : {10202U, 1018U}) {
        settings.acknowledge.push_back(code);
    }
    Story story{settings};
    story.print();
    for (int time = 0; time < 2; ++time) {
        story.rs(State::printing, raw_error(10202, warning));
        const std::string told = story.take();
        EXPECT_EQ(told.find("notice: acknowledged 10202"), 0U) << told;
        EXPECT_NE(told.find("!EQ"), std::string::npos) << told;
        story.rs(State::printing, raw_error(10202, warning)); // not seen yet
        story.expect("");
        story.rs(State::printing);
        story.expect("");
    }
    story.rs(State::printing, raw_error(1018, warning)); // of mailing: it tells of records that are under way
    const std::string told = story.take();
    EXPECT_EQ(told.find("notice: the printer reports 1018"), 0U) << told;
    EXPECT_EQ(told.find("!EQ"), std::string::npos) << told;
}

} // namespace
} // namespace linefeed::feeder
