#include "store/open_issue.hpp"

#include "store/evidence_json.hpp"

#include <algorithm>
#include <utility>

namespace linefeed::store {

using spool::RecordState;

namespace {

/// What one run has left open, and what is known of it.
struct LeftOpen {
    OpenJob job;
    RunStart start;
    RunEnd end;
};

Result<RunStart> start_of(const spool::LedgerRow& started) {
    auto start = parse_run_start(started.entry.evidence);
    if (!start) {
        return Failure{FailureKind::storage, "the print ledger is damaged: the start of run " +
                                                 std::to_string(static_cast<std::int64_t>(started.entry.run)) +
                                                 " cannot be read"};
    }
    return std::move(*start);
}

/// The run may have begun before the end of its job was known.
Result<RecordRange> range_of_run(spool::Spool& spool, spool::JobId id, RecordRange meant) {
    const auto job = spool.job(id);
    if (!job) {
        return job.error();
    }
    LINEFEED_ASSERT(job->has_value()); // a job that stands in the ledger stays
    if ((*job)->state == spool::ImportState::importing) {
        return meant;
    }
    return RecordRange::closed(meant.first(), std::min(meant.last(), (*job)->records.last()));
}

Result<std::optional<LeftOpen>> left_open_by(spool::Spool& spool, spool::JobId job) {
    const auto state = spool.ledger_state(job);
    if (!state) {
        return state.error();
    }
    const std::vector<RecordRange> open = state->ranges(RecordState::open);
    if (open.empty()) {
        return std::optional<LeftOpen>{};
    }
    const auto last_run = spool.last_run(job);
    if (!last_run) {
        return last_run.error();
    }
    // A run issues in ascending order and none begins before the last is settled, so what is open is one stretch of the
    // last run.
    LINEFEED_ASSERT(open.size() == 1 && last_run->has_value());
    const spool::LedgerRow& started = (*last_run)->started;
    auto start = start_of(started);
    if (!start) {
        return start.error();
    }
    const auto range = range_of_run(spool, job, started.entry.range);
    if (!range) {
        return range.error();
    }
    LeftOpen left{{job, started.entry.run, open.front(), *range, {range->first(), range->first(), range->last()}},
                  std::move(*start),
                  {}};
    if (const auto& ended = (*last_run)->ended) {
        left.end = parse_run_end(ended->entry.evidence).value_or(RunEnd{});
    }
    return std::optional{std::move(left)};
}

bool follows(const LeftOpen& follower, const LeftOpen& before) {
    return follower.start.follows == FollowedRun{before.job.job, before.job.run};
}

/// The run that followed this one, or that this one followed, if that has left records open as well.
Result<std::optional<LeftOpen>> companion_of(spool::Spool& spool, const LeftOpen& left) {
    const auto open_jobs = spool.jobs_with_open_records();
    if (!open_jobs) {
        return open_jobs.error();
    }
    for (const spool::JobId id : *open_jobs) {
        auto other = id == left.job.job ? std::optional<LeftOpen>{} : left_open_by(spool, id);
        if (!other) {
            return other.error();
        }
        if (*other && (follows(**other, left) || follows(left, **other))) {
            return other;
        }
    }
    return std::optional<LeftOpen>{};
}

RecordNumber broken_off_in(const LeftOpen& left) {
    const RecordNumber record = left.end.broken_off;
    return left.job.records.contains(record) ? left.job.places.place_of(record) : RecordNumber{};
}

OpenIssue issue_of(LeftOpen left) {
    OpenIssue issue;
    const OpenJob& job = left.job;
    issue.printer = std::move(left.start.printer);
    issue.facts = {job.run_range.first(),    job.records.first().previous(), job.records.last(),
                   left.start.serial_number, left.start.total_before,        left.start.last_printed_before};
    issue.facts.last = job.run_range.last();
    issue.facts.broken_off = broken_off_in(left);
    issue.facts.unclear = left.end.unclear;
    if (left.start.follows) {
        issue.numbering = feeder::Numbering::begun_with_zero(job.run_range.first());
    }
    issue.jobs.push_back(left.job);
    return issue;
}

/// Nothing of it is printed before all of the job before it is.
void add_follower(OpenIssue& issue, LeftOpen follower) {
    OpenJob& job = follower.job;
    const RecordNumber boundary = issue.jobs.front().places.last;
    job.places = {boundary.next(), job.run_range.first(), boundary + job.run_range.count()};
    issue.facts.issued_through = job.places.place_of(job.records.last());
    issue.facts.last = job.places.last;
    issue.facts.broken_off = std::max(issue.facts.broken_off, broken_off_in(follower));
    issue.facts.unclear = issue.facts.unclear || follower.end.unclear;
    issue.numbering.append(job.places.first, job.run_range.first());
    issue.jobs.push_back(job);
}

} // namespace

const OpenJob* OpenIssue::of(spool::JobId job) const {
    const auto found = std::ranges::find(jobs, job, &OpenJob::job);
    return found == jobs.end() ? nullptr : &*found;
}

Result<std::optional<OpenIssue>> find_open_issue(spool::Spool& spool, spool::JobId job) {
    auto left = left_open_by(spool, job);
    if (!left || !*left) {
        return left ? Result<std::optional<OpenIssue>>{std::nullopt} : left.error();
    }
    auto companion = companion_of(spool, **left);
    if (!companion) {
        return companion.error();
    }
    if (*companion && follows(**left, **companion)) {
        std::swap(*left, *companion);
    }
    OpenIssue issue = issue_of(std::move(**left));
    if (*companion) {
        add_follower(issue, std::move(**companion));
    }
    return std::optional{std::move(issue)};
}

feeder::FeederPlan make_plan(const std::optional<OpenIssue>& open, spool::JobId job, RecordRange wanted) {
    feeder::FeederPlan plan;
    if (open) {
        const OpenJob* const own = open->of(job);
        plan.open = open->facts;
        plan.numbering = open->numbering;
        plan.doubt_blocks = own != nullptr;
        plan.take_over =
            own != nullptr && open->jobs.size() == 1 && !wanted.empty() && own->run_range.last() == wanted.last();
    }
    return plan;
}

} // namespace linefeed::store
