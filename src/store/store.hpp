// One run's way to the store thread, so that a refill never waits for the disk (design, section 3): requests and
// replies travel in single-producer single-consumer rings between the feed thread and the store thread.
#pragma once

#include "store/event_signal.hpp"
#include "store/store_work.hpp"

#include <boost/lockfree/spsc_queue.hpp>

#include <atomic>
#include <new>
#include <string>

namespace linefeed::store {

/// Flow: construct, StoreThread::add(); requests and replies; the End request is the last, after it join().
class Store {
public:
    explicit Store(StoreWork work);
    ~Store();
    Store(const Store&) = delete;
    Store& operator=(const Store&) = delete;

    // Feed thread
    /// False if the ring is full; then try again later.
    [[nodiscard]] bool push(const StoreRequest& request);
    /// Free places for requests.
    [[nodiscard]] std::size_t room() const { return requests_.write_available(); }
    [[nodiscard]] bool pop(StoreReply& reply) { return replies_.pop(reply); }
    /// Becomes readable when replies wait.
    [[nodiscard]] EventSignal& replies_signal() { return replies_signal_; }

    // Store thread
    [[nodiscard]] const StoreWork& work() const { return work_; }
    [[nodiscard]] bool take_requests();
    /// Carries out one step; when it runs out of memory the storage has failed, and the thread lives on.
    template <typename Step>
    void guarded(Step step) {
        try {
            step(work_);
        } catch (const std::bad_alloc&) {
            out_of_memory();
        }
    }
    void send_replies();
    /// The store thread is done with it: it may be destroyed.
    void end();

    // Whoever has constructed it
    /// `requests` = what wakes the store thread.
    void begin(EventSignal& requests);
    /// Waits for end(), if it has begun.
    void join();
    /// After join(): what went wrong with the storage; empty = nothing.
    [[nodiscard]] const std::string& failure() const { return work_.failure(); }

    static constexpr std::size_t ring_capacity = 256;

private:
    void send(const StoreReply& reply);
    void out_of_memory();

    StoreWork work_;
    boost::lockfree::spsc_queue<StoreRequest, boost::lockfree::capacity<ring_capacity>> requests_;
    boost::lockfree::spsc_queue<StoreReply, boost::lockfree::capacity<ring_capacity>> replies_;
    EventSignal* requests_signal_ = nullptr;
    EventSignal replies_signal_;
    std::atomic<bool> serving_{false};
};

} // namespace linefeed::store
