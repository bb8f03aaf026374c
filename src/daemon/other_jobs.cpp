#include "daemon/other_jobs.hpp"

#include <utility>

namespace linefeed::daemon {

namespace {

/// The jobs besides `job` with open records at that printer, oldest first.
Result<std::vector<spool::JobId>> others_at(spool::Spool& spool, spool::JobId job, const std::string& printer) {
    const auto open_jobs = spool.jobs_with_open_records();
    if (!open_jobs) {
        return open_jobs.error();
    }
    std::vector<spool::JobId> others;
    for (const spool::JobId id : *open_jobs) {
        const auto open = store::find_open_issue(spool, id);
        if (!open) {
            return open.error();
        }
        if (id != job && *open && (*open)->printer == printer) {
            others.push_back(id);
        }
    }
    return others;
}

struct OtherJob {
    spool::Job job;
    store::OpenIssue open;
};

/// Absent: nothing of it is open any more.
Result<std::optional<OtherJob>> open_records_of(spool::Spool& spool, spool::JobId id) {
    auto open = store::find_open_issue(spool, id);
    auto job = spool.job(id);
    if (!open || !job) {
        return open ? job.error() : open.error();
    }
    return *open && *job ? std::optional{OtherJob{std::move(**job), std::move(**open)}} : std::nullopt;
}

Result<std::optional<OtherJob>> find_open_records_of(RunThreads threads, spool::JobId id) {
    Result<std::optional<OtherJob>> found{std::optional<OtherJob>{}};
    threads.store.call([&](spool::Spool& spool) { found = open_records_of(spool, id); });
    return found;
}

} // namespace

Result<std::vector<spool::JobId>> other_jobs(RunThreads threads, spool::JobId job, const std::string& printer) {
    Result<std::vector<spool::JobId>> others{std::vector<spool::JobId>{}};
    threads.store.call([&](spool::Spool& spool) { others = others_at(spool, job, printer); });
    return others;
}

Result<std::optional<Hindrance>> settle_other_jobs(RunThreads threads, spool::Spool& spool, spool::JobId job,
                                                   const JobRunSettings& settings, const WatchRun& watch) {
    const auto others = other_jobs(threads, job, link::to_string(settings.printer));
    if (!others) {
        return others.error();
    }
    for (const spool::JobId id : *others) {
        const auto other = find_open_records_of(threads, id);
        if (!other) {
            return other.error();
        }
        if (!*other) {
            continue; // settled with the one before it
        }
        JobRun run{threads, spool, (*other)->job, {}, (*other)->open, settings};
        run.start();
        watch(run, id);
        run.join();
        const auto left = find_open_records_of(threads, id);
        if (!left) {
            return left.error();
        }
        if (*left) {
            return std::optional{Hindrance{run.outcome(), run.detail()}};
        }
    }
    return std::optional<Hindrance>{};
}

} // namespace linefeed::daemon
