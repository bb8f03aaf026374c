// The store thread: the only writer of the spool (design, section 3). It serves the runs of all printers: what they
// want written is gathered into one transaction, so that many printers cost hardly more syncs than one.
#pragma once

#include "spool/spool.hpp"
#include "store/event_signal.hpp"
#include "store/shared_count.hpp"
#include "store/store.hpp"

#include <chrono>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace linefeed::store {

/// Flow: add() a Store for each run; the last reference to a Store goes with its End request. While any run is under
/// way, others use the spool through call() only. All runs must have ended before it is destroyed.
class StoreThread {
public:
    explicit StoreThread(spool::Spool& spool);
    ~StoreThread();
    StoreThread(const StoreThread&) = delete;
    StoreThread& operator=(const StoreThread&) = delete;

    /// Serves `store` until its End request; Store::join() waits for that.
    void add(Store& store);
    /// Does something with the spool between two steps of the thread, and waits until it is done. What it throws is
    /// thrown here. Only one of these comes between two steps for the runs, so each should take no longer than one of
    /// those: some ms and one sync.
    void call(const std::function<void(spool::Spool&)>& what);
    /// As call(), but does not wait. Precondition: it throws nothing.
    void post(std::function<void(spool::Spool&)> what);
    /// Rises at least once a second as long as the thread gets on, a call() of others included; any thread.
    [[nodiscard]] std::uint64_t beats() const { return beats_; }
    /// How long it took to write rows of the ledger, each time with its sync; any thread.
    [[nodiscard]] const SharedHistogram& commit_times() const { return commit_times_; }

private:
    using Clock = std::chrono::steady_clock;

    void run();
    void let_in();
    void add_call(std::function<void()> what);
    bool take_call();
    bool work(Clock::time_point now);
    [[nodiscard]] bool take_requests();
    [[nodiscard]] bool any(bool (StoreWork::*wants)() const) const;
    void commit();
    void write_pending();
    [[nodiscard]] bool commit_together();
    bool take_turns(bool (StoreWork::*wants)() const, void (StoreWork::*step)());
    void checkpoint();
    void let_go_of_ended();

    spool::Spool& spool_;
    EventSignal signal_;
    SharedHistogram commit_times_;
    SharedCount beats_;
    std::vector<Store*> stores_;
    std::vector<Store*> writers_; ///< those that want a commit; has room for all
    std::size_t next_turn_ = 0;   ///< whose turn it is to have a page read or written
    Clock::time_point last_commit_ = Clock::now();
    Clock::time_point last_checkpoint_ = last_commit_;

    std::mutex outside_; ///< guards what follows; the feed thread never takes it
    std::vector<Store*> arriving_;
    std::deque<std::function<void()>> calls_;
    bool stopping_ = false;
    std::thread thread_;
};

} // namespace linefeed::store
