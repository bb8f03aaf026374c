// Two jobs in one run: the follower begins behind the job that is printed, is issued as far as its numbers tell it from
// that, and is alone when the ledger knows of its first print.
#include "store/store_work.hpp"

#include <algorithm>
#include <utility>

namespace linefeed::store {

void StoreWork::offer(const OfferFollower& follower) {
    if (supply_ == nullptr && !follower.records.empty()) {
        follower_ = follower;
        replies_.emplace_back(FollowerKnown{follower.records.count()});
    }
}

/// Nothing may be left of the job behind this run. Of the job before it, the printer reports neither 0 nor another
/// number any more.
bool StoreWork::may_be_followed(const Part& part, RecordRange records) const {
    return records.last() == part.places.through(part.places.last) &&
           part.keeper.durably_printed() > part.places.number;
}

/// Nothing comes of it where the job may not be followed, or the ledger knows the follower already: then the line stops
/// in between.
void StoreWork::begin_follower(const feeder::BeginRun& begin) {
    if (wants_commit()) {
        commit();
    }
    if (!failure_.empty() || !follower_ || parts_.size() > 1) {
        return;
    }
    const Part& before = parts_.front();
    const OfferFollower follower = *std::exchange(follower_, std::nullopt);
    const auto job = spool_.job(before.keeper.job());
    if (!job) {
        fail(job.error());
        return;
    }
    if (!may_be_followed(before, (*job)->records)) {
        return;
    }
    auto keeper = before.keeper.begin_follower(begin, follower.job, follower.records);
    if (!keeper) {
        fail(keeper.error());
    } else if (*keeper) {
        const RecordNumber first = before.places.last.next();
        const RecordNumber number = follower.records.first();
        const RecordRange places{first, follower.records.count()};
        parts_.push_back({std::move(**keeper), {first, number, places.last()}, true, follower.records});
        numbering_.append(first, number);
        replies_.emplace_back(FollowerBegun{places, number});
    }
}

/// A follower's records only as far as each number tells which job it belongs to.
void StoreWork::extend_intents() {
    const Part& printed = parts_.front();
    const RecordNumber distinct =
        parts_.size() == 1 ? RecordNumber::max()
                           : numbering_.distinct_through(printed.places.place_of(printed.keeper.durably_printed()));
    for (Part& part : parts_) {
        if (const RecordNumber through = std::min(intent_wanted_, distinct); through >= part.places.first) {
            part.keeper.intent(part.places.through(through));
        }
    }
}

void StoreWork::confirm(RecordNumber through, const protocol::MailStatus& evidence) {
    for (Part& part : parts_) {
        if (through >= part.places.first) {
            part.keeper.printed(part.places.through(through), evidence);
        }
    }
}

/// The ledger knows of the first print of the follower, so the printer reports no record of the job any more.
void StoreWork::leave_printed_job() {
    if (parts_.size() == 1 || parts_.back().keeper.durably_printed() < parts_.back().places.number) {
        return;
    }
    Part& printed = parts_.front();
    if (const auto finished = printed.keeper.finish({.code = feeder::OutcomeCode::finished}); !finished) {
        fail(finished.error());
        return;
    }
    parts_.pop_front();
    numbering_.forget_before(parts_.front().places.first);
}

} // namespace linefeed::store
