// The feeder while the records are still coming: a run may begin before anybody knows its last record. Until then the
// stop point stands behind every record that can come, so that its vanishing shows a stop as always; when the end is
// known, the stop point is moved there. It is moved as well when another job follows (feeder_follower.cpp).
//
// The move could hide a stop: a printer that is stopped and started again at its panel has lost its FIFO, and shows
// that by a stop point of 0, unless the new one has just reached it. So nothing is sent while the stop point moves: a
// FIFO that was lost is then still empty behind the move. It is moved when the FIFO is well filled, or nothing is left
// to be sent.
#include "feeder/feeder.hpp"

#include <utility>

namespace linefeed::feeder {

namespace {

/// How often `=CM` is sent with the end before the printer counts as one that does not move its stop point.
constexpr int max_moves = 3;
/// A warning is due when less than this part of the depth is left and nothing is at hand.
constexpr std::uint64_t low_level_part = 4;

} // namespace

void Feeder::on_end_known(RecordNumber last, Instant now, Actions& out) {
    if (phase_ == Phase::ended || !has_granted_records() || last >= refill_.range().last()) {
        return;
    }
    const RecordNumber before = std::exchange(stop_number_, last);
    refill_.end_at(last);
    switch (phase_) {
    case Phase::setting_stop:
    case Phase::loading:
        set_stop_point(now, out);
        return;
    case Phase::verifying:
    case Phase::starting:
    case Phase::printing:
        if (stop_would_show()) {
            old_stop_point_ = before;
            stop_move_ = StopMove::wanted;
            stop_point_tries_ = 0;
        }
        if (old_stop_point_ && (phase_ == Phase::verifying || go_due_)) {
            move_stop_point(out); // it does not print yet
        }
        if (polls()) {
            refill_now(out);
        }
        return;
    case Phase::idle:
    case Phase::identifying:
    case Phase::locating:
    case Phase::taking_over:
    case Phase::halting:
    case Phase::opening_nozzle:
    case Phase::acknowledging:
    case Phase::granting:
    case Phase::flushing: // sets it next
    case Phase::stopping:
    case Phase::judging:
    case Phase::recording:
    case Phase::clearing:
    case Phase::finishing:
    case Phase::ended:
        return;
    }
}

void Feeder::move_stop_point(Actions& out) {
    stop_move_ = StopMove::sent;
    set_stop_point_again(out);
}

/// The inquiries under way were asked before now, and the answer behind theirs may be one inquiry old.
void Feeder::await_new_answers() {
    old_answers_left_ = mail_outstanding_ + 1;
}

bool Feeder::stop_point_stands() const {
    return mail_.stop_at == stop_number_ || (old_stop_point_ && mail_.stop_at == *old_stop_point_);
}

bool Feeder::refill_waits() const {
    return suspected_since_ || stop_move_ == StopMove::draining || stop_move_ == StopMove::sent;
}

/// An answer with a stop point that stands, while it is to be moved.
void Feeder::follow_stop_point(Instant now, Actions& out) {
    if (stop_move_ == StopMove::wanted) {
        const std::uint64_t depth = refill_.depth().value();
        if (refill_.all_sent() || refill_.level().value() >= depth - depth / low_level_part) {
            stop_move_ = StopMove::draining;
            await_new_answers();
        }
    } else if (old_answers_left_ > 0) {
        --old_answers_left_;
    } else if (stop_move_ == StopMove::draining) {
        move_stop_point(out); // all that was sent has arrived, and no stop came before
    } else if (mail_.stop_at == stop_number_) {
        stop_point_moved(now, out);
    } else if (stop_point_tries_ < max_moves) {
        move_stop_point(out);
    } else if (follower_ == Follower::crossing) {
        stop_move_ = StopMove::none; // it stops at the end of the job, or does not: either is seen
    } else {
        stop_move_ = StopMove::none;
        old_stop_point_.reset();
        stop_point_ = StopPoint::ignored; // it would stop too late: the end marker takes its place
        out.push_back(Notice{NoticeCode::stop_point_ignored, {}});
    }
}

void Feeder::stop_point_moved(Instant now, Actions& out) {
    stop_move_ = StopMove::none;
    old_stop_point_.reset();
    if (refill_.level() > RecordCount{1} && mail_.entries == 0) {
        restarted_ = true; // one is loaded, and the others are gone
        begin_stop(OutcomeCode::stopped_at_printer, now, out);
    } else if (!refill_.all_sent() && mail_.entries == 0) {
        doubt_number(); // nothing is left by which a lost FIFO could be told
    }
}

/// Warns once before the printer runs empty because records are not at hand.
void Feeder::watch_supply(Actions& out) {
    const bool low = refill_.level().value() < refill_.depth().value() / low_level_part;
    if (!refill_.starved() || (follows() && refill_.sent_through() >= boundary_)) { // the job is there
        supply_noticed_ = supply_noticed_ && low;
    } else if (low && !supply_noticed_) {
        supply_noticed_ = true;
        out.push_back(Notice{NoticeCode::supply_low, {}});
    }
}

} // namespace linefeed::feeder
