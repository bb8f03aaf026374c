#include "daemon/running_import.hpp"

#include <algorithm>
#include <exception>
#include <utility>

namespace linefeed::daemon {

namespace {

/// What may wait between the two threads.
constexpr std::size_t waiting_bytes_max = std::size_t{2} * 1024 * 1024;
/// What is written in one step: an intent that the feeder waits for stands behind it at most.
constexpr std::size_t step_bytes = std::size_t{1024} * 1024;
/// A record of a slow source waits so long for others to fill its page.
constexpr auto page_patience = std::chrono::milliseconds{20};
/// How many pages lie between two looks at the file.
constexpr int pages_between_looks = 32;

std::size_t bytes_of(const RecordPage& page) {
    return page.frames.size() + page.ends.size() * sizeof(std::uint32_t);
}

RecordNumber bound_of(RecordNumber base, std::uint64_t most_rows) {
    const std::uint64_t room = RecordNumber::max().value() - base.value();
    return base + RecordCount{std::min(most_rows, room)};
}

} // namespace

struct RunningImport::Pages {
    std::deque<RecordPage> pages;
    bool last = false; ///< nothing waits behind them
    std::optional<intake::ImportReport> refusal;
    std::optional<Result<intake::ImportReport>> end;
};

RunningImport::RunningImport(spool::JobImport job, std::unique_ptr<intake::RowSource> source,
                             const spool::JobSpec& spec, intake::ImportOptions options)
    : job_(std::move(job))
    , source_(std::move(source))
    , spec_(spec)
    , options_(std::move(options))
    , bound_(bound_of(spec.base, source_->most_rows())) {
    options_.on_progress = [this](const intake::ImportReport& report, double fraction) {
        rows_.store(report.rows, std::memory_order_relaxed);
        fraction_.store(fraction, std::memory_order_relaxed);
        return !cancelled_.load(std::memory_order_relaxed);
    };
    options_.close_page = [this] {
        return idle_.load(std::memory_order_relaxed) && Clock::now() - handed_over_at_ >= page_patience;
    };
}

RunningImport::~RunningImport() {
    cancel();
    if (thread_.joinable()) {
        thread_.join();
    }
}

void RunningImport::start() {
    thread_ = std::thread{[this] { read(); }};
}

void RunningImport::cancel() {
    {
        const std::lock_guard lock{mutex_};
        cancelled_ = true;
    }
    room_.notify_one();
}

void RunningImport::read() {
    std::optional<Failure> failed;
    try {
        if (auto done = read_all(); !done) {
            failed = done.error();
        }
    } catch (const std::exception& exception) {
        failed = Failure{FailureKind::internal, exception.what()};
    }
    if (failed) {
        const std::lock_guard lock{mutex_};
        end_ = *failed;
    }
    notify();
}

void RunningImport::notify() {
    own_signal_.notify();
    const std::lock_guard lock{mutex_};
    if (waiting_ != nullptr) {
        waiting_->notify();
    }
}

void RunningImport::wake(store::EventSignal* waiting) {
    const std::lock_guard lock{mutex_};
    waiting_ = waiting;
}

Result<void> RunningImport::read_all() {
    intake::PageMaker pages{*source_, spec_.base, options_};
    handed_over_at_ = Clock::now();
    for (int made = 1;; ++made) {
        RecordPage page;
        const auto more = pages.next(page);
        if (!more) {
            return more.error();
        }
        if (made % pages_between_looks == 0 || !*more) {
            if (auto unchanged = intake::check_unchanged(spec_.source); !unchanged) {
                return unchanged;
            }
        }
        if (!*more) {
            const std::lock_guard lock{mutex_};
            end_ = pages.report();
            return {};
        }
        if (!hand_over(pages, std::move(page))) {
            return Failure{FailureKind::stopped, "the import was cancelled"};
        }
    }
}

bool RunningImport::hand_over(intake::PageMaker& pages, RecordPage page) {
    {
        std::unique_lock lock{mutex_};
        room_.wait(lock, [this] { return bytes_ < waiting_bytes_max || cancelled_; });
        if (cancelled_) {
            return false;
        }
        if (pages.refused()) {
            refusal_ = pages.report();
        }
        if (!page.ends.empty()) {
            bytes_ += bytes_of(page);
            pages_.push_back(std::move(page));
        }
    }
    rows_.store(pages.report().rows, std::memory_order_relaxed);
    idle_ = false;
    handed_over_at_ = Clock::now();
    notify();
    return true;
}

bool RunningImport::wants_step() {
    if (over()) {
        return false;
    }
    const std::lock_guard lock{mutex_};
    const bool news = !pages_.empty() || (refusal_ && !end_known()) || end_;
    idle_ = !news;
    return news;
}

RunningImport::Pages RunningImport::take_pages() {
    Pages taken;
    {
        const std::lock_guard lock{mutex_};
        for (std::size_t bytes = 0; bytes < step_bytes && !pages_.empty();) {
            bytes += bytes_of(pages_.front());
            bytes_ -= bytes_of(pages_.front());
            taken.pages.push_back(std::move(pages_.front()));
            pages_.pop_front();
        }
        taken.last = pages_.empty();
        if (taken.last) {
            taken.refusal = refusal_;
            taken.end = end_;
        }
    }
    room_.notify_one();
    return taken;
}

void RunningImport::step() {
    if (const auto written = write(take_pages()); !written) {
        failure_ = written.error();
        cancel();
    }
}

Result<void> RunningImport::write(const Pages& taken) {
    for (const RecordPage& page : taken.pages) {
        if (auto added = job_.add(page); !added) {
            return added;
        }
    }
    const bool complete = taken.end && *taken.end && !taken.refusal;
    if (!complete && !finished_job_) { // commit() writes as well
        if (auto flushed = job_.flush(); !flushed) {
            return flushed;
        }
    }
    if (taken.end && !*taken.end) {
        return taken.end->error();
    }
    if ((taken.refusal || complete) && !finished_job_) {
        auto job = complete ? job_.commit(intake::to_json(**taken.end)) : job_.stop(intake::to_json(*taken.refusal));
        if (!job) {
            return job.error();
        }
        finished_job_ = std::move(*job);
    }
    if (taken.end) {
        report_ = **taken.end;
    }
    return {};
}

} // namespace linefeed::daemon
