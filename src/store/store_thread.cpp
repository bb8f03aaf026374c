#include "store/store_thread.hpp"

#include <algorithm>
#include <future>
#include <iterator>
#include <new>
#include <utility>

namespace linefeed::store {

namespace {
constexpr int idle_wait_ms = 1000;
/// Confirmations are gathered for this long, well below the 50 ms in which they must be durable.
constexpr auto gather = std::chrono::milliseconds{10};
constexpr auto checkpoint_interval = std::chrono::seconds{5};

int wait_ms(std::chrono::steady_clock::duration left) {
    return static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(left).count());
}
} // namespace

StoreThread::StoreThread(spool::Spool& spool)
    : spool_(spool)
    , thread_([this] { run(); }) {}

StoreThread::~StoreThread() {
    {
        const std::lock_guard lock{outside_};
        stopping_ = true;
    }
    signal_.notify();
    thread_.join();
}

void StoreThread::add(Store& store) {
    store.begin(signal_);
    {
        const std::lock_guard lock{outside_};
        arriving_.push_back(&store);
    }
    signal_.notify();
}

void StoreThread::call(const std::function<void(spool::Spool&)>& what) {
    std::packaged_task<void()> task{[&] { what(spool_); }};
    auto done = task.get_future();
    add_call([&task] { task(); });
    done.get();
}

void StoreThread::post(std::function<void(spool::Spool&)> what) {
    add_call([this, what = std::move(what)] { what(spool_); });
}

void StoreThread::add_call(std::function<void()> what) {
    {
        const std::lock_guard lock{outside_};
        calls_.push_back(std::move(what));
    }
    signal_.notify();
}

void StoreThread::let_in() {
    const std::lock_guard lock{outside_};
    stores_.insert(stores_.end(), arriving_.begin(), arriving_.end());
    arriving_.clear();
    writers_.reserve(stores_.size());
}

/// At most one at a time, however many wait. False if none does.
bool StoreThread::take_call() {
    std::function<void()> call;
    {
        const std::lock_guard lock{outside_};
        if (calls_.empty()) {
            return false;
        }
        call = std::move(calls_.front());
        calls_.pop_front();
    }
    call();
    return true;
}

bool StoreThread::take_requests() {
    bool taken = false;
    for (Store* store : stores_) {
        taken = store->take_requests() || taken;
    }
    return taken;
}

bool StoreThread::any(bool (StoreWork::*wants)() const) const {
    return std::ranges::any_of(stores_, [wants](const Store* store) { return (store->work().*wants)(); });
}

void StoreThread::commit() {
    const Clock::time_point begun = Clock::now();
    write_pending();
    commit_times_.record(Clock::now() - begun);
}

void StoreThread::write_pending() {
    writers_.clear();
    std::ranges::copy_if(stores_, std::back_inserter(writers_),
                         [](const Store* store) { return store->work().wants_commit(); });
    if (writers_.size() > 1 && commit_together()) {
        return;
    }
    for (Store* store : writers_) {
        store->guarded([](StoreWork& work) { work.commit(); });
    }
}

/// False if it did not work out: then each is written by itself, so that it is known whose rows are the reason.
bool StoreThread::commit_together() {
    try {
        std::vector<spool::JobRows> rows;
        for (const Store* store : writers_) {
            std::ranges::move(store->work().pending_rows(), std::back_inserter(rows));
        }
        if (!spool_.append_together(rows)) {
            return false;
        }
    } catch (const std::bad_alloc&) {
        return false;
    }
    for (Store* store : writers_) {
        store->guarded([](StoreWork& work) { work.rows_written(); });
    }
    return true;
}

/// One step for one run: then it is looked again whether something is more urgent. False if none wants it.
bool StoreThread::take_turns(bool (StoreWork::*wants)() const, void (StoreWork::*step)()) {
    for (std::size_t looked = 0; looked < stores_.size(); ++looked) {
        Store& store = *stores_[next_turn_++ % stores_.size()];
        if ((store.work().*wants)()) {
            store.guarded([step](StoreWork& work) { (work.*step)(); });
            return true;
        }
    }
    return false;
}

/// By any of the runs: a failure is the next commit's as well.
void StoreThread::checkpoint() {
    if (!stores_.empty()) {
        stores_.front()->guarded([](StoreWork& work) { work.checkpoint(); });
    }
}

void StoreThread::let_go_of_ended() {
    std::erase_if(stores_, [](Store* store) {
        const bool ended = store->work().ended();
        if (ended) {
            store->end(); // it may be gone from here on
        }
        return ended;
    });
}

/// What is most urgent for the runs. False if there was nothing to do.
bool StoreThread::work(Clock::time_point now) {
    const bool commit_is_due = any(&StoreWork::wants_commit) && now - last_commit_ >= gather;
    if (commit_is_due || any(&StoreWork::intent_waits)) {
        commit();
        last_commit_ = Clock::now();
        return true;
    }
    if (take_turns(&StoreWork::wants_read_ahead, &StoreWork::read_ahead) ||
        take_turns(&StoreWork::wants_supply_step, &StoreWork::supply_step)) {
        return true;
    }
    if (now - last_checkpoint_ >= checkpoint_interval) {
        checkpoint();
        last_checkpoint_ = now;
        return true;
    }
    return false;
}

void StoreThread::run() {
    while (true) {
        beats_ += 1;
        let_in();
        {
            const std::lock_guard lock{outside_};
            if (stopping_ && stores_.empty() && arriving_.empty() && calls_.empty()) {
                return;
            }
        }
        bool worked = take_requests();
        const Clock::time_point now = Clock::now();
        worked = work(now) || worked;
        worked = take_call() || worked;
        for (Store* store : stores_) {
            store->send_replies();
        }
        let_go_of_ended();
        if (!worked) {
            signal_.wait(any(&StoreWork::wants_commit) ? wait_ms(last_commit_ + gather - now) : idle_wait_ms);
        }
    }
}

} // namespace linefeed::store
