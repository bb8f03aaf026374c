// The job that follows without a stop: its records go into the FIFO behind those of the job that prints, the first of
// them with number 0 (protocol, section 5, the numbering law). Until enough of them lie there, the stop point stays at
// the end of the job, so that a follower that comes too late finds a line that has stopped as always. Then the stop
// point is moved behind everything, since the numbers of two jobs do not tell where it stands, and, once the follower
// prints, to its end; each move is that of feeder_supply.cpp.
//
// What was printed when is told by the numbers only as long as each means one record (Numbering::distinct_through,
// which the ledger keeps to), and number 0 is what a printer says that has lost its memory, too. So no job follows
// where the stop point is not kept, or the total print counter does not move with the prints.
#include "feeder/feeder.hpp"

#include <algorithm>
#include <utility>

namespace linefeed::feeder {

using protocol::Parameter;

namespace {

/// A follower shorter than this (s, at the measured rate) would be over before the stop point stands at its end.
constexpr double shortest_follower_s = 0.3;
/// So much of it (s) lies in the FIFO before the line may go over to it, or this part of the depth.
constexpr double head_s = 0.1;
constexpr std::uint64_t head_part = 4;
/// So much (s) lies in the FIFO while the stop point moves and nothing is sent, or all but this part of the depth.
constexpr double reserve_s = 0.25;
constexpr std::uint64_t reserve_part = 4;
/// So much (s) of it may be sent before the ledger knows of the first print of it.
constexpr double allowed_s = 0.5;
/// Two records: the first, with number 0, must never be the last in the FIFO, or it is printed once more.
constexpr std::uint64_t least_records = 2;
/// It begins when so many FIFO depths of the job are left to be sent.
constexpr std::uint64_t depths_ahead = 2;
/// The counter may lag behind the numbers by so many prints.
constexpr std::uint64_t counter_lag = 2;

std::uint64_t records_in(double seconds, double rate) {
    return static_cast<std::uint64_t>(seconds * rate);
}

} // namespace

protocol::MailStatus Feeder::in_places(const protocol::MailStatus& said) const {
    protocol::MailStatus mail = said;
    if (has_granted_records()) {
        const RecordNumber sent = refill_.sent_through();
        mail.last_printed =
            numbering_.place_of(said.last_printed, refill_.printed_through(), marker_sent_ ? sent.next() : sent);
    } else if (plan_.open) {
        mail.last_printed =
            numbering_.place_of(said.last_printed, plan_.open->printed_through, plan_.open->issued_through);
    }
    return mail;
}

RecordRange Feeder::job_places() const {
    return has_granted_records() ? RecordRange::closed(job_first_, follows() ? boundary_ : refill_.range().last())
                                 : RecordRange{};
}

/// The end of the run, or of the job that another follows.
bool Feeder::stops_by_itself_at(RecordNumber place) const {
    return place == refill_.range().last() || (follows() && place == boundary_);
}

void Feeder::on_follower_known(RecordCount count) {
    if (follower_ == Follower::none) {
        follower_ = Follower::offered;
        follower_records_ = count;
    }
}

bool Feeder::follower_may_begin() const {
    const RecordNumber last = refill_.range().last();
    const bool guarded = stop_point_ == StopPoint::kept && !old_stop_point_;
    const bool told = total_before_ && !counter_proof_.doubted() && confirmed_through_ > job_first_;
    const bool in_time = refill_.printed_through() < last &&
                         last - refill_.sent_through() <= RecordCount{depths_ahead * refill_.depth().value()};
    const std::uint64_t least = std::max(least_records, records_in(shortest_follower_s, pacing_.rate()));
    return guarded && told && in_time && follower_records_ >= RecordCount{least} &&
           follower_records_ < RecordNumber::max() - last;
}

void Feeder::look_for_follower(Instant now, Actions& out) {
    switch (follower_) {
    case Follower::none:
    case Follower::begins:
        return;
    case Follower::offered:
        if (follower_may_begin()) {
            counter_moves_ ? begin_follower(out) : ask_whether_counter_moves(now, out);
        }
        return;
    case Follower::behind:
    case Follower::crossing:
        if (confirmed_through_ > boundary_) {
            crossed_over(out);
        } else if (follower_ == Follower::behind && head_is_there()) {
            cross_over();
        }
        return;
    }
}

void Feeder::ask_whether_counter_moves(Instant now, Actions& out) {
    if (counters_outstanding_ == 0) {
        ask(Parameter::CC, now, out);
    }
}

bool Feeder::moves_with_prints(std::optional<std::uint32_t> prints, std::uint64_t sent) const {
    return prints.value_or(0) != 0 && *prints <= sent && *prints + counter_lag >= prints_through(confirmed_through_);
}

/// As things stand when all of this job is printed, and nothing else.
void Feeder::begin_follower(Actions& out) {
    follower_ = Follower::begins;
    const RecordNumber last = refill_.range().last();
    PrinterFacts facts = facts_;
    facts.total_prints = *total_before_ + static_cast<std::uint32_t>(prints_through(last));
    out.push_back(BeginRun{facts, numbering_.on_wire(last), true});
}

void Feeder::on_follower_begun(RecordRange places, RecordNumber number, Actions& out) {
    if (phase_ != Phase::printing || follower_ != Follower::begins) {
        return; // nothing of it goes out
    }
    LINEFEED_ASSERT(places.first() == refill_.range().last().next());
    follower_ = Follower::behind;
    boundary_ = refill_.range().last();
    behind_boundary_ = false;
    numbering_.append(places.first(), number);
    refill_.extend(places.last());
    refill_now(out);
}

/// How many records may be sent, of `most`: the one with number 0 not without another behind it. As the last in the
/// FIFO it would be printed again and again by a printer that is stopped and started at its panel meanwhile.
RecordCount Feeder::without_lone_zero(RecordCount most) const {
    if (!follows()) {
        return most;
    }
    const RecordCount count = std::min(most, refill_.ready());
    return refill_.sent_through() + count == boundary_.next() ? count - RecordCount{1} : most;
}

/// A number of the job that has lost a digit may be one of the follower: two answers in a row are believed.
bool Feeder::is_first_behind_boundary() {
    const bool behind = mail_.last_printed > boundary_;
    return !std::exchange(behind_boundary_, behind) && behind;
}

/// Enough of the follower lies in the FIFO, by what was seen there, and enough in all; and the numbers tell enough of
/// its records from those of the job.
bool Feeder::head_is_there() const {
    const std::uint64_t depth = refill_.depth().value();
    const double rate = pacing_.rate();
    const RecordNumber allowed = std::min(numbering_.distinct_through(confirmed_through_), refill_.range().last());
    if (rate == 0 || allowed - boundary_ < std::min(follower_records_, RecordCount{records_in(allowed_s, rate)})) {
        return false;
    }
    const std::uint64_t head =
        std::clamp(records_in(head_s, rate), least_records, std::max(least_records, depth / head_part));
    const std::uint64_t reserve = std::min(records_in(reserve_s, rate), depth - depth / reserve_part);
    const bool filled = refill_.all_sent() || refill_.level() >= RecordCount{reserve};
    const std::uint64_t needed = std::min(head, follower_records_.value());
    return filled && chained_through_ >= boundary_.value() + needed;
}

/// By the boundary's number it would stop at a record of the follower, or not at all; by the follower's last at one of
/// the job.
void Feeder::cross_over() {
    follower_ = Follower::crossing;
    replace_stop_point(RecordNumber::max());
    stop_move_ = StopMove::draining;
    await_new_answers();
}

/// The first record of the follower is surely printed, so all of the job is.
void Feeder::crossed_over(Actions& out) {
    follower_ = Follower::none;
    job_first_ = boundary_.next();
    numbering_.forget_before(job_first_);
    replace_stop_point(numbering_.number_of(refill_.range().last()));
    stop_move_ = StopMove::wanted;
    out.push_back(Notice{NoticeCode::follower_printing, {}});
}

void Feeder::replace_stop_point(RecordNumber number) {
    old_stop_point_ = std::exchange(stop_number_, number);
    stop_point_tries_ = 0;
}

/// Number 0 is that of a follower's first record only if the counter agrees and the printer cannot have lost its
/// memory: it would say 0 as well, of a print that has finished. It cannot if it has said so while its stop point
/// stood.
Evidence Feeder::with_certain_place(Evidence seen, const OpenRun& run) const {
    const RecordNumber place = seen.mail.last_printed;
    if (place < run.first || place == RecordNumber::max() || numbering_.on_wire(place) != RecordNumber{}) {
        return seen;
    }
    const std::uint64_t claimed = (place - run.first).value() + 1;
    const bool counted = run.total_before && seen.printer.total_prints;
    const std::uint64_t prints = counted ? *seen.printer.total_prints - *run.total_before : 0U;
    const bool unfinished = !seen.mail.last_print_finished;
    const bool remembers = unfinished || (seen.uninterrupted && refill_.printed_through() >= place);
    const bool agrees = counted && remembers && (prints == claimed || (unfinished && prints + 1 == claimed));
    seen.mail.last_printed = agrees ? place : RecordNumber{};
    return seen;
}

/// For the ledger, which keeps what the printer has said.
Evidence Feeder::as_said(Evidence seen) const {
    const RecordNumber place = seen.mail.last_printed;
    seen.mail.last_printed = place == RecordNumber::max() ? said_.last_printed : numbering_.on_wire(place);
    return seen;
}

} // namespace linefeed::feeder
