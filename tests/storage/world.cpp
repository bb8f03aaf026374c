#include "world.hpp"

#include "spool/checksum.hpp"
#include "spool/database.hpp"

#include <algorithm>

namespace linefeed::test {

using spool::JobId;

namespace {

Failure contradiction(JobId job, const std::string& what) {
    return {FailureKind::internal, "job " + std::to_string(static_cast<std::int64_t>(job)) + ": " + what};
}

/// SHA-256 of all frames of a job, read page by page.
Result<std::string> read_content(spool::Spool& spool, const spool::Job& job) {
    spool::Sha256 content;
    RecordNumber next = job.records.first();
    while (true) {
        const auto page = spool.read_page(job.id, next);
        if (!page) {
            return page.error();
        }
        if (page->first != next) {
            return contradiction(job.id, "pages overlap");
        }
        content.update(page->frames);
        if (page->range().last() >= job.records.last()) {
            break;
        }
        next = page->range().last().next();
    }
    const spool::Sha256Digest digest = content.finish();
    return spool::to_hex({reinterpret_cast<const char*>(digest.data()), digest.size()});
}

Result<void> check_job(spool::Spool& spool, const spool::Job& job) {
    if (job.state != spool::ImportState::ready || job.records.empty()) {
        return contradiction(job.id, "a half import is there");
    }
    const auto content = read_content(spool, job);
    if (!content) {
        return content.error();
    }
    return *content == job.content_sha256 ? Result<void>{} : contradiction(job.id, "the content is another one");
}

/// The rows of one job, which must come to the state that the spool has stored.
Result<std::vector<spool::LedgerRow>> read_rows(spool::Spool& spool, JobId job) {
    auto rows = spool.ledger_rows(job, 0, 1'000'000);
    const auto state = spool.ledger_state(job);
    if (!rows || !state) {
        return rows ? state.error() : rows.error();
    }
    spool::LedgerState folded;
    for (const spool::LedgerRow& row : *rows) {
        if (!folded.apply(row.entry)) {
            return contradiction(job, "the rows contradict each other");
        }
    }
    if (folded != *state) {
        return contradiction(job, "the stored state is not what the rows come to");
    }
    return rows;
}

} // namespace

std::ostream& operator<<(std::ostream& out, const World& world) {
    for (const auto& [id, job] : world.jobs) {
        out << "job " << static_cast<std::int64_t>(id) << ' ' << job.source.path << ' ' << job.records << ' '
            << job.content_sha256.substr(0, 8) << '\n';
    }
    out << world.rows.size() << " rows";
    const std::size_t shown = std::min<std::size_t>(world.rows.size(), 6);
    for (std::size_t i = world.rows.size() - shown; i < world.rows.size(); ++i) {
        const KnownRow& row = world.rows[i];
        out << "\n  " << i + 1 << " job " << static_cast<std::int64_t>(row.job) << " run "
            << static_cast<std::int64_t>(row.entry.run) << ' ' << to_string(row.entry.kind) << ' ' << row.entry.range;
    }
    return out;
}

KnownJob known(const spool::Job& job) {
    return {job.spec.source, job.records, job.content_sha256};
}

Result<World> observe(spool::Spool& spool) {
    const auto chain = spool.verify_ledger();
    if (!chain) {
        return chain.error();
    }
    const auto jobs = spool.jobs();
    if (!jobs) {
        return jobs.error();
    }
    World world;
    std::map<std::int64_t, KnownRow> by_sequence;
    for (const spool::Job& job : *jobs) {
        if (const auto checked = check_job(spool, job); !checked) {
            return checked.error();
        }
        const auto rows = read_rows(spool, job.id);
        if (!rows) {
            return rows.error();
        }
        world.jobs[job.id] = known(job);
        for (const spool::LedgerRow& row : *rows) {
            by_sequence[row.sequence] = {row.job, row.entry};
        }
    }
    if (static_cast<std::int64_t>(by_sequence.size()) != *chain) {
        return Failure{FailureKind::internal, "there are rows of a job that is not there"};
    }
    for (auto& [sequence, row] : by_sequence) {
        world.rows.push_back(std::move(row));
    }
    return world;
}

std::string integrity(const std::string& path, const std::string& vfs) {
    const auto database = spool::Database::open(path, vfs, spool::Access::read);
    if (!database) {
        return database.error().message;
    }
    const auto answer = (*database)->query_text("PRAGMA integrity_check");
    return answer ? *answer : answer.error().message;
}

} // namespace linefeed::test
