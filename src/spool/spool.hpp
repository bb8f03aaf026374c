// The spool: jobs, pages of encoded records and the print ledger in one SQLite database (design, section 6). WAL mode,
// synchronous=FULL, one writer connection that also checkpoints, no mmap. One object belongs to one thread. What a
// function has returned as written survives a power failure.
#pragma once

#include "base/failure.hpp"
#include "base/record_number.hpp"
#include "base/record_page.hpp"
#include "spool/job.hpp"
#include "spool/ledger.hpp"
#include "spool/printer_memory.hpp"
#include "spool/ticket.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace linefeed::spool {

/// How a spool is opened.
struct SpoolOptions {
    /// Wall clock, ns since the Unix epoch; tests bring their own.
    std::function<std::int64_t()> wall_clock_ns;
    /// SQLite VFS; empty = the default. Tests bring faulty ones.
    std::string vfs;
};

/// A job's place in the spool while it is imported. Pages come in order; commit() makes the job ready in one step;
/// without it the job vanishes (now, or when the spool is opened again after a crash), unless some of its records were
/// granted to a run meanwhile: then the import can be resumed. Must not outlive its Spool.
class Spool;
class JobImport {
public:
    JobImport(JobImport&&) noexcept;
    JobImport& operator=(JobImport&&) noexcept;
    JobImport(const JobImport&) = delete;
    JobImport& operator=(const JobImport&) = delete;
    /// Removes the job unless it is committed or stands in the ledger.
    ~JobImport();

    [[nodiscard]] JobId id() const;
    /// Precondition: page.first follows the last page (base + 1 for the first), page not empty. A record that the job
    /// has already must be the same: FailureKind::input otherwise.
    [[nodiscard]] Result<void> add(const RecordPage& page);
    /// Writes what was added, durably: these records may be printed.
    [[nodiscard]] Result<void> flush();
    /// The records that a power failure leaves in the job.
    [[nodiscard]] RecordRange durable() const;
    /// How many records were added, those that were there already included.
    [[nodiscard]] RecordCount added() const;
    /// Makes the job ready, durably. `import_report` is JSON (may be empty). Fails with FailureKind::input if no page
    /// was added, or fewer records than the job has.
    [[nodiscard]] Result<Job> commit(std::string import_report);
    /// No record follows, because the next row is bad: the job is left as ImportState::stopped, durably. Fails as
    /// commit(). Nothing is added after it.
    [[nodiscard]] Result<Job> stop(std::string import_report);
    /// Gives the job up without removing it, which takes its time: that is left to Spool::remove_job_step().
    void give_up();

private:
    friend class Spool;
    struct State;
    explicit JobImport(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

/// Flow: open(), then any of the rest. Not thread safe; several processes may not write the same spool (open() takes a
/// lock and fails with FailureKind::storage, saying who holds it).
class Spool {
public:
    /// Opens or creates the database, applies the migrations of schema/, checks its small tables (PRAGMA quick_check),
    /// removes imports that were not finished.
    [[nodiscard]] static Result<Spool> open(const std::filesystem::path& path, SpoolOptions options);
    /// Opens a spool for reading, also while another process writes it. Everything that writes fails.
    /// FailureKind::usage if there is none at `path`.
    [[nodiscard]] static Result<Spool> open_for_reading(const std::filesystem::path& path, SpoolOptions options);
    Spool(Spool&&) noexcept;
    Spool& operator=(Spool&&) noexcept;
    Spool(const Spool&) = delete;
    Spool& operator=(const Spool&) = delete;
    ~Spool();

    // Jobs
    /// `import_report` is JSON, what is known before the first record; it may be empty.
    [[nodiscard]] Result<JobImport> begin_import(const JobSpec& spec, std::string import_report = {});
    /// Goes on with an import that was broken off or stopped; `source` is what the file is like now. All pages come
    /// once more, from the first: those that the job has are compared.
    [[nodiscard]] Result<JobImport> resume_import(const Job& job, const SourceFingerprint& source);
    /// The jobs whose import was broken off or stopped when records of them had been granted to a run, oldest first.
    [[nodiscard]] Result<std::vector<Job>> unfinished_jobs();
    [[nodiscard]] Result<std::vector<Job>> jobs();
    /// At most `limit` jobs, the newest first: those that are older than `before`.
    [[nodiscard]] Result<std::vector<Job>> newest_jobs(std::optional<JobId> before, std::size_t limit);
    [[nodiscard]] Result<std::optional<Job>> job(JobId id);
    /// The ready job that was imported from exactly this source with this layout.
    [[nodiscard]] Result<std::optional<Job>> find_by_source(const JobSpec& spec);
    /// The ready jobs with this content, whatever file they came from and however it was read, oldest first.
    [[nodiscard]] Result<std::vector<Job>> find_by_content(const std::string& content_sha256);
    /// The ready jobs whose first record has this frame, oldest first.
    [[nodiscard]] Result<std::vector<Job>> find_by_first_record(std::string_view frame);
    /// The ready jobs that were imported from this path, oldest first.
    [[nodiscard]] Result<std::vector<Job>> find_by_path(const std::string& path);
    /// The ready jobs that were imported from a source of these bytes, whatever its name and however it was read,
    /// oldest first. `sha256` as in JobSpec, not empty.
    [[nodiscard]] Result<std::vector<Job>> find_by_source_bytes(const std::string& sha256);
    /// The same content was found under a new fingerprint (file touched or moved).
    [[nodiscard]] Result<void> update_source(JobId id, const SourceFingerprint& source);
    /// Removes a job that has no ledger rows, with its pages.
    [[nodiscard]] Result<void> remove_job(JobId id);
    /// The same bit by bit: false when it is gone. In between it is an import that was broken off.
    [[nodiscard]] Result<bool> remove_job_step(JobId id);

    // Tickets (schema 3)
    [[nodiscard]] Result<std::optional<Ticket>> ticket(JobId job);
    /// The tickets in the queue of a printer, in order.
    [[nodiscard]] Result<std::vector<Ticket>> queue(const std::string& printer);
    /// The first of them, `besides` left out.
    [[nodiscard]] Result<std::optional<Ticket>> first_in_queue(const std::string& printer, JobId besides = {});
    /// Whether a job of that printer other than `besides` was begun and is not over.
    [[nodiscard]] Result<bool> has_begun_job(const std::string& printer, JobId besides = {});
    /// Of jobs that were begun and are not over, or that wait and have something in the ledger all the same: printed by
    /// one who writes no tickets. Oldest first.
    [[nodiscard]] Result<std::vector<Ticket>> begun_jobs();
    /// Writes a ticket, durable at return. The job must be there.
    [[nodiscard]] Result<void> write_ticket(const Ticket& ticket);
    /// Whether an operator has stopped a printer, durable at return.
    [[nodiscard]] Result<void> hold_printer(const std::string& printer, bool held);
    [[nodiscard]] Result<bool> printer_held(const std::string& printer);

    /// The serial number of the machine that stands behind the name of a printer; empty = not known yet.
    [[nodiscard]] Result<std::string> serial_number(const std::string& printer);
    /// What an operator has accepted.
    [[nodiscard]] Result<void> write_serial_number(const std::string& printer, const std::string& serial_number);
    /// What the first machine says that answers: kept only if nothing is known yet. The one that stands then.
    [[nodiscard]] Result<std::string> learn_serial_number(const std::string& printer, const std::string& serial_number);
    /// The names of all printers behind which that machine stands.
    [[nodiscard]] Result<std::vector<std::string>> printers_of_machine(const std::string& serial_number);
    /// What is remembered of a printer; absent = it has not told anything yet.
    [[nodiscard]] Result<std::optional<PrinterMemory>> printer_memory(const std::string& printer);
    /// Durable at return.
    [[nodiscard]] Result<void> write_printer_memory(const std::string& printer, const PrinterMemory& memory);
    /// A place before all others of the printer's queue, or behind them.
    [[nodiscard]] Result<std::int64_t> first_place(const std::string& printer);
    [[nodiscard]] Result<std::int64_t> last_place(const std::string& printer);

    // What has happened, who has done what, and what was answered (schema 3)
    /// So many events are kept, and up to a thousand more.
    static constexpr std::size_t max_events = 100'000;
    /// Their ids are given here. Durable at return.
    [[nodiscard]] Result<void> add_events(std::span<const Event> events);
    /// Those behind `after`, ascending, at most `limit`.
    [[nodiscard]] Result<std::vector<Event>> events(std::uint64_t after, std::size_t limit);
    /// The id of the newest event; 0 = there is none.
    [[nodiscard]] Result<std::uint64_t> last_event();
    [[nodiscard]] Result<void> add_audit(const AuditEntry& entry);
    /// The same of the audit log.
    [[nodiscard]] Result<std::uint64_t> last_audit();
    [[nodiscard]] Result<std::vector<AuditEntry>> audit(std::uint64_t after, std::size_t limit);
    /// The answer that `caller` was given for `key`, not before that time.
    [[nodiscard]] Result<std::optional<Answer>> answer(const std::string& caller, const std::string& key,
                                                       std::int64_t not_before_ns);
    /// Older answers than `not_before_ns` are forgotten.
    [[nodiscard]] Result<void> keep_answer(const std::string& caller, const std::string& key, const Answer& answer,
                                           std::int64_t time_ns, std::int64_t not_before_ns);

    // Pages
    /// The page that holds `number`, its checksum verified.
    [[nodiscard]] Result<RecordPage> read_page(JobId id, RecordNumber number);
    /// Whether any record of the job has a `\` in it, which is there only to escape.
    [[nodiscard]] Result<bool> has_escapes(JobId id);

    // Ledger
    /// Starts a run: appends run_started (and with it reserves the RunId), durable at return.
    [[nodiscard]] Result<RunId> begin_run(JobId job, RecordRange range, const std::string& evidence);
    /// Appends rows in one transaction, durable at return. A row that contradicts the ledger (LedgerState::apply) is an
    /// internal failure and nothing is written.
    [[nodiscard]] Result<void> append(JobId job, std::span<const LedgerEntry> entries);
    /// As append(), for several jobs in one transaction. Precondition: no job comes twice.
    [[nodiscard]] Result<void> append_together(std::span<const JobRows> jobs);
    /// The state of the job's records; costs the same however long the ledger is.
    [[nodiscard]] Result<LedgerState> ledger_state(JobId job);
    /// The jobs with issued records whose fate is not known, oldest first.
    [[nodiscard]] Result<std::vector<JobId>> jobs_with_open_records();
    /// Rows of a job in order, from `after` (exclusive; 0 = from the start), at most `limit`.
    [[nodiscard]] Result<std::vector<LedgerRow>> ledger_rows(JobId job, std::int64_t after, std::size_t limit);
    /// The newest row of the job; 0 = it has none. As long as that is the same, so is what is known of its records.
    [[nodiscard]] Result<std::int64_t> last_ledger_row(JobId job);
    /// What was said of a run as it began and of the records that it has left in doubt, in order; costs the same
    /// however long the run is.
    [[nodiscard]] Result<std::vector<LedgerRow>> doubt_rows(JobId job, RunId run);
    /// The run_started row of the newest run of the job, and the newest run_ended row that follows it.
    struct LastRun {
        LedgerRow started;
        std::optional<LedgerRow> ended;
    };
    [[nodiscard]] Result<std::optional<LastRun>> last_run(JobId job);
    /// Recomputes the whole chain and the stored segments; the failure names the first row that is wrong.
    [[nodiscard]] Result<std::int64_t> verify_ledger();

    /// A failure if nothing is written any more, and why.
    [[nodiscard]] Result<void> writable() const;

    /// Copies what is in the WAL into the database. Called off the critical path; a busy reader only postpones it.
    [[nodiscard]] Result<void> checkpoint();

private:
    friend class JobImport;
    struct State;
    explicit Spool(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

} // namespace linefeed::spool
