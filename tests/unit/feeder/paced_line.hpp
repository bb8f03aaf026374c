// A feeder at a printer that does nothing but print, in virtual time: how long each record lies in the FIFO before its
// PrintGo, and what the printer is asked for that.
#pragma once

#include "feeder/feeder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <functional>
#include <vector>

namespace linefeed::feeder {

/// How a printer comes to its answers.
enum class AnswerHabit {
    on_the_way,    ///< each takes its time, however many others do
    one_by_one,    ///< it works on one after the other
    in_a_cycle,    ///< at the end of a cycle it answers all that came in it
    one_per_cycle, ///< at the end of a cycle it answers the oldest
};

struct PacedLineSettings {
    AnswerHabit habit = AnswerHabit::on_the_way;
    Duration answer_time = std::chrono::milliseconds{1}; ///< or the cycle
    std::uint32_t depth = 256;
    PacingSettings pacing{};
};

/// Flow: construct, then run() as often as wanted, each with the rate of its time.
class PacedLine {
public:
    explicit PacedLine(const PacedLineSettings& settings)
        : settings_(settings)
        , feeder_(feeder_settings(settings), {})
        , arrived_(std::size_t{records} + 1) {
        act([this](Actions& out) { feeder_.start(now_, out); });
        while (feeder_.phase() != Phase::printing) {
            step(Instant::max());
        }
    }

    /// Prints at `rate` for `time`; at 0 the line stands. Forgets what was measured before.
    void run(double rate, Duration time) {
        shortest_lead_ = Duration::max();
        inquiries_ = 0;
        const Instant end = now_ + time;
        const Duration period = rate > 0
                                    ? std::chrono::duration_cast<Duration>(std::chrono::duration<double>{1.0 / rate})
                                    : Duration::max();
        Instant print_go = rate > 0 ? now_ + period : Instant::max();
        while (now_ < end) {
            const Instant next = std::min(print_go, end);
            step(next);
            if (now_ == print_go) {
                print();
                print_go += period;
            }
        }
        seconds_ = std::chrono::duration<double>(time).count();
    }

    /// Of all records printed in the run; the time that a missing one was late is negative.
    [[nodiscard]] double shortest_lead_ms() const {
        return std::chrono::duration<double, std::milli>(shortest_lead_).count();
    }
    [[nodiscard]] double inquiries_per_s() const { return inquiries_ / seconds_; }

private:
    static constexpr std::uint32_t records = 200000;

    struct Inquiry {
        protocol::Parameter what = protocol::Parameter::SM;
        Instant due;
    };

    static FeederSettings feeder_settings(const PacedLineSettings& settings) {
        FeederSettings result;
        result.pacing = settings.pacing;
        return result;
    }

    /// The next thing that happens up to `until`.
    void step(Instant until) {
        const Instant wake = feeder_.next_wake().value_or(Instant::max());
        const Instant answer = waiting_.empty() ? Instant::max() : waiting_.front().due;
        if (answer <= std::min(wake, until)) {
            now_ = answer;
            answer_one();
        } else if (wake <= until) {
            now_ = std::max(now_, wake);
            act([this](Actions& out) { feeder_.on_time(now_, out); });
        } else {
            now_ = until;
        }
    }

    void print() {
        ++printed_;
        if (printed_ > sent_) {
            ADD_FAILURE() << "the FIFO is empty at record " << printed_;
            shortest_lead_ = Duration{0};
            return;
        }
        shortest_lead_ = std::min(shortest_lead_, now_ - arrived_[printed_]);
    }

    void answer_one() {
        const Inquiry inquiry = waiting_.front();
        waiting_.pop_front();
        const protocol::MailStatus mail = settings_.habit == AnswerHabit::on_the_way ? looked_.front() : mail_status();
        looked_.pop_front();
        act([&](Actions& out) {
            switch (inquiry.what) {
            case protocol::Parameter::SM:
                feeder_.on_mail_status(mail, now_, out);
                break;
            case protocol::Parameter::RS:
                feeder_.on_machine_status(
                    {.machine = printing_ ? protocol::MachineState::printing : protocol::MachineState::ready_to_print,
                     .job_changed = std::nullopt},
                    now_, out);
                break;
            case protocol::Parameter::CC:
                feeder_.on_counters({.product = {}, .stop_after = {}, .total = printed_}, now_, out);
                break;
            case protocol::Parameter::VS:
                feeder_.on_version({}, now_, out);
                break;
            default:
                feeder_.on_job_name({"A.job"}, now_, out);
            }
        });
    }

    [[nodiscard]] protocol::MailStatus mail_status() const {
        return {settings_.depth,
                std::max(sent_ - printed_, 1U) - 1,
                RecordNumber{printed_},
                RecordNumber{stop_at_},
                true,
                {}};
    }

    void act(const std::function<void(Actions&)>& fact) {
        Actions actions;
        fact(actions);
        for (const Action& action : actions) {
            if (const auto* inquire = std::get_if<Inquire>(&action)) {
                inquired(inquire->what);
            } else if (const auto* send = std::get_if<SendRecords>(&action)) {
                sent_ = send->range.last().value();
                std::fill(arrived_.begin() + send->range.first().value(), arrived_.begin() + sent_ + 1, taken_at());
            } else if (const auto* stop = std::get_if<SetStopAt>(&action)) {
                stop_at_ = stop->number.value();
            } else if (const auto* command = std::get_if<Command>(&action)) {
                printing_ = printing_ || command->what == protocol::Action::start_print;
            } else if (std::holds_alternative<BeginRun>(action)) {
                const RecordNumber last{records};
                act([&](Actions& out) {
                    feeder_.on_granted({RecordNumber{1}, RecordCount{records}}, last, now_, out);
                });
                act([&](Actions& out) { feeder_.on_supplied(last, now_, out); });
            }
        }
    }

    /// Records wait as well until a printer that does one thing at a time has answered what came before them.
    [[nodiscard]] Instant taken_at() const {
        const bool one_at_a_time =
            settings_.habit == AnswerHabit::one_by_one || settings_.habit == AnswerHabit::one_per_cycle;
        return one_at_a_time && !waiting_.empty() ? waiting_.back().due : now_;
    }

    void inquired(protocol::Parameter what) {
        ++inquiries_;
        const Duration time = settings_.answer_time;
        const Instant last = waiting_.empty() ? Instant{} : waiting_.back().due;
        Instant due = now_ + time;
        switch (settings_.habit) {
        case AnswerHabit::on_the_way:
            break;
        case AnswerHabit::one_by_one:
            due = std::max(now_, last) + time;
            break;
        case AnswerHabit::in_a_cycle:
            due = Instant{(now_.time_since_epoch() / time + 1) * time};
            break;
        case AnswerHabit::one_per_cycle:
            due = Instant{(std::max(now_, last).time_since_epoch() / time + 1) * time};
            break;
        }
        waiting_.push_back({what, due});
        looked_.push_back(mail_status());
    }

    PacedLineSettings settings_;
    Feeder feeder_;
    Instant now_{std::chrono::seconds{100}};
    std::deque<Inquiry> waiting_;
    std::deque<protocol::MailStatus> looked_; ///< what the printer saw when it was asked
    std::vector<Instant> arrived_;
    bool printing_ = false;
    std::uint32_t stop_at_ = 0;
    std::uint32_t sent_ = 0;
    std::uint32_t printed_ = 0;
    Duration shortest_lead_{};
    int inquiries_ = 0;
    double seconds_ = 1;
};

} // namespace linefeed::feeder
