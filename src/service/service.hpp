// The service behind linefeedd: printers with their queues, drop folders, and everything that people and programs can
// ask of it. Nothing prints that was not started: by an operator, or by the autostart of a queue that is allowed to.
#pragma once

#include "base/flood_bound.hpp"
#include "config/problem.hpp"
#include "config/settings.hpp"
#include "daemon/feed_thread.hpp"
#include "daemon/job_facts.hpp"
#include "daemon/operations.hpp"
#include "daemon/operator_word.hpp"
#include "daemon/service_manager.hpp"
#include "service/event_log.hpp"
#include "service/folder.hpp"
#include "service/line.hpp"
#include "service/spool_access.hpp"
#include "spool/json_text.hpp"
#include "store/store_thread.hpp"

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace linefeed::service {

struct ServiceOptions {
    config::Settings settings;
    /// Reads the configuration anew, for a reload.
    std::function<config::Checked<config::Settings>()> load;
    /// Hears of each event at once, on the thread where it happens.
    EventLog::Listener listen = [](const spool::Event&) {};
    std::string version;
    /// Takes new settings over for what stands around the service, at each reload before the service does; a failure
    /// refuses all of them. One call at a time, on the thread of whoever reloads; must not call the service.
    std::function<Result<void>(const config::Settings&)> take_over = [](const config::Settings&) {
        return Result<void>{};
    };
};

/// Flow: open(), start(), any of the operations from open() on, shut_down(). All callers must be gone before it is
/// destroyed.
class Service final : public daemon::Operations {
public:
    /// Opens the spool and finds out where each job stands. FailureKind::storage if the spool cannot be used.
    [[nodiscard]] static Result<std::unique_ptr<Service>> open(ServiceOptions options);
    /// From now on things may happen by themselves: folders are looked after, and queues start what they may.
    void start();
    ~Service() override;
    Service(const Service&) = delete;
    Service& operator=(const Service&) = delete;

    /// Starts nothing any more, breaks off imports, stops all lines and waits until the truth is in the ledger.
    void shut_down();
    /// To be called every ten seconds or so.
    void tick();
    /// The threads that must not stand still.
    [[nodiscard]] std::vector<daemon::Heart> hearts() const;
    /// What is in force, also after a reload.
    [[nodiscard]] SharedSettings settings() const;

    // service_views.cpp: what there is to see
    [[nodiscard]] daemon::ServiceStatus status() override;
    [[nodiscard]] daemon::ServiceMetrics metrics() override;
    [[nodiscard]] std::vector<daemon::PrinterView> printers() override;
    [[nodiscard]] std::optional<daemon::PrinterView> printer(std::string_view name) override;
    [[nodiscard]] std::vector<daemon::FolderView> folders() override;
    [[nodiscard]] Result<std::vector<daemon::EventView>> events(std::uint64_t after, std::size_t limit) override;
    [[nodiscard]] Result<std::uint64_t> last_event() override;
    [[nodiscard]] std::uint64_t subscribe(std::function<void()> on_events) override;
    void unsubscribe(std::uint64_t subscription) override;
    [[nodiscard]] Result<std::vector<daemon::AuditView>> audit(std::uint64_t after, std::size_t limit) override;
    [[nodiscard]] Result<std::uint64_t> last_audit() override;
    [[nodiscard]] Result<std::optional<Remembered>> remembered(const daemon::Caller& caller,
                                                               std::string_view key) override;
    [[nodiscard]] Result<void> remember(const daemon::Caller& caller, std::string_view key,
                                        const Remembered& answer) override;

    // service_jobs.cpp: jobs and what stands in the ledger
    [[nodiscard]] Result<std::vector<daemon::JobView>> jobs(const daemon::JobFilter& filter) override;
    [[nodiscard]] Result<std::optional<daemon::JobView>> job(spool::JobId id) override;
    [[nodiscard]] Result<daemon::DoubtView> doubt(spool::JobId id) override;
    [[nodiscard]] Result<std::vector<daemon::DoubtView::Record>> records(spool::JobId id, RecordRange records) override;
    [[nodiscard]] Result<std::vector<spool::HistoryStretch>> history(spool::JobId id, RecordRange records) override;
    [[nodiscard]] Result<std::vector<spool::LedgerRow>> ledger(spool::JobId id, std::int64_t after,
                                                               std::size_t limit) override;
    [[nodiscard]] Result<std::int64_t> verify_ledger() override;

    // service_queue.cpp: what moves jobs
    [[nodiscard]] Result<void> enqueue(const daemon::Caller& caller, spool::JobId id,
                                       std::string_view printer) override;
    [[nodiscard]] Result<void> start(const daemon::Caller& caller, spool::JobId id) override;
    [[nodiscard]] Result<spool::JobId> start_next(const daemon::Caller& caller, std::string_view printer) override;
    [[nodiscard]] Result<void> stop(const daemon::Caller& caller, std::string_view printer) override;
    [[nodiscard]] Result<void> cancel(const daemon::Caller& caller, spool::JobId id) override;

    // service_word.cpp: what an operator says about records
    [[nodiscard]] Result<void> reprint(const daemon::Caller& caller, spool::JobId id,
                                       const daemon::ReprintRequest& request) override;
    [[nodiscard]] Result<void> settle(const daemon::Caller& caller, spool::JobId id,
                                      const daemon::SettleRequest& request) override;

    // service_import.cpp
    [[nodiscard]] Result<daemon::ImportAnswer> import(const daemon::Caller& caller,
                                                      const daemon::ImportRequest& request) override;

    // service_printers.cpp: printers besides printing
    [[nodiscard]] Result<std::vector<daemon::Finding>> preflight(std::string_view printer) override;
    [[nodiscard]] Result<std::vector<daemon::FrameView>> frames(std::string_view printer, bool error) override;
    [[nodiscard]] Result<void> acknowledge(const daemon::Caller& caller, std::string_view printer,
                                           std::uint32_t error) override;
    [[nodiscard]] Result<void> accept_printer(const daemon::Caller& caller, std::string_view printer,
                                              const std::string& serial_number) override;
    [[nodiscard]] Result<void> suspend_panel(const daemon::Caller& caller, std::string_view printer, bool suspend,
                                             Duration hold) override;
    [[nodiscard]] Result<std::string> read_file(std::string_view printer, std::string_view path) override;
    [[nodiscard]] Result<void> write_file(const daemon::Caller& caller, std::string_view printer,
                                          const daemon::PrinterFile& file) override;
    [[nodiscard]] Result<std::string> inspect(std::string_view printer, std::string_view what,
                                              std::string_view arguments) override;
    [[nodiscard]] Result<std::string> command(const daemon::Caller& caller, std::string_view printer,
                                              std::string_view what, std::string_view arguments) override;

    // service_reload.cpp
    [[nodiscard]] Result<std::vector<std::string>> reload(const daemon::Caller& caller) override;

private:
    using LinePtr = std::shared_ptr<Line>;
    using FolderPtr = std::shared_ptr<Folder>;

    Service(ServiceOptions options, spool::Spool spool);
    [[nodiscard]] Result<void> recover();
    [[nodiscard]] Result<Line::Past> past_of(const config::PrinterSettings& printer);
    void open_lines();
    void open_folders();

    // Helpers of all
    /// nullptr = there is none.
    [[nodiscard]] LinePtr line(std::string_view printer) const;
    [[nodiscard]] std::vector<LinePtr> lines() const;
    /// FailureKind::usage, naming those that there are.
    [[nodiscard]] Result<LinePtr> known_line(std::string_view printer) const;
    [[nodiscard]] std::optional<daemon::JobPhase> live_phase(spool::JobId id) const;
    void event(std::string_view kind, const std::string& printer, std::optional<spool::JobId> job, std::string message);

    /// What is asked for, for the audit log. `detail` = as JSON.
    struct Act {
        std::string_view what;
        std::string object;
        spool::JsonObject detail{};
    };
    /// Carries it out and writes down that it was asked for.
    template <typename Carry>
    auto audited(const daemon::Caller& caller, const Act& act, Carry&& carry) -> decltype(carry()) {
        auto result = carry();
        write_audit(caller, act, result ? std::optional<Failure>{} : result.error());
        return result;
    }
    void write_audit(const daemon::Caller& caller, const Act& act, const std::optional<Failure>& refused);
    /// Whether this refusal is written down, and how many of that caller were not before it.
    [[nodiscard]] std::optional<std::uint64_t> take_refusal(const std::string& who);

    /// Rows that an operator's word comes to, and the newest row of the job as he spoke.
    struct Said {
        std::vector<spool::LedgerEntry> rows;
        std::int64_t as_of = 0;
    };
    [[nodiscard]] Result<Said> said_by(const spool::Job& job, const daemon::OperatorWord& word,
                                       const daemon::Caller& caller);

    /// Whether the fate of records in this printer is open. FailureKind::stopped, naming the job.
    [[nodiscard]] Result<void> check_fifo_known(const std::string& printer);

    // With orders_ held
    [[nodiscard]] Result<void> begin(spool::JobId id, StartedBy who);
    [[nodiscard]] Result<void> check_open_records(const JobFacts& facts, const std::string& printer);
    [[nodiscard]] Result<void> check_startable(const JobFacts& facts);
    [[nodiscard]] Result<void> put_into_queue(spool::JobId id, const std::string& printer);
    [[nodiscard]] Result<void> check_fits(const JobFacts& facts, const std::string& printer);
    [[nodiscard]] Result<JobFacts> facts_of_idle(spool::JobId id);

    /// Starts the next job of the printer's queue if that may start by itself.
    void look_for_work(const std::string& printer);
    /// From now on nothing of its queue starts by itself until a person starts something. `words` = why.
    void leave_to_a_person(const std::string& printer, const std::string& words);
    [[nodiscard]] Result<std::optional<spool::JobId>> next_by_itself(const std::string& printer);
    void hold_back(spool::JobId id, const Failure& why);

    // service_chain.cpp: what follows without a stop
    /// See LineServices::claim_follower.
    [[nodiscard]] std::optional<JobFacts> claim_follower(const std::string& printer, const FollowerWanted& wanted);
    [[nodiscard]] Result<std::optional<JobFacts>> next_to_follow(const std::string& printer,
                                                                 const FollowerWanted& wanted);

    std::function<config::Checked<config::Settings>()> load_;
    std::function<Result<void>(const config::Settings&)> take_over_;
    std::string version_;
    std::int64_t started_ns_ = 0;
    std::int64_t files_since_ns_ = 0; ///< the start once more, by the clock of files
    std::string real_time_;

    spool::Spool spool_; ///< the store thread's from here on
    daemon::FeedThread feed_;
    store::StoreThread store_;
    SpoolAccess access_;
    EventLog events_;
    IntakeCounts counts_;
    std::mutex refusals_mutex_;                  ///< for what follows
    std::map<std::string, FloodBound> refusals_; ///< by caller

    std::mutex reloads_; ///< one at a time, as a whole: taken before orders_
    /// One operation at a time decides about jobs and queues; none waits for a printer meanwhile.
    std::mutex orders_;
    bool closing_ = false;            ///< by orders_
    std::atomic<bool> ending_{false}; ///< the same, for imports

    mutable std::mutex parts_mutex_; ///< for what follows
    SharedSettings settings_;
    std::map<std::string, LinePtr, std::less<>> lines_;
    std::vector<FolderPtr> folders_;
};

} // namespace linefeed::service
