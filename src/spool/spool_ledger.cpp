// The ledger as stored: rows are checked against the state they follow, appended with the state they lead to in one
// transaction, and only then believed.
#include "spool/checksum.hpp"
#include "spool/ledger_codec.hpp"
#include "spool/spool_state.hpp"

#include <algorithm>
#include <sstream>

namespace linefeed::spool {

namespace {

std::string bytes_of(std::string_view hex) {
    std::string bytes;
    bytes.reserve(hex.size() / 2);
    const auto digit = [](char character) { return character <= '9' ? character - '0' : character - 'a' + 10; };
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
        bytes += static_cast<char>(digit(hex[i]) * 16 + digit(hex[i + 1]));
    }
    return bytes;
}

Failure contradiction(JobId job, const LedgerEntry& entry, std::string_view why) {
    std::ostringstream text;
    text << "the print ledger refuses \"" << to_string(entry.kind) << ' ' << entry.range << "\" of job "
         << static_cast<std::int64_t>(job) << ", run " << static_cast<std::int64_t>(entry.run) << ": " << why;
    return {FailureKind::internal, text.str()};
}

/// Whether the records of a row are records of the job. A run that begins while the job is imported may mean to print
/// records that are still to come; nothing else may be said of them.
bool lies_within(const LedgerEntry& entry, const JobLedger& ledger) {
    const bool open_end = entry.kind == LedgerKind::run_started && !ledger.complete;
    return entry.range.empty() ||
           (ledger.records.contains(entry.range.first()) && (open_end || ledger.records.contains(entry.range.last())));
}

} // namespace

Result<LedgerRow> ledger_row_from(const Statement& statement, const std::string& path) {
    LedgerRow row;
    row.sequence = statement.number(0);
    row.job = JobId{statement.number(1)};
    const auto kind = ledger_kind_from_name(statement.text(2));
    const auto range = stored_range(statement.number(4), statement.number(5));
    if (!kind || !range) {
        return Failure{FailureKind::storage,
                       path + ": ledger row " + std::to_string(row.sequence) + " is damaged: it cannot be read"};
    }
    row.entry = {*kind, RunId{statement.number(3)}, *range, std::string{statement.text(6)}};
    row.time_ns = statement.number(7);
    row.hash = to_hex(statement.blob(8));
    row.previous_hash = row.sequence == 1 ? std::string{first_previous_hash} : to_hex(statement.blob(9));
    return row;
}

Result<void> Spool::State::load_end_of_chain() {
    auto statement = database->prepare("SELECT sequence, hash FROM ledger ORDER BY sequence DESC LIMIT 1");
    if (!statement) {
        return statement.error();
    }
    const auto found = statement->step();
    if (!found) {
        return found.error();
    }
    last_sequence = *found ? statement->number(0) : 0;
    last_hash = *found ? to_hex(statement->blob(1)) : std::string{first_previous_hash};
    return {};
}

Result<LedgerState> Spool::State::read_segments(JobId job) {
    auto statement =
        database->prepare("SELECT first, records, state, run FROM ledger_segments WHERE job = ?1 ORDER BY first");
    if (!statement) {
        return statement.error();
    }
    statement->bind(1, static_cast<std::int64_t>(job));
    std::vector<LedgerSegment> segments;
    while (true) {
        const auto more = statement->step();
        if (!more) {
            return more.error();
        }
        if (!*more) {
            return LedgerState{std::move(segments)};
        }
        const auto range = stored_range(statement->number(0), statement->number(1));
        const auto state = record_state_from_name(statement->text(2));
        const bool ascending =
            range && !range->empty() && (segments.empty() || segments.back().range.last() < range->first());
        if (!ascending || !state) {
            return Failure{FailureKind::storage, database->path() + ": the spool is damaged: the ledger state of job " +
                                                     std::to_string(static_cast<std::int64_t>(job)) +
                                                     " cannot be read"};
        }
        segments.push_back({*range, *state, RunId{statement->number(3)}});
    }
}

Result<JobLedger*> Spool::State::job_ledger(JobId id) {
    const auto key = static_cast<std::int64_t>(id);
    if (reads_only()) {
        ledgers.clear();
    }
    if (const auto cached = ledgers.find(key); cached != ledgers.end()) {
        return &cached->second;
    }
    auto statement = database->prepare(
        "SELECT base + 1, records, state = 'ready' FROM jobs WHERE id = ?1 AND (state = 'ready' OR records > 0)");
    if (!statement) {
        return statement.error();
    }
    const auto found = statement->bind(1, key).step();
    if (!found) {
        return found.error();
    }
    const auto records = *found ? stored_range(statement->number(0), statement->number(1)) : std::nullopt;
    if (!records) {
        return Failure{FailureKind::internal, "there is no job " + std::to_string(key) + " ready to print"};
    }
    const bool complete = statement->number(2) != 0;
    auto state = read_segments(id);
    if (!state) {
        return state.error();
    }
    if (ledgers.size() >= max_cached_ledgers) {
        ledgers.clear();
    }
    return &ledgers.insert_or_assign(key, JobLedger{*records, complete, std::move(*state), RunId{}}).first->second;
}

Result<bool> Spool::State::is_run_of(JobLedger& ledger, JobId job, RunId run) {
    if (ledger.known_run == run && run != RunId{}) {
        return true;
    }
    auto statement =
        database->prepare("SELECT 1 FROM ledger WHERE sequence = ?1 AND job = ?2 AND kind = 'run_started'");
    if (!statement) {
        return statement.error();
    }
    auto found = statement->bind(1, static_cast<std::int64_t>(run)).bind(2, static_cast<std::int64_t>(job)).step();
    if (found && *found) {
        ledger.known_run = run;
    }
    return found;
}

Result<void> Spool::State::append_rows(JobId job, std::span<const LedgerEntry> entries) {
    if (auto writable = check_writable(); !writable) {
        return writable;
    }
    const auto checked = check_rows(job, entries);
    if (!checked) {
        return checked.error();
    }
    return append_checked({&*checked, 1});
}

Result<Spool::State::CheckedRows> Spool::State::check_rows(JobId job, std::span<const LedgerEntry> entries) {
    const auto ledger = job_ledger(job);
    if (!ledger) {
        return ledger.error();
    }
    LedgerState after = (*ledger)->state;
    for (const LedgerEntry& entry : entries) {
        if (entry.kind != LedgerKind::run_started) {
            const auto known = is_run_of(**ledger, job, entry.run);
            if (!known) {
                return known.error();
            }
            if (!*known) {
                return contradiction(job, entry, "the job has no such run");
            }
        }
        if (!lies_within(entry, **ledger)) {
            return contradiction(job, entry, "the job does not have these records");
        }
        if (!after.apply(entry)) {
            return contradiction(job, entry, "it contradicts what is known of these records");
        }
    }
    return CheckedRows{job, entries, (*ledger)->state, std::move(after)};
}

Result<void> Spool::State::append_checked(std::span<const CheckedRows> jobs) {
    if (auto written = write_rows(jobs); !written) {
        return fatal(written.error());
    }
    for (const CheckedRows& rows : jobs) {
        // What is not cached (any more) is read again when it is needed.
        if (const auto cached = ledgers.find(static_cast<std::int64_t>(rows.job)); cached != ledgers.end()) {
            cached->second.state = rows.after;
        }
    }
    return {};
}

Result<void> Spool::State::write_rows(std::span<const CheckedRows> jobs) {
    auto transaction = Transaction::begin(*database);
    if (!transaction) {
        return transaction.error();
    }
    const std::int64_t time_ns = wall_clock_ns();
    std::int64_t sequence = last_sequence;
    std::string hash = last_hash;
    {
        auto statement =
            database->prepare("INSERT INTO ledger (sequence, job, kind, run, first, records, evidence, time_ns, "
                              "hash) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9)");
        if (!statement) {
            return statement.error();
        }
        for (const CheckedRows& rows : jobs) {
            for (const LedgerEntry& entry : rows.entries) {
                hash = ledger_hash(hash, ++sequence, rows.job, entry, time_ns);
                const std::string hash_bytes = bytes_of(hash);
                statement->bind(1, sequence)
                    .bind(2, static_cast<std::int64_t>(rows.job))
                    .bind(3, to_string(entry.kind))
                    .bind(4, static_cast<std::int64_t>(entry.run))
                    .bind(5, std::int64_t{entry.range.first().value()})
                    .bind(6, static_cast<std::int64_t>(entry.range.count().value()))
                    .bind(7, entry.evidence)
                    .bind(8, time_ns)
                    .bind_blob(9, hash_bytes);
                if (auto done = statement->run(); !done) {
                    return done;
                }
            }
        }
    }
    for (const CheckedRows& rows : jobs) {
        if (auto done = write_segments(rows.job, rows.before, rows.after); !done) {
            return done;
        }
    }
    if (auto done = transaction->commit(); !done) {
        return done;
    }
    last_sequence = sequence;
    last_hash = std::move(hash);
    return {};
}

Result<void> Spool::State::write_segments(JobId job, const LedgerState& before, const LedgerState& after) {
    // Rows change a few segments in the middle: what is alike on both sides is left alone.
    std::span<const LedgerSegment> old_segments{before.segments()};
    std::span<const LedgerSegment> new_segments{after.segments()};
    const auto same_front = static_cast<std::size_t>(
        std::mismatch(old_segments.begin(), old_segments.end(), new_segments.begin(), new_segments.end()).first -
        old_segments.begin());
    old_segments = old_segments.subspan(same_front);
    new_segments = new_segments.subspan(same_front);
    while (!old_segments.empty() && !new_segments.empty() && old_segments.back() == new_segments.back()) {
        old_segments = old_segments.first(old_segments.size() - 1);
        new_segments = new_segments.first(new_segments.size() - 1);
    }
    auto remove = database->prepare("DELETE FROM ledger_segments WHERE job = ?1 AND first = ?2");
    if (!remove) {
        return remove.error();
    }
    for (const LedgerSegment& segment : old_segments) {
        remove->bind(1, static_cast<std::int64_t>(job)).bind(2, std::int64_t{segment.range.first().value()});
        if (auto done = remove->run(); !done) {
            return done;
        }
    }
    auto insert =
        database->prepare("INSERT INTO ledger_segments (job, first, records, state, run) VALUES (?1, ?2, ?3, ?4, ?5)");
    if (!insert) {
        return insert.error();
    }
    for (const LedgerSegment& segment : new_segments) {
        insert->bind(1, static_cast<std::int64_t>(job))
            .bind(2, std::int64_t{segment.range.first().value()})
            .bind(3, static_cast<std::int64_t>(segment.range.count().value()))
            .bind(4, to_string(segment.state))
            .bind(5, static_cast<std::int64_t>(segment.run));
        if (auto done = insert->run(); !done) {
            return done;
        }
    }
    return {};
}

Result<RunId> Spool::begin_run(JobId job, RecordRange range, const std::string& evidence) {
    const RunId run{state_->last_sequence + 1};
    const LedgerEntry entry{LedgerKind::run_started, run, range, evidence};
    if (auto done = state_->append_rows(job, {&entry, 1}); !done) {
        return done.error();
    }
    return run;
}

namespace {

Result<void> check_starts_no_run(JobId job, std::span<const LedgerEntry> entries) {
    for (const LedgerEntry& entry : entries) {
        if (entry.kind == LedgerKind::run_started) {
            return contradiction(job, entry, "begin_run() starts runs");
        }
    }
    return {};
}

} // namespace

Result<void> Spool::append(JobId job, std::span<const LedgerEntry> entries) {
    if (auto right = check_starts_no_run(job, entries); !right) {
        return right;
    }
    if (entries.empty()) {
        return state_->check_writable();
    }
    return state_->append_rows(job, entries);
}

Result<void> Spool::append_together(std::span<const JobRows> jobs) {
    if (auto writable = state_->check_writable(); !writable) {
        return writable;
    }
    std::vector<State::CheckedRows> checked;
    for (const JobRows& rows : jobs) {
        if (auto right = check_starts_no_run(rows.job, rows.entries); !right) {
            return right;
        }
        auto one = state_->check_rows(rows.job, rows.entries);
        if (!one) {
            return one.error();
        }
        checked.push_back(*std::move(one));
    }
    return state_->append_checked(checked);
}

Result<std::vector<JobId>> Spool::jobs_with_open_records() {
    auto statement =
        state_->database->prepare("SELECT DISTINCT job FROM ledger_segments WHERE state = 'open' ORDER BY job");
    if (!statement) {
        return statement.error();
    }
    std::vector<JobId> jobs;
    while (true) {
        const auto row = statement->step();
        if (!row) {
            return row.error();
        }
        if (!*row) {
            return jobs;
        }
        jobs.push_back(JobId{statement->number(0)});
    }
}

Result<LedgerState> Spool::ledger_state(JobId job) {
    const auto ledger = state_->job_ledger(job);
    if (!ledger) {
        return ledger.error();
    }
    return (*ledger)->state;
}

} // namespace linefeed::spool
