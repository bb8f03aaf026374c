// Stories for the feeder: facts go in by name, and what the feeder wants done is compared as the text that its actions
// print. The standard run is the records 101-110 through a FIFO of 4, on a printer that last printed number 77 and has
// made 1000 prints.
#pragma once

#include "feeder/feeder.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace linefeed::feeder {

/// An error number with its display window in bits 31/30 (0 error, 1 warning, 2 message), from RIP, not switching off.
inline std::int32_t raw_error(std::uint32_t code, std::uint32_t window = 0) {
    return static_cast<std::int32_t>(window << 30U | 1U << 27U | 1U << 25U | code);
}

inline const std::int32_t end_message = raw_error(1223, 2);

inline std::string text(const Actions& actions) {
    std::ostringstream out;
    for (const Action& action : actions) {
        out << (out.tellp() > 0 ? "; " : "") << action;
    }
    return out.str();
}

inline FeederSettings quick_settings() {
    FeederSettings settings;
    settings.pacing.poll_min = std::chrono::milliseconds{1};
    settings.pacing.unknown_rate = {};
    return settings;
}

class Story {
public:
    static constexpr std::uint32_t first = 101;
    static constexpr std::uint32_t last = 110;
    static constexpr std::uint32_t depth = 4;

    using State = protocol::MachineState;

    explicit Story(const FeederSettings& settings = quick_settings(), const FeederPlan& plan = {})
        : feeder(settings, plan) {}

    /// What the feeder wanted done since the last call.
    void expect(const std::string& story) {
        EXPECT_EQ(text(actions), story);
        actions.clear();
    }
    [[nodiscard]] std::string text_of_actions() const { return text(actions); }
    std::string take() {
        std::string story = text(actions);
        actions.clear();
        return story;
    }

    void start() { feeder.start(now, actions); }
    void rs(State machine, std::int32_t error = 0, bool cover_open = false) {
        feeder.on_machine_status(
            {.machine = machine, .error = {error}, .cover_open = cover_open, .job_changed = std::nullopt}, now,
            actions);
    }
    /// A moment after what was before. Nothing is woken by that.
    void sm(std::uint32_t entries, std::uint32_t last_printed, std::uint32_t stop_at, bool finished = true) {
        now += answer_time;
        feeder.on_mail_status(
            {reported_depth, entries, RecordNumber{last_printed}, RecordNumber{stop_at}, finished, print_gos}, now,
            actions);
    }
    /// Without a total as often as it is asked for.
    void cc(std::optional<std::uint32_t> total) {
        const auto asked_again = [this] {
            return !actions.empty() && actions[actions.size() - 1] == Action{Inquire{protocol::Parameter::CC}};
        };
        feeder.on_counters({.product = {}, .stop_after = {}, .total = total}, now, actions);
        while (!total && asked_again()) {
            actions.erase(actions.size() - 1);
            feeder.on_counters({.product = {}, .stop_after = {}, .total = total}, now, actions);
        }
    }
    void vs(const std::string& serial) {
        protocol::VersionInfo version;
        version.serial_number = serial;
        feeder.on_version(version, now, actions);
    }
    void jl() { feeder.on_job_name({"\\FFSDISK\\JOBS\\A.job"}, now, actions); }
    void lost(protocol::Parameter what) { feeder.on_lost_answer(what, now, actions); }
    void silent() { feeder.on_silence(actions); }
    void link_lost() { feeder.on_link_lost(actions); }
    void granted(std::uint32_t from = first, std::uint32_t to = last, std::uint32_t durable_through = last) {
        feeder.on_granted(RecordRange::closed(RecordNumber{from}, RecordNumber{to}), RecordNumber{durable_through}, now,
                          actions);
    }
    void refused(OutcomeCode why) { feeder.on_refused(why, actions); }
    void durable(std::uint32_t through) { feeder.on_durable(RecordNumber{through}, now, actions); }
    void supplied(std::uint32_t through) { feeder.on_supplied(RecordNumber{through}, now, actions); }
    void settled() { feeder.on_settled(now, actions); }
    void storage_failed() { feeder.on_storage_failed(now, actions); }
    void stop() { feeder.request_stop(now, actions); }
    void wait(Duration time) {
        now += time;
        feeder.on_time(now, actions);
    }
    /// Jumps to the next wake-up; false if there is none.
    bool wake() {
        const auto at = feeder.next_wake();
        if (!at) {
            return false;
        }
        now = std::max(now, *at);
        feeder.on_time(now, actions);
        return true;
    }
    Phase phase() const { return feeder.phase(); }

    // The standard run, step by step; each begins where the one before ends and forgets the actions.
    void identify(State machine = State::ready_to_print, std::int32_t error = 0) {
        start();
        rs(machine, error);
        vs("S1");
        jl();
        actions.clear();
    }
    void locate(std::uint32_t last_printed = 77, std::optional<std::uint32_t> total = 1000) {
        sm(0, last_printed, 0);
        sm(0, last_printed, 0);
        actions.clear();
        cc(total);
    }
    void arm_to_grant() {
        identify();
        locate();
        actions.clear();
    }
    void flush_and_set_stop() {
        sm(0, 77, 0);
        sm(0, 77, last);
        actions.clear();
    }
    void arm() {
        arm_to_grant();
        granted();
        flush_and_set_stop();
        supplied(last);
        sm(3, 77, last);
        wait(FeederSettings{}.fill_lead);
        actions.clear();
    }
    /// From the grant to the first fill, on a printer that keeps no stop point.
    void fill_without_stop_point() {
        arm_to_grant();
        granted();
        for (int answers = 0; answers < 3; ++answers) {
            sm(0, 77, 0);
        }
        supplied(last);
    }
    /// Up to the first answer while printing.
    void print() {
        arm();
        rs(State::printing);
        sm(3, 77, last);
        actions.clear();
    }
    /// One after the other, the FIFO filled all the time. Forgets the actions.
    void print_through(std::uint32_t through) {
        for (std::uint32_t number = first; number <= through; ++number) {
            sm(std::min(2U, last - 1 - number), number, last);
            actions.clear();
        }
    }
    /// All sent and all printed, the printer has stopped itself, and the verdict is in the ledger.
    void print_all() {
        print();
        print_through(last - 1);
        sm(0, last, 0);
        actions.clear();
        rs(State::ready_to_print, end_message);
        rs(State::ready_to_print, end_message);
        sm(0, last, 0);
        sm(0, last, 0);
        cc(1010);
    }
    /// After a stop: the printer stands, and says where; the ledger takes it down, and the last look is as the first.
    void judge(std::uint32_t entries, std::uint32_t last_printed, bool finished = true,
               std::optional<std::uint32_t> total = std::nullopt, std::int32_t error = 0) {
        judge_unsettled(entries, last_printed, finished, total, error);
        if (phase() == Phase::recording) {
            clear_fifo(last_printed, finished, total, error);
        }
    }
    /// The printed records are in the ledger: the FIFO is flushed, and the printer asked once more. Leaves the flush
    /// and the inquiries out of the actions.
    void clear_fifo(std::uint32_t last_printed, bool finished = true, std::optional<std::uint32_t> total = std::nullopt,
                    std::int32_t error = 0, bool cover_open = false) {
        const Actions before = actions;
        actions.clear();
        settled();
        expect("!FF; ?RS");
        rs(State::ready_to_print, error, cover_open);
        say_where(0, last_printed, finished);
        cc(total);
        const Actions behind = actions;
        actions = before;
        for (const Action& action : behind) {
            actions.push_back(action);
        }
    }
    void judge_unsettled(std::uint32_t entries, std::uint32_t last_printed, bool finished = true,
                         std::optional<std::uint32_t> total = std::nullopt, std::int32_t error = 0) {
        rs(State::ready_to_print, error);
        rs(State::ready_to_print, error);
        say_where(entries, last_printed, finished);
        cc(total);
    }
    /// Answers `?SM` until `?CC` is asked, and forgets the actions.
    void say_where(std::uint32_t entries, std::uint32_t last_printed, bool finished = true) {
        actions.clear();
        for (int answers = 0; answers < 8 && text(actions).find("?CC") == std::string::npos; ++answers) {
            sm(entries, last_printed, 0, finished);
            if (!finished) {
                wait(std::chrono::seconds{2}); // its print will not finish any more
            }
        }
        actions.clear();
    }

    Instant now{std::chrono::seconds{1}};
    Duration answer_time = std::chrono::milliseconds{5};
    Actions actions;
    std::uint32_t reported_depth = depth;
    std::optional<std::uint32_t> print_gos; ///< sixth value of `=SM`; absent: it has five
    Feeder feeder;
};

/// Records 1-200 issued earlier, 100 of them confirmed.
inline OpenRun earlier_run() {
    return {RecordNumber{1}, RecordNumber{100}, RecordNumber{200}, "S1", 800, RecordNumber{0}, RecordNumber{200}};
}

inline FeederPlan plan_with(const OpenRun& run, bool doubt_blocks = true) {
    return {.open = run, .doubt_blocks = doubt_blocks, .take_over = false};
}

/// A story in which the feeder is in `phase`, with nothing pending.
inline Story reach(Phase phase) {
    using State = Story::State;
    FeederSettings settings = quick_settings();
    settings.open_nozzle = phase == Phase::opening_nozzle;
    FeederPlan plan;
    if (phase == Phase::halting || phase == Phase::taking_over) {
        plan = plan_with(earlier_run());
        plan.take_over = phase == Phase::taking_over;
    }
    Story story{settings, plan};
    switch (phase) {
    case Phase::idle:
        break;
    case Phase::identifying:
        story.start();
        break;
    case Phase::locating:
        story.identify();
        break;
    case Phase::halting:
        story.identify(State::printing);
        story.locate(150, 950);
        break;
    case Phase::taking_over:
        story.identify(State::printing);
        story.sm(3, 150, 200);
        story.sm(3, 150, 200);
        story.cc(950);
        break;
    case Phase::opening_nozzle:
        story.identify(State::ready);
        story.locate();
        break;
    case Phase::acknowledging:
        story.identify(State::ready_to_print, end_message);
        story.locate();
        break;
    case Phase::granting:
        story.arm_to_grant();
        break;
    case Phase::flushing:
        story.arm_to_grant();
        story.granted();
        break;
    case Phase::setting_stop:
        story.arm_to_grant();
        story.granted();
        story.sm(0, 77, 0);
        break;
    case Phase::loading:
        story.arm_to_grant();
        story.granted();
        story.flush_and_set_stop();
        break;
    case Phase::verifying:
        story.arm_to_grant();
        story.granted();
        story.flush_and_set_stop();
        story.supplied(Story::last);
        break;
    case Phase::starting:
        story.arm();
        break;
    case Phase::printing:
        story.print();
        break;
    case Phase::stopping:
        story.print();
        story.stop();
        break;
    case Phase::judging:
        story.print();
        story.stop();
        story.rs(State::ready_to_print);
        break;
    case Phase::finishing:
        story.print_all();
        break;
    case Phase::recording:
    case Phase::clearing:
        story = reach(Phase::verifying);
        story.stop();
        story.judge_unsettled(3, 77, true, 1000);
        if (phase == Phase::clearing) {
            story.settled();
        }
        break;
    case Phase::ended:
        story.start();
        story.link_lost();
        break;
    }
    story.actions.clear();
    EXPECT_EQ(story.phase(), phase);
    return story;
}

inline constexpr std::array all_phases{
    Phase::idle,           Phase::identifying,   Phase::locating, Phase::taking_over, Phase::halting,
    Phase::opening_nozzle, Phase::acknowledging, Phase::granting, Phase::flushing,    Phase::setting_stop,
    Phase::loading,        Phase::verifying,     Phase::starting, Phase::printing,    Phase::stopping,
    Phase::judging,        Phase::recording,     Phase::clearing, Phase::finishing,   Phase::ended,
};

} // namespace linefeed::feeder
