// A whole service in memory: two printers, jobs, events, an audit log. What it is told it does, so that a test sees
// what the interface has asked for; and it can be made to fail or to take its time.
#pragma once

#include "daemon/operations.hpp"

#include <atomic>
#include <map>
#include <mutex>

namespace linefeed::api {

class FakeOperations : public daemon::Operations {
private:
    template <typename Function>
    auto with_lock(Function&& function) {
        const std::lock_guard lock{mutex_};
        return function();
    }

public:
    FakeOperations();

    // What tests set and look at.
    void fail(std::optional<Failure> failure) {
        with_lock([&] { failure_ = std::move(failure); });
    }
    void fail_remembering(std::optional<Failure> failure) {
        with_lock([&] { remember_failure_ = std::move(failure); });
    }
    /// Every change waits until it is let go on.
    void hold(bool held) { held_ = held; }
    void add_event(std::string kind, std::string message);
    /// The first so many are not kept any more.
    void prune_events(std::size_t count) { pruned_ = count; }
    [[nodiscard]] std::size_t changes() { return audit_size(); }
    [[nodiscard]] std::string last_change();
    [[nodiscard]] std::optional<daemon::ImportRequest> last_import();
    [[nodiscard]] std::uint64_t last_import_bytes();
    std::function<Result<std::vector<std::string>>()> on_reload;

    daemon::ServiceStatus status() override;
    daemon::ServiceMetrics metrics() override;
    std::vector<daemon::PrinterView> printers() override;
    std::optional<daemon::PrinterView> printer(std::string_view name) override;
    Result<std::vector<daemon::Finding>> preflight(std::string_view printer) override;
    Result<std::vector<daemon::FrameView>> frames(std::string_view printer, bool error) override;
    Result<std::vector<daemon::JobView>> jobs(const daemon::JobFilter& filter) override;
    Result<std::optional<daemon::JobView>> job(spool::JobId id) override;
    Result<daemon::DoubtView> doubt(spool::JobId id) override;
    Result<std::vector<spool::HistoryStretch>> history(spool::JobId id, RecordRange records) override;
    Result<std::vector<spool::LedgerRow>> ledger(spool::JobId id, std::int64_t after, std::size_t limit) override;
    Result<std::vector<daemon::DoubtView::Record>> records(spool::JobId id, RecordRange records) override;
    Result<std::int64_t> verify_ledger() override;
    std::vector<daemon::FolderView> folders() override;
    Result<std::vector<daemon::EventView>> events(std::uint64_t after, std::size_t limit) override;
    Result<std::uint64_t> last_event() override;
    std::uint64_t subscribe(std::function<void()> on_events) override;
    void unsubscribe(std::uint64_t subscription) override;
    Result<std::vector<daemon::AuditView>> audit(std::uint64_t after, std::size_t limit) override;
    Result<std::uint64_t> last_audit() override;
    Result<daemon::ImportAnswer> import(const daemon::Caller& caller, const daemon::ImportRequest& request) override;
    Result<void> enqueue(const daemon::Caller& caller, spool::JobId id, std::string_view printer) override;
    Result<void> start(const daemon::Caller& caller, spool::JobId id) override;
    Result<spool::JobId> start_next(const daemon::Caller& caller, std::string_view printer) override;
    Result<void> stop(const daemon::Caller& caller, std::string_view printer) override;
    Result<void> cancel(const daemon::Caller& caller, spool::JobId id) override;
    Result<void> reprint(const daemon::Caller& caller, spool::JobId id, const daemon::ReprintRequest& request) override;
    Result<void> settle(const daemon::Caller& caller, spool::JobId id, const daemon::SettleRequest& request) override;
    Result<void> acknowledge(const daemon::Caller& caller, std::string_view printer, std::uint32_t error) override;
    Result<void> accept_printer(const daemon::Caller& caller, std::string_view printer,
                                const std::string& serial_number) override;
    Result<void> suspend_panel(const daemon::Caller& caller, std::string_view printer, bool suspend,
                               Duration hold) override;
    Result<std::string> read_file(std::string_view printer, std::string_view path) override;
    Result<void> write_file(const daemon::Caller& caller, std::string_view printer,
                            const daemon::PrinterFile& file) override;
    Result<std::string> inspect(std::string_view printer, std::string_view what, std::string_view arguments) override;
    Result<std::string> command(const daemon::Caller& caller, std::string_view printer, std::string_view what,
                                std::string_view arguments) override;
    Result<std::vector<std::string>> reload(const daemon::Caller& caller) override;
    Result<std::optional<Remembered>> remembered(const daemon::Caller& caller, std::string_view key) override;
    Result<void> remember(const daemon::Caller& caller, std::string_view key, const Remembered& answer) override;

private:
    [[nodiscard]] std::size_t audit_size() {
        return with_lock([&] { return audit_.size(); });
    }
    /// Writes the line of the audit log; the failure that was set.
    Result<void> change(const daemon::Caller& caller, std::string what, std::string object);
    [[nodiscard]] Result<void> check_job(spool::JobId id);
    [[nodiscard]] Result<void> check_printer(std::string_view name);

    std::mutex mutex_;
    std::atomic<bool> held_ = false;
    std::optional<Failure> failure_;
    std::optional<Failure> remember_failure_;
    std::vector<daemon::PrinterView> printers_;
    std::map<spool::JobId, daemon::JobView> jobs_;
    std::vector<daemon::EventView> events_;
    std::atomic<std::size_t> pruned_{0};
    std::vector<daemon::AuditView> audit_;
    std::map<std::uint64_t, std::function<void()>> subscribers_;
    std::uint64_t next_subscription_ = 1;
    std::map<std::pair<std::string, std::string>, Remembered> remembered_;
    std::map<std::string, spool::JobId> contents_;
    std::optional<daemon::ImportRequest> last_import_;
    std::uint64_t last_import_bytes_ = 0;
};

} // namespace linefeed::api
