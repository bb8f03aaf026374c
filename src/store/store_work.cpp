#include "store/store_work.hpp"

#include <utility>

namespace linefeed::store {

namespace {

template <typename... Visitors>
struct Overloaded : Visitors... {
    using Visitors::operator()...;
};
template <typename... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

/// So many records make a page worth being lent.
constexpr RecordCount worthwhile_records{256};
constexpr std::size_t worthwhile_bytes = std::size_t{64} * 1024;

void append(RecordPage& page, const RecordPage& more) {
    const auto offset = static_cast<std::uint32_t>(page.frames.size());
    for (const std::uint32_t end : more.ends) {
        page.ends.push_back(offset + end);
    }
    page.frames += more.frames;
}

} // namespace

void deliver(const StoreReply& reply, session::Session& session, Instant now, session::Effects& effects) {
    std::visit(
        Overloaded{
            [](std::monostate) {},
            [&](const Granted& granted) { session.on_granted(granted.range, granted.durable_through, now, effects); },
            [&](const Refused& refused) { session.on_refused(refused.why, now, effects); },
            [&](const Durable& durable) { session.on_durable(durable.through, now, effects); },
            [&](const EndKnown& end) { session.on_end_known(end.last, now, effects); },
            [&](const SupplyFailed&) { session.request_stop(now, effects); },
            [&](const Settled&) { session.on_settled(now, effects); },
            [&](const PageReady& ready) { session.on_page(ready.page, now, effects); },
            [&](const StorageFailed&) { session.on_storage_failed(now, effects); },
        },
        reply);
}

StoreWork::StoreWork(spool::Spool& spool, spool::JobId job, LedgerKeeper keeper, Supply* supply)
    : spool_(spool)
    , job_(job)
    , keeper_(std::move(keeper))
    , supply_(supply) {
    if (supply_ != nullptr) {
        take_supply();
        replies_.clear(); // nothing has begun that could end
    }
}

void StoreWork::take(const StoreRequest& request) {
    LINEFEED_ASSERT(!ended_);
    const bool writable = failure_.empty(); // otherwise nothing is durable any more: the line is being stopped
    std::visit(Overloaded{
                   [](std::monostate) {},
                   [&](const PageReturned& returned) { take_page_back(returned.page); },
                   [&](const feeder::End& last) { end(last); },
                   [&](const feeder::Settle& verdict) {
                       if (writable) {
                           settle(verdict);
                       }
                   },
                   [&](const feeder::BeginRun& begin) {
                       if (writable) {
                           grant(begin);
                       }
                   },
                   [&](const feeder::AdoptRun& adopted) {
                       if (writable) {
                           adopt(adopted);
                       }
                   },
                   [&](const feeder::AskIntent& intent) { keeper_.intent(intent.through); },
                   [&](const feeder::ConfirmPrinted& confirm) { keeper_.printed(confirm.through, confirm.evidence); },
               },
               request);
}

void StoreWork::take_page_back(const RecordPage* page) {
    std::erase_if(lent_, [page](const auto& lent) { return lent.get() == page; });
}

void StoreWork::settle(const feeder::Settle& verdict) {
    const auto done = verdict.earlier_run ? keeper_.settle_earlier(verdict) : keeper_.settle(verdict);
    if (!done) {
        fail(done.error());
    } else {
        replies_.emplace_back(Settled{});
    }
}

void StoreWork::grant(const feeder::BeginRun& begin) {
    const auto grant = keeper_.grant(begin);
    if (!grant) {
        fail(grant.error());
    } else if (grant->range.empty()) {
        const bool in_doubt = grant->in_doubt;
        replies_.emplace_back(
            Refused{in_doubt ? feeder::OutcomeCode::records_in_doubt : feeder::OutcomeCode::nothing_to_print});
    } else {
        to_read_ = grant->range;
        durable_reported_ = grant->durable_through;
        replies_.emplace_back(Granted{grant->range, grant->durable_through});
    }
}

void StoreWork::adopt(const feeder::AdoptRun& adopted) {
    const auto grant = keeper_.adopt(adopted);
    if (!grant) {
        fail(grant.error());
        return;
    }
    to_read_ = adopted.sent_through == grant->range.last()
                   ? RecordRange{}
                   : RecordRange::closed(adopted.sent_through.next(), grant->range.last());
    durable_reported_ = grant->durable_through;
    replies_.emplace_back(Granted{grant->range, grant->durable_through});
}

void StoreWork::end(const feeder::End& end) {
    ended_ = true;
    if (failure_.empty()) {
        if (const auto finished = keeper_.finish(end.outcome); !finished) {
            fail(finished.error());
        }
    }
}

bool StoreWork::wants_commit() const {
    return failure_.empty() && !ended_ && keeper_.has_pending();
}

bool StoreWork::intent_waits() const {
    return wants_commit() && keeper_.intent_through() > durable_reported_;
}

void StoreWork::commit() {
    LINEFEED_ASSERT(failure_.empty());
    if (const auto committed = keeper_.commit(); !committed) {
        fail(committed.error());
        return;
    }
    report_durable();
}

void StoreWork::rows_written() {
    keeper_.rows_written();
    report_durable();
}

void StoreWork::report_durable() {
    if (keeper_.intent_through() > durable_reported_) {
        durable_reported_ = keeper_.intent_through();
        replies_.emplace_back(Durable{durable_reported_});
    }
}

/// What can be read of to_read_ now.
RecordRange StoreWork::readable() const {
    if (supply_ == nullptr || to_read_.empty()) {
        return to_read_;
    }
    return RecordRange::closed(to_read_.first(), std::min(to_read_.last(), supply_->durable().last()));
}

/// A slow source makes small pages. So that those lent hold a first fill for sure, half of them are kept for pages that
/// are worth it.
bool StoreWork::wants_read_ahead() const {
    if (!failure_.empty() || ended_ || lent_.size() >= session::max_pages) {
        return false;
    }
    const RecordRange next = readable();
    const bool rest = next == to_read_;
    return !next.empty() && (rest || lent_.size() < session::max_pages / 2 || next.count() >= worthwhile_records);
}

void StoreWork::read_ahead() {
    const RecordRange next = readable();
    auto page = spool_.read_page(job_, next.first());
    while (page && page->range().count() < worthwhile_records && page->frames.size() < worthwhile_bytes &&
           page->range().last() < next.last()) {
        const auto more = spool_.read_page(job_, page->range().last().next());
        if (!more) {
            page = more.error();
            break;
        }
        append(*page, *more);
    }
    if (!page) {
        fail(page.error());
        return;
    }
    const RecordNumber last = page->range().last();
    to_read_ = last >= to_read_.last() ? RecordRange{} : RecordRange::closed(last.next(), to_read_.last());
    lent_.push_back(std::make_unique<RecordPage>(std::move(*page)));
    replies_.emplace_back(PageReady{lent_.back().get()});
}

bool StoreWork::wants_supply_step() const {
    return failure_.empty() && !ended_ && supply_ != nullptr && !supply_over_ && supply_->wants_step();
}

void StoreWork::supply_step() {
    supply_->step();
    take_supply();
}

void StoreWork::take_supply() {
    const RecordRange there = supply_->durable();
    keeper_.imported(there.last());
    if (supply_->end_known()) {
        supply_over_ = true;
        keeper_.end_at(there.last());
        if (!to_read_.empty()) {
            to_read_ = RecordRange::closed(to_read_.first(), std::min(to_read_.last(), there.last()));
        }
        replies_.emplace_back(EndKnown{there.last()});
    } else if (supply_->failure()) {
        supply_over_ = true;
        if (supply_->failure()->kind == FailureKind::storage) {
            fail(*supply_->failure());
        } else {
            replies_.emplace_back(SupplyFailed{});
        }
    }
}

void StoreWork::checkpoint() {
    if (failure_.empty()) {
        if (const auto done = spool_.checkpoint(); !done) {
            fail(done.error());
        }
    }
}

std::vector<StoreReply> StoreWork::take_replies() {
    return std::exchange(replies_, {});
}

void StoreWork::fail(Failure failure) {
    LINEFEED_ASSERT(failure_.empty());      // nothing is asked of the spool after the first
    replies_.emplace_back(StorageFailed{}); // if it throws, nothing has happened
    failure_ = std::move(failure.message);
}

bool StoreWork::fail_out_of_memory() noexcept {
    if (!failure_.empty()) {
        return false;
    }
    failure_ = "out of memory"; // short enough to need none
    return true;
}

} // namespace linefeed::store
