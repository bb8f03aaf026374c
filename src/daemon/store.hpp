// The store thread: the only writer of the spool. Reads pages ahead of the feed thread and commits intents and
// confirmations, so that a refill never waits for the disk (design, section 3). Requests and replies travel in
// single-producer single-consumer rings.
#pragma once

#include "daemon/event_signal.hpp"
#include "daemon/store_work.hpp"

#include <boost/lockfree/spsc_queue.hpp>

#include <string>
#include <thread>

namespace linefeed::daemon {

/// Flow: construct, start(); requests and replies; the End request is the last, after it join(). While it runs, nobody
/// else may use the spool.
class Store {
public:
    explicit Store(StoreWork work);
    ~Store();
    Store(const Store&) = delete;
    Store& operator=(const Store&) = delete;

    void start();
    void join();

    // Feed thread
    /// False if the ring is full; then try again later.
    [[nodiscard]] bool push(const StoreRequest& request);
    /// Free places for requests.
    [[nodiscard]] std::size_t room() const { return requests_.write_available(); }
    [[nodiscard]] bool pop(StoreReply& reply) { return replies_.pop(reply); }
    /// Becomes readable when replies wait.
    [[nodiscard]] EventSignal& replies_signal() { return replies_signal_; }

    /// After join(): what went wrong with the storage; empty = nothing.
    [[nodiscard]] const std::string& failure() const { return work_.failure(); }

    static constexpr std::size_t ring_capacity = 256;

private:
    void run();
    [[nodiscard]] bool take_requests();
    /// Carries out one step; when it runs out of memory the storage has failed, and the thread lives on.
    template <typename Step>
    void guarded(Step step);
    void send_replies();
    void send(const StoreReply& reply);

    StoreWork work_;
    std::thread thread_;
    boost::lockfree::spsc_queue<StoreRequest, boost::lockfree::capacity<ring_capacity>> requests_;
    boost::lockfree::spsc_queue<StoreReply, boost::lockfree::capacity<ring_capacity>> replies_;
    EventSignal requests_signal_;
    EventSignal replies_signal_;
};

} // namespace linefeed::daemon
