// A printer small enough to be believed at a glance, for judging the feeder by what sticks to the products: a FIFO, the
// law that a stop empties it, a stop point, answers to `?SM` that may be one inquiry old, and a tape.
#pragma once

#include "story.hpp"

#include <cstdint>
#include <deque>
#include <optional>
#include <variant>
#include <vector>

namespace linefeed::feeder {

class PrinterDouble {
public:
    /// What the firmware makes of `=CM`.
    enum class StopPointHabit { kept, only_while_printing, ignored };

    static constexpr std::uint32_t depth = 8;

    explicit PrinterDouble(StopPointHabit habit)
        : habit_(habit) {}

    [[nodiscard]] bool printing() const { return printing_; }
    [[nodiscard]] bool print_in_progress() const { return !finished_; }
    [[nodiscard]] protocol::MachineStatus status() const {
        protocol::MachineStatus status;
        status.nozzle = protocol::NozzleState::open;
        status.machine = printing_ ? protocol::MachineState::printing : protocol::MachineState::ready_to_print;
        status.error = {error_};
        return status;
    }
    /// `stale` = the answer that belonged to the inquiry before.
    [[nodiscard]] protocol::MailStatus mail_status(bool stale) {
        const protocol::MailStatus old = previous_answer_;
        const auto entries = static_cast<std::uint32_t>(fifo_.empty() ? 0 : fifo_.size() - 1);
        previous_answer_ = {depth, entries, RecordNumber{last_}, RecordNumber{stop_at_}, finished_, {}};
        return stale ? old : previous_answer_;
    }
    [[nodiscard]] std::uint32_t last_printed() const { return last_; }
    [[nodiscard]] std::uint32_t total() const { return total_; }

    void take(const Command& command) {
        switch (command.what) {
        case protocol::Action::start_print:
            start();
            break;
        case protocol::Action::stop_print:
            stop();
            break;
        case protocol::Action::flush_fifo:
            fifo_.clear();
            break;
        case protocol::Action::acknowledge_errors:
            error_ = 0;
            break;
        default:
            break;
        }
    }
    void take(const SetStopAt& stop) {
        const bool takes =
            habit_ == StopPointHabit::kept || (habit_ == StopPointHabit::only_while_printing && printing_);
        stop_at_ = takes ? stop.number.value() : 0;
    }
    void take_record(std::uint32_t number) {
        // A sequence that begins on an empty FIFO may begin anywhere (field notes, "Firmware habits").
        fifo_.push_back({number, fifo_.empty()});
        overfull_ = overfull_ || fifo_.size() > depth;
    }
    void start() { printing_ = error_ == 0; }
    /// Whatever the cause, it empties the FIFO and forgets the stop point. A print in progress comes to its end.
    void stop() {
        if (printing_) {
            printing_ = false;
            fifo_.clear();
            stop_at_ = 0;
        }
    }
    void print_go() {
        finish_print();
        if (!printing_) {
            return;
        }
        if (fifo_.empty()) {
            error_ = raw_error(5043);
            stop();
            return;
        }
        const Slot slot = fifo_.front();
        fifo_.pop_front();
        if (slot.number != last_ + 1 && !slot.starts_sequence) {
            error_ = raw_error(1019);
            stop();
            return;
        }
        last_ = slot.number;
        finished_ = false;
        ++total_;
    }
    void finish_print() {
        if (finished_) {
            return;
        }
        finished_ = true;
        tape_.push_back(last_);
        if (printing_ && stop_at_ != 0 && last_ == stop_at_) {
            error_ = raw_error(1223, 2);
            stop();
        }
    }
    void fail() {
        error_ = raw_error(4711);
        stop();
    }
    /// Somebody has seen to the error at the panel.
    void repair() { error_ = error_ == raw_error(4711) ? 0 : error_; }
    /// The print in progress is lost with everything else but the total counter.
    void power_cycle() {
        printing_ = false;
        fifo_.clear();
        stop_at_ = last_ = 0;
        error_ = 0;
        finished_ = true;
        previous_answer_ = {depth, 0, {}, {}, true, {}};
    }

    /// The number of every print that was completed, in order.
    [[nodiscard]] const std::vector<std::uint32_t>& tape() const { return tape_; }
    /// More records came than the FIFO holds.
    [[nodiscard]] bool overfull() const { return overfull_; }

private:
    struct Slot {
        std::uint32_t number = 0;
        bool starts_sequence = false;
    };

    StopPointHabit habit_;
    std::deque<Slot> fifo_;
    bool printing_ = false;
    bool finished_ = true;
    bool overfull_ = false;
    std::uint32_t last_ = 0;
    std::uint32_t stop_at_ = 0;
    std::uint32_t total_ = 4294967200U; // it wraps on the way
    std::int32_t error_ = 0;
    protocol::MailStatus previous_answer_{depth, 0, {}, {}, true, {}};
    std::vector<std::uint32_t> tape_;
};

} // namespace linefeed::feeder
