// The first record of each job, by which a batch that begins with the records of another is found. Jobs from before
// schema 4 have none written down: it is made up for when the spool is opened.
#include "spool/checksum.hpp"
#include "spool/spool_state.hpp"

#include <utility>
#include <vector>

namespace linefeed::spool {

namespace {

/// Jobs and the numbers of their first records, where nothing is written down of those.
Result<std::vector<std::pair<JobId, RecordNumber>>> jobs_without_head(Database& database) {
    auto statement = database.prepare("SELECT jobs.id, pages.first FROM jobs JOIN pages "
                                      "ON pages.job = jobs.id AND pages.first = jobs.base + 1 "
                                      "WHERE jobs.id NOT IN (SELECT job FROM job_heads)");
    if (!statement) {
        return statement.error();
    }
    std::vector<std::pair<JobId, RecordNumber>> jobs;
    while (true) {
        const auto more = statement->step();
        if (!more) {
            return more.error();
        }
        if (!*more) {
            return jobs;
        }
        const auto first = stored_range(statement->number(1), 1);
        if (!first) {
            return Failure{FailureKind::storage, database.path() + ": the spool is damaged: a page has no number"};
        }
        jobs.emplace_back(JobId{statement->number(0)}, first->first());
    }
}

} // namespace

Result<void> Spool::State::write_head(JobId id, const RecordPage& page) {
    auto statement = database->prepare("INSERT INTO job_heads (job, head) VALUES (?1, ?2)");
    if (!statement) {
        return statement.error();
    }
    return statement->bind(1, static_cast<std::int64_t>(id))
        .bind(2, sha256_hex(page.slice({page.first, RecordCount{1}})))
        .run();
}

Result<void> Spool::State::write_missing_heads() {
    const auto jobs = jobs_without_head(*database);
    if (!jobs || jobs->empty()) {
        return jobs ? Result<void>{} : jobs.error();
    }
    auto transaction = Transaction::begin(*database);
    if (!transaction) {
        return transaction.error();
    }
    for (const auto& [id, first] : *jobs) {
        const auto page = read_page(id, first);
        if (!page) {
            continue; // whoever prints the job or verifies the spool hears of it
        }
        if (auto written = write_head(id, *page); !written) {
            return written;
        }
    }
    return transaction->commit();
}

} // namespace linefeed::spool
