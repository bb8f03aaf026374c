#include "daemon/feed_thread.hpp"

#include "base/assert.hpp"

#include <boost/asio/bind_allocator.hpp>

#include <chrono>
#include <future>
#include <unistd.h>

namespace linefeed::daemon {

namespace {
thread_local bool feeds = false;
constexpr auto beat_interval = std::chrono::milliseconds{100};
} // namespace

bool FeedThread::is_current() noexcept {
    return feeds;
}

FeedThread::FeedThread(const RealTimeSettings& settings)
    : settings_(settings)
    , door_(context_, ::dup(door_signal_.descriptor()))
    , beat_timer_(context_) {}

FeedThread::~FeedThread() {
    if (thread_.joinable()) {
        stopping_.store(true, std::memory_order_release);
        door_signal_.notify();
        thread_.join();
    }
}

std::string FeedThread::start() {
    LINEFEED_ASSERT(!thread_.joinable());
    wait_for_guests();
    beat();
    std::promise<std::string> granted;
    auto told = granted.get_future();
    thread_ = std::thread{[this, &granted] {
        feeds = true;
        granted.set_value(make_real_time(settings_));
        context_.run();
    }};
    return told.get();
}

void FeedThread::let_in(Guest& guest) {
    {
        const std::lock_guard lock{outside_};
        LINEFEED_ASSERT(waiting_.push(&guest));
    }
    door_signal_.notify();
}

void FeedThread::beat() {
    beats_.fetch_add(1, std::memory_order_relaxed);
    beat_timer_.expires_after(beat_interval);
    const auto handler = [this](const boost::system::error_code& error) {
        if (!error) {
            beat();
        }
    };
    beat_timer_.async_wait(boost::asio::bind_allocator(link::HandlerAllocator<>{beat_memory_}, handler));
}

void FeedThread::wait_for_guests() {
    door_.async_wait(boost::asio::posix::stream_descriptor::wait_read, [this](const boost::system::error_code& error) {
        if (error) {
            return;
        }
        door_signal_.clear();
        if (stopping_.load(std::memory_order_acquire)) {
            context_.stop();
            return;
        }
        Guest* guest = nullptr;
        while (waiting_.pop(guest)) {
            guest->on_feed_thread();
        }
        wait_for_guests();
    });
}

} // namespace linefeed::daemon
