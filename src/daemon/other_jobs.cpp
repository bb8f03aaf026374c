#include "daemon/other_jobs.hpp"

namespace linefeed::daemon {

namespace {

struct OtherJob {
    spool::Job job;
    store::OpenIssue open;
};

/// The jobs besides `job` with open records at that printer, oldest first.
Result<std::vector<OtherJob>> others_at(spool::Spool& spool, spool::JobId job, const std::string& printer) {
    const auto open_jobs = spool.jobs_with_open_records();
    if (!open_jobs) {
        return open_jobs.error();
    }
    std::vector<OtherJob> others;
    for (const spool::JobId id : *open_jobs) {
        auto open = store::find_open_issue(spool, id);
        auto other = spool.job(id);
        if (!open || !other) {
            return open ? other.error() : open.error();
        }
        if (id != job && *open && *other && (*open)->printer == printer) {
            others.push_back({std::move(**other), std::move(**open)});
        }
    }
    return others;
}

Result<std::vector<OtherJob>> find_others(RunThreads threads, spool::JobId job, const std::string& printer) {
    Result<std::vector<OtherJob>> others{std::vector<OtherJob>{}};
    threads.store.call([&](spool::Spool& spool) { others = others_at(spool, job, printer); });
    return others;
}

} // namespace

Result<bool> has_other_jobs(RunThreads threads, spool::JobId job, const std::string& printer) {
    const auto others = find_others(threads, job, printer);
    return others ? Result<bool>{!others->empty()} : others.error();
}

Result<std::optional<Hindrance>> settle_other_jobs(RunThreads threads, spool::Spool& spool, spool::JobId job,
                                                   const JobRunSettings& settings, const WatchRun& watch) {
    const auto others = find_others(threads, job, link::to_string(settings.printer));
    if (!others) {
        return others.error();
    }
    for (const OtherJob& other : *others) {
        JobRun run{threads, spool, other.job, {}, other.open, settings};
        run.start();
        watch(run, other.job.id);
        run.join();
        Result<std::optional<store::OpenIssue>> left{std::optional<store::OpenIssue>{}};
        threads.store.call([&](spool::Spool& owned) { left = store::find_open_issue(owned, other.job.id); });
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
