// The jobs of a spool: what was imported, from where, and which of them is meant by a source.
#include "spool/checksum.hpp"
#include "spool/spool_state.hpp"

#include <limits>

namespace linefeed::spool {

namespace {

constexpr std::string_view select_jobs =
    "SELECT id, source_path, source_size, source_modified_ns, source_inode, "
    "source_companion, layout, base, state, records, "
    "content_sha256, frame_bytes, created_ns, import_report, source_sha256 FROM jobs ";

Result<Job> job_from(const Statement& row, const std::string& path) {
    Job job;
    job.id = JobId{row.number(0)};
    job.spec.source = {std::string{row.text(1)}, static_cast<std::uint64_t>(row.number(2)), row.number(3),
                       static_cast<std::uint64_t>(row.number(4)), std::string{row.text(5)}};
    job.spec.layout = row.text(6);
    const auto base = stored_range(row.number(7), 1);
    const std::int64_t records = row.number(9);
    const auto range = records == 0 ? RecordRange{} : stored_range(row.number(7) + 1, records);
    const std::string_view state = row.text(8);
    if (!base || !range || (state != "ready" && state != "importing")) {
        return Failure{FailureKind::storage,
                       path + ": the spool is damaged: job " + std::to_string(row.number(0)) + " cannot be read"};
    }
    job.spec.base = base->first();
    job.records = *range;
    job.content_sha256 = row.text(10);
    job.state = state == "ready"             ? ImportState::ready
                : job.content_sha256.empty() ? ImportState::importing
                                             : ImportState::stopped;
    job.frame_bytes = static_cast<std::uint64_t>(row.number(11));
    job.created_ns = row.number(12);
    job.import_report = row.text(13);
    job.spec.source_sha256 = row.text(14);
    return job;
}

Result<std::vector<Job>> read_jobs(Statement& statement, const std::string& path) {
    std::vector<Job> jobs;
    while (true) {
        const auto more = statement.step();
        if (!more) {
            return more.error();
        }
        if (!*more) {
            return jobs;
        }
        auto job = job_from(statement, path);
        if (!job) {
            return job.error();
        }
        jobs.push_back(std::move(*job));
    }
}

} // namespace

std::optional<RecordRange> stored_range(std::int64_t first, std::int64_t records) {
    constexpr std::int64_t max = RecordNumber::max().value();
    if (first < 0 || first > max || records < 0 || records > max - first + 1) {
        return std::nullopt;
    }
    return RecordRange{RecordNumber{static_cast<std::uint32_t>(first)},
                       RecordCount{static_cast<std::uint64_t>(records)}};
}

Result<std::vector<Job>> Spool::jobs() {
    static const std::string sql = std::string{select_jobs} + "ORDER BY id";
    auto statement = state_->database->prepare(sql.c_str());
    if (!statement) {
        return statement.error();
    }
    return read_jobs(*statement, state_->database->path());
}

Result<std::vector<Job>> Spool::newest_jobs(std::optional<JobId> before, std::size_t limit) {
    static const std::string sql = std::string{select_jobs} + "WHERE id < ?1 ORDER BY id DESC LIMIT ?2";
    auto statement = state_->database->prepare(sql.c_str());
    if (!statement) {
        return statement.error();
    }
    const auto bound = before.value_or(JobId{std::numeric_limits<std::int64_t>::max()});
    statement->bind(1, static_cast<std::int64_t>(bound)).bind(2, static_cast<std::int64_t>(limit));
    return read_jobs(*statement, state_->database->path());
}

Result<std::optional<Job>> Spool::job(JobId id) {
    static const std::string sql = std::string{select_jobs} + "WHERE id = ?1";
    auto statement = state_->database->prepare(sql.c_str());
    if (!statement) {
        return statement.error();
    }
    auto found = read_jobs(statement->bind(1, static_cast<std::int64_t>(id)), state_->database->path());
    if (!found) {
        return found.error();
    }
    return found->empty() ? std::optional<Job>{} : std::optional{std::move(found->front())};
}

Statement& bind_source(Statement& statement, int first, const SourceFingerprint& source) {
    return statement.bind(first, source.path)
        .bind(first + 1, static_cast<std::int64_t>(source.size_bytes))
        .bind(first + 2, source.modified_ns)
        .bind(first + 3, static_cast<std::int64_t>(source.inode))
        .bind(first + 4, source.companion);
}

Result<std::optional<Job>> Spool::find_by_source(const JobSpec& spec) {
    static const std::string sql =
        std::string{select_jobs} +
        "WHERE source_path = ?1 AND source_size = ?2 AND source_modified_ns = ?3 AND source_inode = ?4 "
        "AND source_companion = ?5 AND layout = ?6 AND base = ?7 AND state = 'ready' "
        "ORDER BY id DESC LIMIT 1";
    auto statement = state_->database->prepare(sql.c_str());
    if (!statement) {
        return statement.error();
    }
    bind_source(*statement, 1, spec.source).bind(6, spec.layout).bind(7, std::int64_t{spec.base.value()});
    auto found = read_jobs(*statement, state_->database->path());
    if (!found) {
        return found.error();
    }
    return found->empty() ? std::optional<Job>{} : std::optional{std::move(found->front())};
}

Result<std::vector<Job>> Spool::find_by_content(const std::string& content_sha256) {
    static const std::string sql =
        std::string{select_jobs} + "WHERE content_sha256 = ?1 AND state = 'ready' ORDER BY id";
    auto statement = state_->database->prepare(sql.c_str());
    if (!statement) {
        return statement.error();
    }
    return read_jobs(statement->bind(1, content_sha256), state_->database->path());
}

Result<std::vector<Job>> Spool::find_by_source_bytes(const std::string& sha256) {
    static const std::string sql =
        std::string{select_jobs} +
        "WHERE source_sha256 = ?1 AND source_sha256 <> '' AND state = 'ready' ORDER BY id"; // the index is a partial
                                                                                            // one
    auto statement = state_->database->prepare(sql.c_str());
    if (!statement) {
        return statement.error();
    }
    return read_jobs(statement->bind(1, sha256), state_->database->path());
}

Result<std::vector<Job>> Spool::find_by_first_record(std::string_view frame) {
    static const std::string sql =
        std::string{select_jobs} +
        "WHERE id IN (SELECT job FROM job_heads WHERE head = ?1) AND state = 'ready' ORDER BY id";
    auto statement = state_->database->prepare(sql.c_str());
    if (!statement) {
        return statement.error();
    }
    return read_jobs(statement->bind(1, sha256_hex(frame)), state_->database->path());
}

Result<std::vector<Job>> Spool::find_by_path(const std::string& path) {
    static const std::string sql = std::string{select_jobs} + "WHERE source_path = ?1 AND state = 'ready' ORDER BY id";
    auto statement = state_->database->prepare(sql.c_str());
    if (!statement) {
        return statement.error();
    }
    return read_jobs(statement->bind(1, path), state_->database->path());
}

Result<std::vector<Job>> Spool::unfinished_jobs() {
    static const std::string sql =
        std::string{select_jobs} +
        "WHERE state = 'importing' AND EXISTS (SELECT 1 FROM ledger WHERE ledger.job = jobs.id) ORDER BY id";
    auto statement = state_->database->prepare(sql.c_str());
    if (!statement) {
        return statement.error();
    }
    return read_jobs(*statement, state_->database->path());
}

Result<void> Spool::State::write_source(JobId id, const SourceFingerprint& source) {
    auto statement = database->prepare("UPDATE jobs SET source_path = ?2, source_size = ?3, source_modified_ns = ?4, "
                                       "source_inode = ?5, source_companion = ?6 WHERE id = ?1");
    if (!statement) {
        return statement.error();
    }
    statement->bind(1, static_cast<std::int64_t>(id));
    return bind_source(*statement, 2, source).run();
}

Result<void> Spool::update_source(JobId id, const SourceFingerprint& source) {
    if (auto writable = state_->check_writable(); !writable) {
        return writable;
    }
    if (auto done = state_->write_source(id, source); !done) {
        return state_->failed_write(done.error());
    }
    return {};
}

Result<bool> Spool::State::stands_in_ledger(JobId id) {
    auto rows = database->prepare("SELECT 1 FROM ledger WHERE job = ?1 LIMIT 1");
    if (!rows) {
        return rows.error();
    }
    return rows->bind(1, static_cast<std::int64_t>(id)).step();
}

Result<void> Spool::remove_job(JobId id) {
    while (true) {
        const auto more = remove_job_step(id);
        if (!more) {
            return more.error();
        }
        if (!*more) {
            return {};
        }
    }
}

Result<bool> Spool::remove_job_step(JobId id) {
    if (auto writable = state_->check_writable(); !writable) {
        return writable.error();
    }
    const auto used = state_->stands_in_ledger(id);
    if (!used) {
        return used.error();
    }
    if (*used) {
        return Failure{FailureKind::usage, "job " + std::to_string(static_cast<std::int64_t>(id)) +
                                               " stands in the print ledger: it cannot be removed"};
    }
    state_->ledgers.erase(static_cast<std::int64_t>(id));
    const auto more = state_->remove_step(id);
    return more ? more : state_->failed_write(more.error());
}

Result<void> Spool::State::remove_job_in_steps(JobId id) {
    while (true) {
        const auto more = remove_step(id);
        if (!more) {
            return more.error();
        }
        if (!*more) {
            return {};
        }
    }
}

/// Its pages first, some at a time, and the job with the last of them.
Result<bool> Spool::State::remove_step(JobId id) {
    const auto job = static_cast<std::int64_t>(id);
    auto transaction = Transaction::begin(*database);
    if (!transaction) {
        return transaction.error();
    }
    auto mark = database->prepare(
        "UPDATE jobs SET state = 'importing', content_sha256 = '' WHERE id = ?1 AND content_sha256 <> ''");
    auto pages = database->prepare(
        "DELETE FROM pages WHERE id IN (SELECT id FROM pages WHERE job = ?1 ORDER BY first LIMIT 256)");
    auto row = database->prepare("DELETE FROM jobs WHERE id = ?1");
    if (!mark || !pages || !row) {
        return !mark ? mark.error() : !pages ? pages.error() : row.error();
    }
    if (auto done = mark->bind(1, job).run(); !done) {
        return done.error();
    }
    if (auto done = pages->bind(1, job).run(); !done) {
        return done.error();
    }
    const bool more = database->changes() > 0;
    if (auto done = more ? Result<void>{} : row->bind(1, job).run(); !done) {
        return done.error();
    }
    if (auto done = transaction->commit(); !done) {
        return done.error();
    }
    if (auto copied = database->checkpoint_passive(); !copied) {
        return copied.error();
    }
    return more;
}

Result<void> Spool::State::remove_unfinished_imports() {
    while (true) {
        const auto id = database->query_number("SELECT id FROM jobs WHERE state = 'importing' AND NOT EXISTS "
                                               "(SELECT 1 FROM ledger WHERE ledger.job = jobs.id) LIMIT 1");
        if (!id) {
            return id.error();
        }
        if (*id == 0) {
            return {};
        }
        if (auto done = remove_job_in_steps(JobId{*id}); !done) {
            return done;
        }
    }
}

} // namespace linefeed::spool
