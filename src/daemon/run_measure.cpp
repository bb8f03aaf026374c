#include "daemon/run_measure.hpp"

#include <algorithm>
#include <variant>

namespace linefeed::daemon {

void RunMeasure::on_effect(const session::Effect& effect, const feeder::Feeder& feeder) {
    if (const auto* write = std::get_if<session::RecordsWritten>(&effect)) {
        written(*write);
    } else if (const auto* adopt = std::get_if<feeder::AdoptRun>(&effect)) {
        adopted(adopt->printed_through);
    } else if (const auto* confirm = std::get_if<feeder::ConfirmPrinted>(&effect)) {
        confirmed(confirm->through, feeder.refill().range().first().previous());
    } else if (const auto* settle = std::get_if<feeder::Settle>(&effect)) {
        settled(*settle);
    } else if (const auto* end = std::get_if<feeder::End>(&effect)) {
        ended(end->outcome);
    }
}

void RunMeasure::on_fact(const session::Session& session, Instant at) {
    reported(std::max(session.feeder().refill().printed_through(), settled_through_), at);
    look_for_underrun(session.feeder());
    count_oddities(session.statistics());
}

void RunMeasure::written(const session::RecordsWritten& write) {
    meters_.records_sent += write.records.count().value();
    meters_.refills += 1;
    meters_.refill.record(write.written_at - write.allowed_at);
    if (size_ == writes_.size()) {
        WrittenThrough& newest = writes_[(oldest_ + size_ - 1) % writes_.size()];
        newest.through = write.records.last();
        newest.at = write.written_at;
        return;
    }
    writes_[(oldest_ + size_) % writes_.size()] = {write.records.first(), write.records.last(), write.written_at};
    ++size_;
}

void RunMeasure::reported(RecordNumber through, Instant at) {
    while (size_ > 0 && writes_[oldest_].first <= through) {
        WrittenThrough& write = writes_[oldest_];
        const RecordNumber last = std::min(write.through, through);
        // A report that was read before the write, yet speaks of it, is the printer's mistake.
        const Duration lead = std::max(at - write.at, Duration::zero());
        meters_.lead_time.record(lead, (last - write.first).value() + 1);
        if (last < write.through) {
            write.first = last.next();
            return;
        }
        oldest_ = (oldest_ + 1) % writes_.size();
        --size_;
    }
}

/// The earlier run has printed on while nobody looked.
void RunMeasure::adopted(RecordNumber printed_through) {
    meters_.records_printed += (std::max(printed_through, open_printed_through_) - open_printed_through_).value();
    confirmed_through_ = printed_through;
}

void RunMeasure::confirmed(RecordNumber through, RecordNumber before_run) {
    const RecordNumber from = std::max(confirmed_through_, before_run);
    if (through > from) {
        meters_.records_printed += (through - from).value();
        confirmed_through_ = through;
    }
}

void RunMeasure::settled(const feeder::Settle& settle) {
    const feeder::Verdict& verdict = settle.verdict;
    meters_.records_printed += verdict.printed.count().value();
    meters_.records_in_doubt += verdict.in_doubt.count().value();
    meters_.records_unused += verdict.unused.count().value();
    if (!settle.earlier_run && !verdict.printed.empty()) {
        settled_through_ = verdict.printed.last();
    }
}

void RunMeasure::look_for_underrun(const feeder::Feeder& feeder) {
    if (feeder.phase() != feeder::Phase::printing) {
        return;
    }
    const bool empty = feeder.refill().level() == RecordCount{0} && !feeder.refill().all_sent();
    if (empty && !ran_empty_) {
        meters_.underruns += 1;
    }
    ran_empty_ = empty;
}

void RunMeasure::ended(const feeder::Outcome& outcome) {
    using protocol::error_code::buffer_empty;
    const bool empty = outcome.error.code() == buffer_empty || outcome.error.code_without_bit_24() == buffer_empty;
    const bool dry =
        outcome.code == feeder::OutcomeCode::ran_dry || (outcome.code == feeder::OutcomeCode::printer_error && empty);
    if (dry && !ran_empty_) {
        meters_.underruns += 1;
    }
    if (outcome.code == feeder::OutcomeCode::link_lost) {
        meters_.links_lost += 1;
    }
}

void RunMeasure::count_oddities(const session::SessionStatistics& statistics) {
    meters_.frames_unexpected += statistics.frames_unexpected - counted_.frames_unexpected;
    meters_.bytes_damaged += statistics.bytes_damaged - counted_.bytes_damaged;
    counted_ = statistics;
}

} // namespace linefeed::daemon
