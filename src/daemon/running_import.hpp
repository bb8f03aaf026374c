// An import that goes on while its records are printed: a thread reads, checks and encodes; whoever owns the spool
// writes what it has made, step by step. At a bad row (unless those are left out) the records before it are all there
// is to print; the thread goes on only to find the other bad rows.
#pragma once

#include "intake/import.hpp"
#include "intake/page_maker.hpp"
#include "spool/spool.hpp"
#include "store/supply.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>

namespace linefeed::daemon {

/// Flow: construct, start(); then step() whenever wants_step(), until over(). The spool must outlive it.
class RunningImport final : public store::Supply {
public:
    /// `options.on_progress` and `options.close_page` are its own business. Precondition: intake::check_charsets().
    RunningImport(spool::JobImport job, std::unique_ptr<intake::RowSource> source, const spool::JobSpec& spec,
                  intake::ImportOptions options);
    /// Breaks it off. What is durable stays in the spool if it stands in the ledger.
    ~RunningImport() override;

    void start();
    void cancel();
    /// Waits until something is to be written or the time has passed.
    void wait(int timeout_ms) { own_signal_.wait(timeout_ms); }

    [[nodiscard]] bool wants_step() override;
    void step() override;
    [[nodiscard]] RecordRange durable() const override { return job_.durable(); }
    [[nodiscard]] bool end_known() const override { return finished_job_.has_value(); }
    [[nodiscard]] const std::optional<Failure>& failure() const override { return failure_; }
    void wake(store::EventSignal* waiting) override;

    [[nodiscard]] spool::JobId job() const { return job_.id(); }
    /// No record can be behind this one.
    [[nodiscard]] RecordNumber bound() const { return bound_; }
    /// A bad row has ended it.
    [[nodiscard]] bool refused() const { return finished_job_ && finished_job_->state == spool::ImportState::stopped; }
    /// Nothing more is read: all is in the spool, or it has failed, or after a bad row all rows are checked.
    [[nodiscard]] bool over() const { return failure_.has_value() || (end_known() && report_.has_value()); }
    /// Once it is over, and has not failed.
    [[nodiscard]] const intake::ImportReport& report() const { return *report_; }
    /// How many records an import that is resumed has to compare before it adds new ones.
    [[nodiscard]] bool compares() const { return job_.added() < job_.durable().count(); }

    // Any thread
    [[nodiscard]] std::uint64_t rows() const { return rows_.load(std::memory_order_relaxed); }
    [[nodiscard]] double fraction() const { return fraction_.load(std::memory_order_relaxed); }

private:
    using Clock = std::chrono::steady_clock;

    // The thread that reads
    void read();
    void notify();
    [[nodiscard]] Result<void> read_all();
    /// False if it was cancelled.
    [[nodiscard]] bool hand_over(intake::PageMaker& pages, RecordPage page);

    struct Pages;
    [[nodiscard]] Pages take_pages();
    [[nodiscard]] Result<void> write(const Pages& taken);

    spool::JobImport job_;
    std::unique_ptr<intake::RowSource> source_;
    spool::JobSpec spec_;
    intake::ImportOptions options_;
    RecordNumber bound_;
    store::EventSignal own_signal_; ///< for wait()
    std::thread thread_;

    std::optional<Failure> failure_;
    std::optional<spool::Job> finished_job_;
    std::optional<intake::ImportReport> report_;

    std::mutex mutex_;                      ///< for what follows
    store::EventSignal* waiting_ = nullptr; ///< besides own_signal_
    std::condition_variable room_;
    std::deque<RecordPage> pages_;
    std::size_t bytes_ = 0;
    std::optional<intake::ImportReport> refusal_; ///< a bad row has been read: no page follows
    std::optional<Result<intake::ImportReport>> end_;

    std::atomic<bool> cancelled_{false};
    std::atomic<bool> idle_{false}; ///< nothing waits to be written: a slow source need not fill its page
    Clock::time_point handed_over_at_;
    std::atomic<std::uint64_t> rows_{0};
    std::atomic<double> fraction_{0};
};

} // namespace linefeed::daemon
