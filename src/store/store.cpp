#include "store/store.hpp"

#include <utility>

namespace linefeed::store {

Store::Store(StoreWork work)
    : work_(std::move(work)) {}

Store::~Store() {
    join();
}

void Store::begin(EventSignal& requests) {
    requests_signal_ = &requests;
    if (work_.supply() != nullptr) {
        work_.supply()->wake(&requests);
    }
    serving_.store(true, std::memory_order_release);
}

void Store::end() {
    if (work_.supply() != nullptr) {
        work_.supply()->wake(nullptr);
    }
    serving_.store(false, std::memory_order_release);
    serving_.notify_all();
}

void Store::join() {
    serving_.wait(true, std::memory_order_acquire);
}

bool Store::push(const StoreRequest& request) {
    if (!requests_.push(request)) {
        return false;
    }
    requests_signal_->notify();
    return true;
}

bool Store::take_requests() {
    bool any = false;
    // In its place in the ring: a copy would need memory, and a request that throws is taken all the same.
    const auto take = [this](const StoreRequest& request) {
        guarded([&request](StoreWork& work) { work.take(request); });
    };
    while (!work_.ended() && requests_.consume_one(take)) {
        any = true;
    }
    return any;
}

void Store::out_of_memory() {
    send_replies(); // what was done before comes first
    if (work_.fail_out_of_memory()) {
        send(StorageFailed{});
    }
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

} // namespace linefeed::store
