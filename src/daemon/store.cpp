#include "daemon/store.hpp"

#include <chrono>
#include <new>
#include <utility>

namespace linefeed::daemon {

using Clock = std::chrono::steady_clock;

namespace {
constexpr int idle_wait_ms = 1000;
/// Confirmations are gathered for this long, well below the 50 ms in which they must be durable.
constexpr auto gather = std::chrono::milliseconds{10};
constexpr auto checkpoint_interval = std::chrono::seconds{5};
} // namespace

Store::Store(StoreWork work)
    : work_(std::move(work)) {}

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

template <typename Step>
void Store::guarded(Step step) {
    try {
        step();
    } catch (const std::bad_alloc&) {
        send_replies(); // what was done before comes first
        if (work_.fail_out_of_memory()) {
            send(StorageFailed{});
        }
    }
}

bool Store::take_requests() {
    bool any = false;
    // In its place in the ring: a copy would need memory, and a request that throws is taken all the same.
    const auto take = [this](const StoreRequest& request) { guarded([&] { work_.take(request); }); };
    while (!work_.ended() && requests_.consume_one(take)) {
        any = true;
    }
    return any;
}

void Store::send(const StoreReply& reply) {
    // The lent pages, one answer for each grant and settlement, one for each intent that the feeder waits for, and one
    // failure: few at a time.
    LINEFEED_ASSERT(replies_.push(reply));
    replies_signal_.notify();
}

void Store::send_replies() {
    for (const StoreReply& reply : work_.take_replies()) {
        send(reply);
    }
}

void Store::run() {
    Clock::time_point last_commit = Clock::now();
    Clock::time_point last_checkpoint = last_commit;
    while (!work_.ended()) {
        const bool any = take_requests();
        const Clock::time_point now = Clock::now();
        if (work_.intent_waits() || (work_.wants_commit() && now - last_commit >= gather)) {
            guarded([this] { work_.commit(); });
            last_commit = Clock::now();
        } else if (work_.wants_read_ahead()) {
            guarded([this] { work_.read_ahead(); });
        } else if (now - last_checkpoint >= checkpoint_interval) {
            guarded([this] { work_.checkpoint(); });
            last_checkpoint = now;
        } else if (!any && !work_.ended()) {
            requests_signal_.wait(work_.wants_commit() ? static_cast<int>(gather.count()) : idle_wait_ms);
        }
        send_replies();
    }
}

} // namespace linefeed::daemon
