#include "api/workers.hpp"

#include "base/assert.hpp"

#include <boost/asio/post.hpp>
#include <boost/asio/thread_pool.hpp>

namespace linefeed::api {

namespace {

constexpr std::size_t threads_of(Lane lane) {
    switch (lane) {
    case Lane::at_once:
        return 0;
    case Lane::query:
    case Lane::change:
    case Lane::slow:
        return 2;
    case Lane::stop:
        return 8;
    case Lane::import:
    case Lane::disk:
        return 1;
    }
    assertion_failed("Lane", __FILE__, __LINE__);
}

} // namespace

struct Workers::Pool {
    explicit Pool(std::size_t count)
        : threads(count) {}

    boost::asio::thread_pool threads;
    std::atomic<std::size_t> tasks = 0;
};

Workers::Workers() {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
        if (const std::size_t threads = threads_of(static_cast<Lane>(lane)); threads > 0) {
            pools_[lane] = std::make_unique<Pool>(threads);
        }
    }
}

Workers::~Workers() {
    finish();
}

bool Workers::post(Lane lane, std::function<void()> task) {
    LINEFEED_ASSERT(pools_[static_cast<std::size_t>(lane)] != nullptr);
    Pool& pool = *pools_[static_cast<std::size_t>(lane)];
    if (finished_) {
        return false;
    }
    if (pool.tasks.fetch_add(1) >= max_tasks) {
        pool.tasks.fetch_sub(1);
        return false;
    }
    boost::asio::post(pool.threads, [&pool, task = std::move(task)]() mutable {
        task();
        task = nullptr; // what it holds goes on this thread
        pool.tasks.fetch_sub(1);
    });
    return true;
}

void Workers::finish() {
    finished_ = true;
    for (const auto& pool : pools_) {
        if (pool) {
            pool->threads.join();
        }
    }
}

} // namespace linefeed::api
