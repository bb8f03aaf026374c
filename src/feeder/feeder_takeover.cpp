// Taking over a printer that is found printing the earlier run: no stop, no flush, the line goes on. What was sent
// before the interruption is not known here, so the printer's own words decide where the next record belongs: entries =
// sent − printed − 1 (protocol, section 5), in two answers that agree. Should a firmware count differently, the
// numbering law turns the mistake into a stop (1019), never into a record printed twice or left out.
#include "feeder/feeder.hpp"

#include <algorithm>

namespace linefeed::feeder {

using protocol::Parameter;

namespace {

/// Answers that may disagree before the printer is stopped instead: records of the old connection may still be
/// arriving.
constexpr int max_takeover_reads = 6;

} // namespace

/// The printer prints the earlier run and reports a record of it: it may be taken over. A number that stood there
/// before the run says nothing. It has not been stopped meanwhile, and so has left nothing out, by its counter; if it
/// has none, by the stop point that stands. And no print of it was broken off, as far as anybody has seen.
bool Feeder::may_take_over() const {
    const OpenRun& run = *plan_.open;
    const bool left_over = run.printed_through < run.first && mail_.last_printed == run.last_printed_before;
    const bool vouched_for = prints_of_earlier_run().value_or(0) != 0 || mail_.stop_at == run.last;
    return plan_.take_over && mail_.last_printed >= run.first && !left_over && mail_.entries > 0 && vouched_for &&
           broken_off_ == RecordNumber{};
}

void Feeder::begin_takeover(Instant now, Actions& out) {
    enter(Phase::taking_over, now, settings_.finish_timeout);
    in_printer_through_.reset();
    chained_through_ = std::uint64_t{mail_.last_printed.value()} + mail_.entries + 1;
    number_before_count_ = mail_.last_printed;
    ask(Parameter::SM, now, out);
}

/// One more answer while the printer prints on.
void Feeder::takeover_step(Instant now, Actions& out) {
    const OpenRun& run = *plan_.open;
    const std::uint64_t in_printer_through = std::uint64_t{mail_.last_printed.value()} + mail_.entries + 1;
    const bool fits = std::uint64_t{mail_.entries} + 1 <= mail_.depth; // the loaded record counts as well
    const bool leaps = mail_.last_printed.value() > chained_through_;  // it was not seen there: another job's number?
    chained_through_ = std::max(chained_through_, in_printer_through);
    const bool plausible =
        prints_earlier_run() && may_take_over() && fits && !leaps && in_printer_through <= run.issued_through.value();
    const bool agrees = in_printer_through_ == in_printer_through;
    in_printer_through_ = in_printer_through;
    if (!plausible || mail_reads_ > max_takeover_reads || counter_contradicts()) {
        halt(now, out);
    } else if (!agrees) {
        ask(Parameter::SM, now, out);
    } else {
        confirmed_through_ = std::max(run.printed_through, surely_printed());
        taken_sent_through_ = RecordNumber{static_cast<std::uint32_t>(in_printer_through)};
        enter(Phase::granting, now, Duration::max());
        taking_over_ = true;
        any_sent_ = true; // by the earlier run
        out.push_back(AdoptRun{confirmed_through_, taken_sent_through_, said_});
    }
}

/// The total print counter has seen more prints than the records of this run account for, or fewer: something else is
/// being printed. Its answer came between two of the number.
bool Feeder::counter_contradicts() const {
    const auto prints = prints_of_earlier_run();
    if (!prints) {
        return false;
    }
    const OpenRun& run = *plan_.open;
    const std::uint64_t least = (number_before_count_ - run.first).value(); // without the print in progress
    const std::uint64_t most = (mail_.last_printed - run.first).value() + 1;
    return *prints > most || (*prints != 0 && *prints < least); // 0: it does not move
}

std::optional<std::uint32_t> Feeder::prints_of_earlier_run() const {
    const OpenRun& run = *plan_.open;
    if (!run.total_before || !facts_.total_prints) {
        return std::nullopt;
    }
    return *facts_.total_prints - *run.total_before;
}

/// The counter, if it moves, has borne out what was reported before it was asked. Since then the number may have become
/// that of another job.
RecordNumber Feeder::surely_printed() const {
    const bool counted = prints_of_earlier_run().value_or(0) != 0;
    const bool finished = !counted && mail_.last_print_finished;
    const RecordNumber reported = counted ? number_before_count_ : mail_.last_printed;
    return finished ? reported : reported.previous();
}

/// The ledger has adopted the earlier run: printing goes on where it is.
void Feeder::taken_over(RecordRange range, RecordNumber durable_through, Instant now, Actions& out) {
    const OpenRun& run = *plan_.open;
    reported_through_ = mail_.last_print_finished ? mail_.last_printed : mail_.last_printed.previous();
    reported_through_ = std::max(reported_through_, confirmed_through_);
    refill_.resume(range, RecordCount{mail_.depth}, durable_through, taken_sent_through_, mail_.last_printed);
    total_before_ = run.total_before;
    held_through_ = chained_through_ = taken_sent_through_.value();
    said_before_ = confirmed_through_;
    doubt_number(); // behind what the ledger has adopted
    left_over_ = run.last_printed_before;
    left_over_passed_ = true;
    supply_noticed_ = true; // the pages are on their way: no reason for a warning yet
    enter(Phase::printing, now, Duration::max());
    pacing_.restart(now, refill_.printed_through() - range.first().previous());
    out.push_back(Notice{NoticeCode::taken_over, {}});
    out.push_back(Notice{NoticeCode::printing_started, {}});
    job_first_ = range.first();
    stop_number_ = numbering_.on_wire(range.last());
    stop_point_ = mail_.stop_at == stop_number_ ? StopPoint::kept : StopPoint::unset;
    if (stop_point_ == StopPoint::unset) {
        set_stop_point_again(out);
    }
    plan_status(now);
    ask(Parameter::SM, now, out);
}

/// The printer is stopped to learn where it is.
void Feeder::halt(Instant now, Actions& out) {
    out.push_back(Notice{NoticeCode::found_printing, {}});
    out.push_back(Command{protocol::Action::stop_print});
    stop_sent_at_ = now;
    enter(Phase::halting, now, settings_.stop_timeout);
    ask(Parameter::RS, now, out);
}

} // namespace linefeed::feeder
