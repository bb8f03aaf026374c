// The probe of a printer: it finds habits out, leaves everything as it was, and is refused where it could disturb.
#include "printer/tasks.hpp"
#include "support/peer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace linefeed::printer {
namespace {

using testing::HasSubstr;
using testing::Not;

Result<Json> probe(const ClientSettings& settings) {
    const auto printer = PrinterClient::connect(settings);
    return printer ? carry_out(*find_task("probe"), **printer, {}) : printer.error();
}

simulator::SimulatorSettings with_habit(std::string_view name) {
    simulator::SimulatorSettings settings;
    EXPECT_TRUE(simulator::set_habit(settings.printer.habits, name));
    return settings;
}

TEST(Probe, shouldTellProfileAndHabits) {
    RunningSimulator printer;
    const Json found = probe(printer.settings()).value();
    EXPECT_EQ(found["profile"], "jet3up");
    EXPECT_EQ(found["escapes"], true);
    EXPECT_EQ(found["speed_unit"], "dm/min");
    EXPECT_EQ(found["graphic_height"], 32);
    EXPECT_EQ(found["keeps_stop_at"], true);
    EXPECT_EQ(found["mailing_counts_print_gos"], false);
    EXPECT_EQ(found["status_tells_job_changes"], true);
    EXPECT_EQ(found["total_counter"], true);
    EXPECT_EQ(found["tank_levels"], false);
    EXPECT_EQ(found["doubled_backslashes"], false);
    EXPECT_EQ(found["lengths_on"], false);
}

TEST(Probe, shouldFindEachHabitOut) {
    for (const auto& [habit, key, value] :
         {std::tuple{"ignore-stop-at", "keeps_stop_at", false},
          std::tuple{"sixth-value", "mailing_counts_print_gos", true},
          std::tuple{"five-value-status", "status_tells_job_changes", false},
          std::tuple{"no-total-counter", "total_counter", false}, std::tuple{"tank-levels", "tank_levels", true},
          std::tuple{"escaped-paths", "doubled_backslashes", true},
          std::tuple{"stale-mail-status", "keeps_stop_at", true}}) {
        RunningSimulator printer{with_habit(habit)};
        EXPECT_EQ(probe(printer.settings()).value()[key], value) << habit;
    }
}

TEST(Probe, shouldLeaveTheStopPointAsItWas) {
    RunningSimulator running;
    const auto printer = PrinterClient::connect(running.settings()).value();
    ASSERT_TRUE(printer->send(protocol::StopAt{RecordNumber{1}}));
    EXPECT_EQ(carry_out(*find_task("probe"), *printer, {}).value()["keeps_stop_at"], true);
    EXPECT_EQ(printer->ask<protocol::MailStatus>(protocol::Parameter::SM)->stop_at, RecordNumber{1});
}

TEST(Probe, shouldTouchNothingThatIsInUse) {
    for (const char* const frames : {"^0=RS2\t6\t0\t0\t9\t0\r", "^0=RS0\t1\t0\t0\t0\t0\r", "^0=RS0\t2\t0\t0\t0\t0\r"}) {
        Peer printer{[frames](std::string_view frame) { return Peer::Reaction{frame == "^0?RS" ? frames : ""}; }};
        EXPECT_EQ(probe(printer.settings()).error().kind, FailureKind::stopped);
        EXPECT_EQ(printer.heard(), "^0?RS\n");
    }
    Peer filled{[](std::string_view frame) {
        return Peer::Reaction{frame == "^0?RS"   ? "^0=RS2\t5\t0\t0\t9\t0\r"
                              : frame == "^0?SM" ? "^0=SM256\t3\t7\t0\t1\r"
                                                 : ""};
    }};
    EXPECT_THAT(probe(filled.settings()).error().message, HasSubstr("records lie in its FIFO"));
    EXPECT_THAT(filled.heard(), Not(HasSubstr("=CM")));
}

TEST(Probe, shouldNotSetAnythingOnceSomebodyHasStartedTheLine) {
    int asked = 0;
    Peer printer{[&asked](std::string_view frame) {
        return Peer::Reaction{frame == "^0?RS"   ? ++asked == 1 ? "^0=RS2\t5\t0\t0\t9\t0\r" : "^0=RS2\t6\t0\t0\t9\t0\r"
                              : frame == "^0?SM" ? "^0=SM256\t0\t7\t0\t1\r"
                                                 : ""};
    }};
    EXPECT_EQ(probe(printer.settings()).error().kind, FailureKind::stopped);
    EXPECT_THAT(printer.heard(), Not(HasSubstr("=CM")));
}

/// What the printer says of its stop point, in order; each frame is asked for twice.
class StopPoints {
public:
    explicit StopPoints(std::vector<int> values, int starts_behind = 1000)
        : values_(std::move(values))
        , starts_behind_(starts_behind) {}
    Peer::Reaction operator()(std::string_view frame) {
        if (frame == "^0?RS") {
            return {++states_ > starts_behind_ ? "^0=RS2\t6\t0\t0\t9\t0\r" : "^0=RS2\t5\t0\t0\t9\t0\r"};
        }
        if (frame == "^0?SM") {
            const auto at = std::min(asked_++ / 2, values_.size() - 1);
            return {"^0=SM256\t0\t7\t" + std::to_string(values_[at]) + "\t1\r"};
        }
        return {};
    }

private:
    std::vector<int> values_;
    int starts_behind_;
    std::size_t asked_ = 0;
    int states_ = 0;
};

TEST(Probe, shouldPutNothingBackOnALineThatWasStartedMeanwhile) {
    Peer printer{StopPoints{{40, 1}, 2}};
    const auto found = probe(printer.settings());
    ASSERT_FALSE(found);
    EXPECT_THAT(found.error().message, HasSubstr("somebody has started it meanwhile; its stop-at was 40"));
    EXPECT_THAT(printer.heard(), Not(HasSubstr("^0=CM40\n")));
}

TEST(Probe, shouldLeaveAStopPointAloneThatIsSomebodyElses) {
    Peer printer{StopPoints{{40, 500}}};
    EXPECT_THAT(probe(printer.settings()).error().message, HasSubstr("somebody has set its stop-at meanwhile"));
    EXPECT_THAT(printer.heard(), Not(HasSubstr("^0=CM40\n")));
}

TEST(Probe, shouldPutTheStopPointBackOnceMoreWhereItWasNotTaken) {
    Peer printer{StopPoints{{40, 1, 1, 40}}};
    EXPECT_EQ(probe(printer.settings()).value()["keeps_stop_at"], true);
    EXPECT_THAT(printer.heard(), HasSubstr("^0=CM40\n^0?SM\n^0?SM\n^0?RS\n^0=CM40\n"));
}

TEST(Probe, shouldSayWhatMayBeLeftBehind) {
    bool set = false;
    Peer printer{[&set](std::string_view frame) {
        set = set || frame.starts_with("^0=CM");
        return Peer::Reaction{frame == "^0?RS"           ? "^0=RS2\t5\t0\t0\t9\t0\r"
                              : frame == "^0?SM" && !set ? "^0=SM256\t0\t7\t40\t1\r"
                                                         : "",
                              false};
    }};
    const auto found = probe(printer.settings());
    EXPECT_THAT(found.error().message, HasSubstr("its stop-at was 40 before, and may be 1 now"));
    EXPECT_THAT(printer.heard(), HasSubstr("^0=CM40\n")) << "put back, even unheard";
}

TEST(Probe, shouldSayWhatToNameWhereThePrinterDoesNotTell) {
    Peer printer{[](std::string_view frame) {
        return Peer::Reaction{frame == "^0?RS"   ? "^0=RS2\t5\t0\t0\t9\r"
                              : frame == "^0?SM" ? "^0=SM256\t0\t0\t0\t1\r"
                              : frame == "^0?VS" ? "^0=VS\t\t\t\t\t\t\t\tV1\tLJ9\t7\r"
                                                 : ""};
    }};
    const Json found = probe(printer.settings()).value();
    EXPECT_EQ(found["type"], "LJ9");
    EXPECT_TRUE(found["profile"].is_null());
    EXPECT_THAT(found["note"].get<std::string>(), HasSubstr("--profile"));
    EXPECT_EQ(found["keeps_stop_at"], false);
    EXPECT_TRUE(found["total_counter"].is_null());
}

TEST(Probe, shouldBeRefusedWhileAJobIsOnTheLine) {
    EXPECT_EQ(danger_of(*find_task("probe"), {}).value(), Danger::feeding);
}

} // namespace
} // namespace linefeed::printer
