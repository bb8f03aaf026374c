// Reading the ledger back: rows for people and exports, and the proof that nothing in it was changed.
#include "spool/ledger_codec.hpp"
#include "spool/spool_state.hpp"

#include <algorithm>
#include <iterator>
#include <map>

namespace linefeed::spool {

namespace {

/// Folds all rows of the ledger and says what is wrong with the first that does not fit.
class Verifier {
public:
    /// Empty if the row is right.
    [[nodiscard]] std::string check(const LedgerRow& row) {
        ++sequence_;
        if (row.sequence != sequence_) {
            return "ledger row " + std::to_string(sequence_) + " is missing";
        }
        const std::string place = "ledger row " + std::to_string(sequence_);
        if (row.hash != ledger_hash(hash_, row.sequence, row.job, row.entry, row.time_ns)) {
            return place + " was changed: it does not match its hash";
        }
        hash_ = row.hash;
        if (row.entry.kind == LedgerKind::run_started) {
            runs_[row.entry.run] = row.job;
            if (row.entry.run != RunId{row.sequence}) {
                return place + " contradicts the rows before it: it starts another row's run";
            }
        }
        if (const auto run = runs_.find(row.entry.run); run == runs_.end() || run->second != row.job) {
            return place + " contradicts the rows before it: the job has no such run";
        }
        if (!states_[row.job].apply(row.entry)) {
            return place + " contradicts the rows before it";
        }
        return {};
    }

    [[nodiscard]] std::int64_t sequence() const { return sequence_; }
    [[nodiscard]] const std::string& hash() const { return hash_; }
    [[nodiscard]] const std::map<JobId, LedgerState>& states() const { return states_; }

private:
    std::int64_t sequence_ = 0;
    std::string hash_{first_previous_hash};
    std::map<RunId, JobId> runs_;
    std::map<JobId, LedgerState> states_;
};

Result<std::vector<JobId>> jobs_with_segments(Database& database) {
    auto statement = database.prepare("SELECT DISTINCT job FROM ledger_segments");
    if (!statement) {
        return statement.error();
    }
    std::vector<JobId> jobs;
    while (true) {
        const auto more = statement->step();
        if (!more) {
            return more.error();
        }
        if (!*more) {
            return jobs;
        }
        jobs.push_back(JobId{statement->number(0)});
    }
}

} // namespace

Result<std::int64_t> Spool::verify_ledger() {
    // One view of everything, also while another process appends rows.
    if (auto begun = state_->database->execute("BEGIN"); !begun) {
        return begun.error();
    }
    auto verified = state_->verify();
    if (auto ended = state_->database->execute("COMMIT"); !ended) {
        return ended.error();
    }
    return verified;
}

Result<std::int64_t> Spool::State::verify() {
    const std::string& path = database->path();
    if (reads_only()) { // the writer has gone on since
        if (auto loaded = load_end_of_chain(); !loaded) {
            return loaded.error();
        }
    }
    Verifier verifier;
    {
        static const std::string sql = std::string{select_ledger} + "ORDER BY l.sequence";
        auto statement = database->prepare(sql.c_str());
        if (!statement) {
            return statement.error();
        }
        while (true) {
            const auto more = statement->step();
            if (!more) {
                return more.error();
            }
            if (!*more) {
                break;
            }
            const auto row = ledger_row_from(*statement, path);
            if (!row) {
                return row.error();
            }
            if (std::string problem = verifier.check(*row); !problem.empty()) {
                return Failure{FailureKind::storage, problem.insert(0, path + ": ")};
            }
        }
    }
    if (verifier.sequence() != last_sequence || verifier.hash() != last_hash) {
        return Failure{FailureKind::storage, path + ": ledger row " + std::to_string(verifier.sequence() + 1) +
                                                 " is missing: it was there when the spool was opened"};
    }
    auto jobs = jobs_with_segments(*database);
    if (!jobs) {
        return jobs.error();
    }
    for (const auto& [job, state] : verifier.states()) {
        jobs->push_back(job);
    }
    for (const JobId job : *jobs) {
        const auto stored = read_segments(job);
        if (!stored) {
            return stored.error();
        }
        const auto folded = verifier.states().find(job);
        if (folded == verifier.states().end() ? !stored->segments().empty() : *stored != folded->second) {
            return Failure{FailureKind::storage, path + ": the stored state of job " +
                                                     std::to_string(static_cast<std::int64_t>(job)) +
                                                     " was changed: it does not match the ledger rows"};
        }
    }
    return verifier.sequence();
}

namespace {

Result<std::vector<LedgerRow>> read_rows(Statement& statement, const std::string& path) {
    std::vector<LedgerRow> rows;
    while (true) {
        const auto more = statement.step();
        if (!more) {
            return more.error();
        }
        if (!*more) {
            return rows;
        }
        auto row = ledger_row_from(statement, path);
        if (!row) {
            return row.error();
        }
        rows.push_back(std::move(*row));
    }
}

} // namespace

Result<std::vector<LedgerRow>> Spool::ledger_rows(JobId job, std::int64_t after, std::size_t limit) {
    static const std::string sql =
        std::string{select_ledger} + "WHERE l.job = ?1 AND l.sequence > ?2 ORDER BY l.sequence LIMIT ?3";
    auto statement = state_->database->prepare(sql.c_str());
    if (!statement) {
        return statement.error();
    }
    constexpr std::size_t most = 1'000'000'000;
    statement->bind(1, static_cast<std::int64_t>(job))
        .bind(2, after)
        .bind(3, static_cast<std::int64_t>(limit < most ? limit : most));
    return read_rows(*statement, state_->database->path());
}

Result<std::int64_t> Spool::last_ledger_row(JobId job) {
    auto statement = state_->database->prepare("SELECT ifnull(max(sequence), 0) FROM ledger WHERE job = ?1");
    if (!statement) {
        return statement.error();
    }
    if (const auto row = statement->bind(1, static_cast<std::int64_t>(job)).step(); !row) {
        return row.error();
    }
    return statement->number(0);
}

Result<std::vector<LedgerRow>> Spool::doubt_rows(JobId job, RunId run) {
    static const std::string start_sql = std::string{select_ledger} + "WHERE l.job = ?1 AND l.sequence = ?2";
    static const std::string doubt_sql =
        std::string{select_ledger} + "WHERE l.job = ?1 AND l.run = ?2 AND l.kind = 'in_doubt' ORDER BY l.sequence";
    std::vector<LedgerRow> rows;
    for (const std::string* const sql : {&start_sql, &doubt_sql}) {
        auto statement = state_->database->prepare(sql->c_str());
        if (!statement) {
            return statement.error();
        }
        statement->bind(1, static_cast<std::int64_t>(job)).bind(2, static_cast<std::int64_t>(run));
        auto some = read_rows(*statement, state_->database->path());
        if (!some) {
            return some;
        }
        std::move(some->begin(), some->end(), std::back_inserter(rows));
    }
    return rows;
}

namespace {

/// The first row that `sql` finds for `id`.
Result<std::optional<LedgerRow>> first_row(Database& database, const std::string& sql, std::int64_t id) {
    auto statement = database.prepare(sql.c_str());
    if (!statement) {
        return statement.error();
    }
    const auto found = statement->bind(1, id).step();
    if (!found) {
        return found.error();
    }
    if (!*found) {
        return std::optional<LedgerRow>{};
    }
    auto row = ledger_row_from(*statement, database.path());
    if (!row) {
        return row.error();
    }
    return std::optional{std::move(*row)};
}

} // namespace

Result<std::optional<Spool::LastRun>> Spool::last_run(JobId job) {
    static const std::string last_start =
        std::string{select_ledger} + "WHERE l.job = ?1 AND l.kind = 'run_started' ORDER BY l.sequence DESC LIMIT 1";
    static const std::string last_end =
        std::string{select_ledger} + "WHERE l.run = ?1 AND l.kind = 'run_ended' ORDER BY l.sequence DESC LIMIT 1";
    auto started = first_row(*state_->database, last_start, static_cast<std::int64_t>(job));
    if (!started) {
        return started.error();
    }
    if (!*started) {
        return std::optional<LastRun>{};
    }
    auto ended = first_row(*state_->database, last_end, static_cast<std::int64_t>((*started)->entry.run));
    if (!ended) {
        return ended.error();
    }
    return std::optional{LastRun{std::move(**started), std::move(*ended)}};
}

} // namespace linefeed::spool
