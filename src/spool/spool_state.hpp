// What a Spool consists of, shared by the files that implement it: jobs, pages, ledger, verification.
#pragma once

#include "spool/database.hpp"
#include "spool/file_lock.hpp"
#include "spool/spool.hpp"

#include <unordered_map>

namespace linefeed::spool {

/// Of one job, what append() needs at hand. Always what is durable, never ahead of it.
struct JobLedger {
    RecordRange records;   ///< of the job, so far
    bool complete = false; ///< more records may come otherwise
    LedgerState state;
    RunId known_run{}; ///< a run that is known to belong to the job
};

/// Binds the five values of a source, in the order of the columns source_path … source_companion, from the parameter
/// `first` on.
Statement& bind_source(Statement& statement, int first, const SourceFingerprint& source);

struct Spool::State {
    /// How many jobs' ledger states are kept in memory; beyond that all are dropped and read again when needed.
    static constexpr std::size_t max_cached_ledgers = 64;

    FileLock lock; ///< first, so that it is given up last
    std::unique_ptr<Database> database;
    std::function<std::int64_t()> wall_clock_ns;
    std::optional<Failure> broken;  ///< why nothing may be written any more
    std::int64_t last_sequence = 0; ///< of the ledger
    std::string last_hash;
    std::unordered_map<std::int64_t, JobLedger> ledgers;

    /// Another process or connection may write it meanwhile.
    [[nodiscard]] bool reads_only() const { return broken && broken->kind == FailureKind::usage; }
    /// A failure if the spool does not take writes any more.
    [[nodiscard]] Result<void> check_writable() const;
    /// Nothing more is written after this: what the disk has kept is only known after reopening. Returns `failure`.
    Failure fatal(Failure failure);
    /// As fatal() if the disk failed or the file is damaged; otherwise (disk full, locked) SQLite has undone the
    /// transaction and the spool can go on. Returns `failure`.
    Failure failed_write(Failure failure);

    [[nodiscard]] Result<RecordPage> read_page(JobId id, RecordNumber number);
    [[nodiscard]] Result<void> write_source(JobId id, const SourceFingerprint& source);
    /// Writes down the first record of a job, for find_by_first_record().
    [[nodiscard]] Result<void> write_head(JobId id, const RecordPage& page);
    /// The same of all jobs of which it was not done when they were imported.
    [[nodiscard]] Result<void> write_missing_heads();
    /// Whether any record of the job was ever granted to a run.
    [[nodiscard]] Result<bool> stands_in_ledger(JobId id);
    /// Removes imports that were broken off before anything of them was printed.
    [[nodiscard]] Result<void> remove_unfinished_imports();
    /// Removes a job and its pages in steps of bounded size. A crash in between leaves an unfinished import, removed
    /// later.
    [[nodiscard]] Result<void> remove_job_in_steps(JobId id);
    [[nodiscard]] Result<bool> remove_step(JobId id);

    [[nodiscard]] Result<void> load_end_of_chain();
    /// verify_ledger() within a transaction.
    [[nodiscard]] Result<std::int64_t> verify();
    /// The ledger state of a job, from memory or the database. Valid until the next call.
    [[nodiscard]] Result<JobLedger*> job_ledger(JobId id);
    /// Whether `run` is a run of the job; remembers it.
    [[nodiscard]] Result<bool> is_run_of(JobLedger& ledger, JobId job, RunId run);
    /// Rows of one job, checked, and the states before and after them.
    struct CheckedRows {
        JobId job{};
        std::span<const LedgerEntry> entries;
        LedgerState before;
        LedgerState after;
    };
    /// Checks and appends rows in one transaction. Only a run_started row may name the run of its own sequence.
    [[nodiscard]] Result<void> append_rows(JobId job, std::span<const LedgerEntry> entries);
    [[nodiscard]] Result<CheckedRows> check_rows(JobId job, std::span<const LedgerEntry> entries);
    /// In one transaction; only then are the states after them believed.
    [[nodiscard]] Result<void> append_checked(std::span<const CheckedRows> jobs);
    [[nodiscard]] Result<void> write_rows(std::span<const CheckedRows> jobs);
    [[nodiscard]] Result<void> write_segments(JobId job, const LedgerState& before, const LedgerState& after);
    [[nodiscard]] Result<LedgerState> read_segments(JobId job);
};

/// The row of a statement that selects `ledger_columns`; a failure if it cannot be a row of a ledger.
[[nodiscard]] Result<LedgerRow> ledger_row_from(const Statement& statement, const std::string& path);

/// SELECT … FROM ledger, with the previous hash from the row before; the alias of the row is `l`.
inline constexpr std::string_view select_ledger =
    "SELECT l.sequence, l.job, l.kind, l.run, l.first, l.records, l.evidence, l.time_ns, l.hash, p.hash "
    "FROM ledger l LEFT JOIN ledger p ON p.sequence = l.sequence - 1 ";

/// A range as stored, or std::nullopt if the numbers are not one.
[[nodiscard]] std::optional<RecordRange> stored_range(std::int64_t first, std::int64_t records);

} // namespace linefeed::spool
