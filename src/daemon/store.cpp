#include "daemon/store.hpp"

#include <algorithm>
#include <chrono>

namespace linefeed::daemon {

using Clock = std::chrono::steady_clock;

namespace {
constexpr int idle_wait_ms = 1000;
/// Confirmations are gathered for this long, well below the 50 ms in which they must be durable.
constexpr auto gather = std::chrono::milliseconds{10};
constexpr auto checkpoint_interval = std::chrono::seconds{5};
} // namespace

Store::Store(spool::Spool& spool, spool::JobId job, LedgerKeeper keeper)
    : spool_(spool)
    , job_(job)
    , keeper_(std::move(keeper)) {}

Store::~Store() {
    join();
}

void Store::start() {
    thread_ = std::thread{[this] { run(); }};
}

void Store::join() {
    if (thread_.joinable()) {
        thread_.join();
    }
}

bool Store::push(const StoreRequest& request) {
    if (!requests_.push(request)) {
        return false;
    }
    requests_signal_.notify();
    return true;
}

void Store::reply(const StoreReply& reply) {
    // The lent pages, one answer for each grant and settlement, and one for each intent that the feeder waits for: few
    // at a time.
    LINEFEED_ASSERT(replies_.push(reply));
    replies_signal_.notify();
}

void Store::run() {
    Clock::time_point last_commit = Clock::now();
    Clock::time_point last_checkpoint = last_commit;
    while (!ended_) {
        StoreRequest request;
        const RecordNumber intents_before = keeper_.intent_through();
        bool any = false;
        while (!ended_ && requests_.pop(request)) {
            take(request);
            any = true;
        }
        const Clock::time_point now = Clock::now();
        const bool intent_waits = keeper_.intent_through() != intents_before;
        if (keeper_.has_pending() && (intent_waits || now - last_commit >= gather)) {
            commit();
            last_commit = Clock::now();
        }
        if (failure_.empty() && !to_read_.empty() && lent_.size() < session::max_pages) {
            read_ahead();
            continue;
        }
        if (failure_.empty() && now - last_checkpoint >= checkpoint_interval) {
            last_checkpoint = now;
            if (const auto done = spool_.checkpoint(); !done) {
                fail(done.error());
            }
        }
        if (!any && !ended_) {
            requests_signal_.wait(keeper_.has_pending() ? static_cast<int>(gather.count()) : idle_wait_ms);
        }
    }
    lent_.clear();
}

void Store::take(const StoreRequest& request) {
    if (const auto* returned = std::get_if<PageReturned>(&request)) {
        std::erase_if(lent_, [&](const auto& page) { return page.get() == returned->page; });
        return;
    }
    if (const auto* end = std::get_if<feeder::End>(&request)) {
        ended_ = true;
        if (failure_.empty()) {
            if (const auto finished = keeper_.finish(end->outcome); !finished) {
                fail(finished.error());
            }
        }
        return;
    }
    if (!failure_.empty()) {
        return; // nothing is durable any more: the line is being stopped
    }
    if (const auto* settle = std::get_if<feeder::Settle>(&request)) {
        const auto done = settle->earlier_run ? keeper_.settle_earlier(*settle) : keeper_.settle(*settle);
        if (!done) {
            fail(done.error());
        } else if (!settle->earlier_run) {
            reply(Settled{});
        }
    } else if (const auto* begin = std::get_if<feeder::BeginRun>(&request)) {
        const auto grant = keeper_.grant(*begin);
        if (!grant) {
            fail(grant.error());
        } else if (grant->range.empty()) {
            reply(Refused{grant->in_doubt ? feeder::OutcomeCode::records_in_doubt
                                          : feeder::OutcomeCode::nothing_to_print});
        } else {
            to_read_ = grant->range;
            durable_reported_ = grant->durable_through;
            reply(Granted{grant->range, grant->durable_through});
        }
    } else if (const auto* intent = std::get_if<feeder::AskIntent>(&request)) {
        keeper_.intent(intent->through);
    } else if (const auto* confirm = std::get_if<feeder::ConfirmPrinted>(&request)) {
        keeper_.printed(confirm->through, confirm->evidence);
    }
}

void Store::commit() {
    if (!failure_.empty()) {
        return;
    }
    if (const auto committed = keeper_.commit(); !committed) {
        fail(committed.error());
        return;
    }
    if (keeper_.intent_through() > durable_reported_) {
        durable_reported_ = keeper_.intent_through();
        reply(Durable{durable_reported_});
    }
}

void Store::read_ahead() {
    auto page = spool_.read_page(job_, to_read_.first());
    if (!page) {
        fail(page.error());
        return;
    }
    const RecordNumber last = page->range().last();
    to_read_ = last >= to_read_.last() ? RecordRange{} : RecordRange::closed(last.next(), to_read_.last());
    lent_.push_back(std::make_unique<RecordPage>(std::move(*page)));
    reply(PageReady{lent_.back().get()});
}

void Store::fail(const Failure& failure) {
    if (failure_.empty()) {
        failure_ = failure.message;
        reply(StorageFailed{});
    }
}

} // namespace linefeed::daemon
