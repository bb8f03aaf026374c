// The store thread: the only writer of the spool. Reads pages ahead of the feed thread and commits intents and
// confirmations, so that a refill never waits for the disk (design, section 3). Requests and replies travel in
// single-producer single-consumer rings.
#pragma once

#include "base/record_page.hpp"
#include "daemon/event_signal.hpp"
#include "daemon/ledger_keeper.hpp"
#include "feeder/actions.hpp"
#include "session/page_window.hpp"
#include "spool/spool.hpp"

#include <boost/lockfree/spsc_queue.hpp>

#include <deque>
#include <memory>
#include <string>
#include <thread>
#include <variant>

namespace linefeed::daemon {

/// Feed thread → store: the feeder's ledger actions, and pages that are not needed any more.
struct PageReturned {
    const RecordPage* page = nullptr;
};
using StoreRequest = std::variant<std::monostate, feeder::Settle, feeder::BeginRun, feeder::AskIntent,
                                  feeder::ConfirmPrinted, feeder::End, PageReturned>;

/// Store → feed thread.
struct Granted {
    RecordRange range;
    RecordNumber durable_through;
};
struct Refused {
    feeder::OutcomeCode why = feeder::OutcomeCode::nothing_to_print;
};
struct Durable {
    RecordNumber through;
};
struct Settled {};
struct PageReady {
    const RecordPage* page = nullptr;
};
struct StorageFailed {};
using StoreReply = std::variant<std::monostate, Granted, Refused, Durable, Settled, PageReady, StorageFailed>;

/// Flow: construct, start(); requests and replies; the End request is the last, after it join(). While it runs, nobody
/// else may use the spool.
class Store {
public:
    Store(spool::Spool& spool, spool::JobId job, LedgerKeeper keeper);
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
    [[nodiscard]] const std::string& failure() const { return failure_; }

    static constexpr std::size_t ring_capacity = 256;

private:
    void run();
    void take(const StoreRequest& request);
    void commit();
    void read_ahead();
    void reply(const StoreReply& reply);
    void fail(const Failure& failure);

    spool::Spool& spool_;
    spool::JobId job_;
    LedgerKeeper keeper_;
    std::thread thread_;
    boost::lockfree::spsc_queue<StoreRequest, boost::lockfree::capacity<ring_capacity>> requests_;
    boost::lockfree::spsc_queue<StoreReply, boost::lockfree::capacity<ring_capacity>> replies_;
    EventSignal requests_signal_;
    EventSignal replies_signal_;

    RecordRange to_read_;                          ///< records whose pages have not been read yet
    std::deque<std::unique_ptr<RecordPage>> lent_; ///< at most session::max_pages
    RecordNumber durable_reported_;
    bool ended_ = false;
    std::string failure_;
};

} // namespace linefeed::daemon
