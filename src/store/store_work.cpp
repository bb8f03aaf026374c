#include "store/store_work.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>
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

/// nullptr = all is read.
template <typename Parts>
auto* next_to_read(Parts& parts) {
    const auto part = std::ranges::find_if(parts, [](const auto& any) { return !any.to_read.empty(); });
    return part == parts.end() ? nullptr : &*part;
}

/// The number of the first record becomes 0: `^0=MR` and the number, up to the first TAB.
void begin_with_zero(RecordPage& page) {
    constexpr std::size_t digits_at = std::string_view{"^0=MR"}.size();
    const std::size_t digits = page.frames.find('\t') - digits_at;
    page.frames.replace(digits_at, digits, "0");
    for (std::uint32_t& end : page.ends) {
        end -= static_cast<std::uint32_t>(digits - 1);
    }
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
            [&](const FollowerKnown& known) { session.on_follower_known(known.count); },
            [&](const FollowerBegun& begun) { session.on_follower_begun(begun.places, begun.number, now, effects); },
        },
        reply);
}

StoreWork::StoreWork(spool::Spool& spool, LedgerKeeper keeper, Supply* supply)
    : spool_(spool)
    , supply_(supply) {
    parts_.push_back({std::move(keeper)});
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
                           begin.follower ? begin_follower(begin) : grant(begin);
                       }
                   },
                   [&](const feeder::AdoptRun& adopted) {
                       if (writable) {
                           adopt(adopted);
                       }
                   },
                   [&](const feeder::AskIntent& intent) {
                       intent_wanted_ = std::max(intent_wanted_, intent.through);
                       extend_intents();
                   },
                   [&](const feeder::ConfirmPrinted& printed) { confirm(printed.through, printed.evidence); },
                   [&](const OfferFollower& follower) { offer(follower); },
               },
               request);
}

void StoreWork::take_page_back(const RecordPage* page) {
    std::erase_if(lent_, [page](const auto& lent) { return lent.get() == page; });
}

void StoreWork::settle(const feeder::Settle& verdict) {
    if (!verdict.earlier_run) {
        settle_parts(verdict);
        return;
    }
    if (const auto done = parts_.front().keeper.settle_earlier(verdict); !done) {
        fail(done.error());
    } else {
        replies_.emplace_back(Settled{});
    }
}

/// Of both jobs in one transaction: what one says of the other's records must not be lost in between.
void StoreWork::settle_parts(const feeder::Settle& verdict) {
    intent_wanted_ = intent_through(); // nothing more goes out
    for (Part& part : parts_) {
        part.keeper.confirm(part.places.through(verdict.confirmed_through), verdict.evidence.mail);
    }
    if (wants_commit()) {
        commit();
    }
    std::vector<spool::JobRows> rows;
    for (auto part = parts_.begin(); part != parts_.end() && failure_.empty(); ++part) {
        auto own = part->keeper.verdict_rows(in_job(verdict, part->places));
        if (own) {
            rows.push_back(std::move(*own));
        } else {
            fail(own.error());
        }
    }
    if (!failure_.empty()) {
        return;
    }
    if (const auto done = append_all(spool_, std::move(rows)); !done) {
        fail(done.error());
    } else {
        replies_.emplace_back(Settled{});
    }
}

void StoreWork::grant(const feeder::BeginRun& begin) {
    const auto grant = parts_.front().keeper.grant(begin);
    if (!grant) {
        fail(grant.error());
    } else if (grant->range.empty()) {
        const bool in_doubt = grant->in_doubt;
        replies_.emplace_back(
            Refused{in_doubt ? feeder::OutcomeCode::records_in_doubt : feeder::OutcomeCode::nothing_to_print});
    } else {
        go_on(*grant, grant->range.first().previous());
    }
}

void StoreWork::adopt(const feeder::AdoptRun& adopted) {
    LedgerKeeper& keeper = parts_.front().keeper;
    const auto grant = keeper.adopt(adopted);
    if (!grant) {
        fail(grant.error());
        return;
    }
    go_on(*grant, adopted.sent_through);
}

void StoreWork::go_on(const LedgerKeeper::Grant& grant, RecordNumber read_behind) {
    Part& part = parts_.front();
    part.places = {grant.range.first(), grant.range.first(), grant.range.last()};
    part.to_read =
        read_behind == grant.range.last() ? RecordRange{} : RecordRange::closed(read_behind.next(), grant.range.last());
    intent_wanted_ = durable_reported_ = grant.durable_through;
    replies_.emplace_back(Granted{grant.range, grant.durable_through});
}

/// Of both jobs in one transaction, as they are settled.
void StoreWork::end(const feeder::End& end) {
    ended_ = true;
    std::vector<spool::JobRows> rows;
    for (auto part = parts_.begin(); part != parts_.end() && failure_.empty(); ++part) {
        feeder::Outcome own = end.outcome;
        own.broken_off = part->places.record_at(end.outcome.broken_off);
        auto last = part->keeper.end_rows(own);
        if (last) {
            std::ranges::move(*last, std::back_inserter(rows));
        } else {
            fail(last.error());
        }
    }
    if (failure_.empty()) {
        if (const auto written = append_all(spool_, std::move(rows)); !written) {
            fail(written.error());
        }
    }
}

bool StoreWork::wants_commit() const {
    const auto has_pending = [](const Part& part) { return part.keeper.has_pending(); };
    return failure_.empty() && !ended_ && std::ranges::any_of(parts_, has_pending);
}

bool StoreWork::intent_waits() const {
    return wants_commit() && intent_through() > durable_reported_;
}

void StoreWork::commit() {
    LINEFEED_ASSERT(failure_.empty());
    if (const auto written = append_all(spool_, pending_rows()); !written) {
        fail(written.error());
        return;
    }
    rows_written();
}

std::vector<spool::JobRows> StoreWork::pending_rows() const {
    std::vector<spool::JobRows> rows;
    for (const Part& part : parts_) {
        if (part.keeper.has_pending()) {
            rows.push_back({part.keeper.job(), part.keeper.pending_rows()});
        }
    }
    return rows;
}

void StoreWork::rows_written() {
    for (Part& part : parts_) {
        part.keeper.rows_written();
    }
    report_durable();
    leave_printed_job();
    extend_intents();
}

/// Place.
RecordNumber StoreWork::intent_through() const {
    const Part& last = parts_.back();
    const bool begun = last.keeper.intent_through() >= last.places.number;
    const Part& reached = begun ? last : parts_.front();
    return reached.places.place_of(reached.keeper.intent_through());
}

void StoreWork::report_durable() {
    if (intent_through() > durable_reported_) {
        durable_reported_ = intent_through();
        replies_.emplace_back(Durable{durable_reported_});
    }
}

/// What can be read of it now.
RecordRange StoreWork::readable(const Part& part) const {
    if (supply_ == nullptr) {
        return part.to_read;
    }
    return RecordRange::closed(part.to_read.first(), std::min(part.to_read.last(), supply_->durable().last()));
}

/// A slow source makes small pages. So that those lent hold a first fill for sure, half of them are kept for pages that
/// are worth it.
bool StoreWork::wants_read_ahead() const {
    if (!failure_.empty() || ended_ || lent_.size() >= session::max_pages) {
        return false;
    }
    const auto* const part = next_to_read(parts_);
    const RecordRange next = part != nullptr ? readable(*part) : RecordRange{};
    const bool rest = part != nullptr && next == part->to_read;
    return !next.empty() && (rest || lent_.size() < session::max_pages / 2 || next.count() >= worthwhile_records);
}

void StoreWork::read_ahead() {
    Part& part = *next_to_read(parts_);
    const RecordRange next = readable(part);
    auto page = spool_.read_page(part.keeper.job(), next.first());
    while (page && page->range().count() < worthwhile_records && page->frames.size() < worthwhile_bytes &&
           page->range().last() < next.last()) {
        const auto more = spool_.read_page(part.keeper.job(), page->range().last().next());
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
    part.to_read = last >= part.to_read.last() ? RecordRange{} : RecordRange::closed(last.next(), part.to_read.last());
    if (part.follows && page->first == part.places.number) {
        begin_with_zero(*page);
    }
    page->first = part.places.place_of(page->first);
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
    Part& part = parts_.front();
    part.keeper.imported(there.last());
    if (supply_->end_known()) {
        supply_over_ = true;
        part.keeper.end_at(there.last());
        if (!part.to_read.empty()) {
            part.to_read = RecordRange::closed(part.to_read.first(), std::min(part.to_read.last(), there.last()));
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
