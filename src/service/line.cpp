#include "service/line.hpp"

#include "base/assert.hpp"
#include "daemon/events.hpp"

#include <algorithm>
#include <utility>

namespace linefeed::service {

Line::Line(const LineServices& services, std::string printer, SharedSettings settings, Past past)
    : services_(services)
    , printer_(std::move(printer))
    , settings_(std::move(settings))
    , held_(past.held)
    , known_serial_number_(std::move(past.serial_number))
    , memory_(std::move(past.memory))
    , thread_([this] { serve(); }) {}

Line::~Line() {
    request_stop();
    close();
    thread_.join();
}

void Line::close() {
    {
        const std::lock_guard lock{mutex_};
        closing_ = true;
    }
    changed_.notify_all();
}

void Line::use(SharedSettings settings) {
    {
        const std::lock_guard lock{mutex_};
        settings_ = std::move(settings);
    }
    changed_.notify_all();
}

SharedSettings Line::settings() const {
    const std::lock_guard lock{mutex_};
    return settings_;
}

Result<void> Line::start(spool::JobId job, StartedBy who, const std::function<Result<void>()>& write_down) {
    bool was_held = false;
    {
        const std::lock_guard lock{mutex_};
        if (held_ && who == StartedBy::itself) {
            return Failure{FailureKind::stopped,
                           "nothing starts by itself on printer " + printer_ + " until somebody starts a job"};
        }
        if (active_ || closing_) {
            return Failure{FailureKind::stopped,
                           "printer " + printer_ +
                               (active_ ? " is at " + name_of(*active_) + ": stop it first" : " is being taken away")};
        }
        was_held = std::exchange(held_, false);
        active_ = job;
        ++orders_;
        written_down_ = false;
        stop_requested_ = false;
        supply_low_ = false;
        records_.reset();
    }
    const auto written = write_down();
    {
        const std::lock_guard lock{mutex_};
        written_down_ = written.has_value();
        if (!written) {
            active_.reset();
            held_ = held_ || was_held;
        }
    }
    changed_.notify_all();
    return written;
}

void Line::request_stop() {
    {
        const std::lock_guard lock{mutex_};
        stop_requested_ = true;
        if (run_ != nullptr) {
            run_->request_stop();
        }
    }
    changed_.notify_all(); // a job that waits for a reservation waits no longer
}

void Line::hold_queue() {
    const std::lock_guard lock{mutex_};
    held_ = true;
}

void Line::hold() {
    {
        const std::lock_guard lock{mutex_};
        held_ = true;
    }
    request_stop();
}

bool Line::held() const {
    const std::lock_guard lock{mutex_};
    return held_;
}

std::optional<Ending> Line::wait_until_idle() {
    std::unique_lock lock{mutex_};
    const std::uint64_t order = orders_;
    changed_.wait(lock, [&] { return !active_ || orders_ != order; });
    return last_ending_;
}

/// With mutex_ held. When the printer is looked at again, if nothing else is done with it; absent = never.
std::optional<std::chrono::steady_clock::time_point> Line::next_look() const {
    const config::PrinterSettings* const own = settings_->printer(printer_);
    if (own == nullptr || own->watch_interval == Duration{0}) {
        return std::nullopt;
    }
    constexpr std::uint32_t doublings_at_most = 3; // whoever refuses is busy with somebody else, or switched off
    const auto pause = own->watch_interval * (1U << std::min(failed_looks_, doublings_at_most));
    return looked_at_ ? *looked_at_ + pause : std::chrono::steady_clock::now();
}

void Line::serve() {
    std::unique_lock lock{mutex_};
    while (true) {
        if (!active_ && closing_) {
            return;
        }
        const bool kept = reserved_ > 0 && !closing_ && !stop_requested_;
        if (active_ && (!written_down_ || kept)) {
            changed_.wait(lock);
            continue;
        }
        if (!active_) {
            const auto at = next_look();
            if (!at) {
                changed_.wait(lock);
            } else if (std::chrono::steady_clock::now() < *at) {
                changed_.wait_until(lock, *at);
            } else {
                lock.unlock();
                glance();
                lock.lock();
            }
            continue;
        }
        const spool::JobId job = *active_;
        lock.unlock();
        print(job);
        lock.lock();
        active_.reset();
        follower_.reset();
        finishing_.reset();
        looked_at_.reset();
        failed_looks_ = 0;
        link_.reset();
        const bool stopped = stop_requested_; // at its very end, perhaps: the next job does not follow then either
        lock.unlock();
        changed_.notify_all();
        if (!stopped) {
            services_.on_idle(printer_);
        }
        lock.lock();
    }
}

std::optional<Line::Active> Line::active() const {
    const std::vector<Active> jobs = on_line();
    return jobs.empty() ? std::nullopt : std::optional{jobs.front()};
}

void Line::event(std::string_view kind, std::optional<spool::JobId> job, std::string message,
                 std::optional<RecordNumber> record) {
    services_.events.add(
        {.kind = std::string{kind}, .printer = printer_, .job = job, .record = record, .message = std::move(message)});
}

} // namespace linefeed::service
