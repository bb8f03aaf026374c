#include "cli/earlier_jobs.hpp"

#include "intake/grown_batch.hpp"
#include "intake/layout.hpp"

#include <algorithm>

namespace linefeed::cli {

namespace {

/// The first records of `grown` are exactly those of `old`.
Result<bool> begins_with(spool::Spool& spool, const spool::Job& grown, const spool::Job& old) {
    if (grown.frame_bytes < old.frame_bytes || grown.records.first() != old.records.first()) {
        return false;
    }
    for (RecordNumber number = old.records.first();;) {
        const auto page = spool.read_page(grown.id, number);
        if (!page) {
            return page.error();
        }
        const auto same = intake::has_records(spool, old, *page);
        if (!same || !*same) {
            return same;
        }
        if (page->range().last() >= old.records.last()) {
            return true;
        }
        number = page->range().last().next();
    }
}

/// Printing the same records as a new job is for jobs that are done: otherwise the command that was meant to start
/// again would, given once more to continue, start over.
Result<void> check_finished(spool::Spool& spool, const spool::Job& twin) {
    const auto state = spool.ledger_state(twin.id);
    if (!state) {
        return state.error();
    }
    const bool waiting = state->count(spool::RecordState::open) > RecordCount{0} ||
                         state->count(spool::RecordState::in_doubt) > RecordCount{0} ||
                         !state->next_printable(twin.records).empty();
    if (!state->segments().empty() && waiting) {
        return Failure{FailureKind::usage, "job " + std::to_string(static_cast<std::int64_t>(twin.id)) +
                                               " has the same records and is not finished (" +
                                               std::to_string(state->count(spool::RecordState::printed).value()) +
                                               " of " + std::to_string(twin.records.count().value()) +
                                               " printed): continue it without --new-job"};
    }
    return {};
}

} // namespace

std::string name_of(const spool::Job& job) {
    return "job " + std::to_string(static_cast<std::int64_t>(job.id));
}

Result<RecordCount> printed_of(spool::Spool& spool, const spool::Job& job) {
    const auto state = spool.ledger_state(job.id);
    if (!state) {
        return state.error();
    }
    return state->count(spool::RecordState::printed) + state->count(spool::RecordState::skipped);
}

Result<void> check_earlier_jobs(spool::Spool& spool, const spool::Job& job) {
    const auto earlier = spool.find_by_path(job.spec.source.path);
    if (!earlier) {
        return earlier.error();
    }
    for (const spool::Job& old : *earlier) {
        if (old.id == job.id) {
            continue;
        }
        const auto state = spool.ledger_state(old.id);
        if (!state) {
            return state.error();
        }
        if (state->segments().empty()) {
            continue; // nothing of it was ever issued
        }
        const RecordCount printed =
            state->count(spool::RecordState::printed) + state->count(spool::RecordState::skipped);
        const std::string name = name_of(old);
        if (printed < old.records.count()) {
            return Failure{FailureKind::input,
                           job.spec.source.path + " or the way to read it has changed since " + name +
                               " was imported from it, of which " + std::to_string(printed.value()) + " of " +
                               std::to_string(old.records.count().value()) +
                               " records are printed: restore the file and options to go on, or print it from its "
                               "first record as a new job with --new-job"};
        }
        const auto grown = begins_with(spool, job, old);
        if (!grown) {
            return grown.error();
        }
        if (*grown) {
            return Failure{FailureKind::input, job.spec.source.path + " has grown: its first " +
                                                   std::to_string(old.records.count().value()) + " records are " +
                                                   name +
                                                   ", printed already; print the new ones with --new-job --from " +
                                                   std::to_string(old.records.last().value() + std::uint64_t{1}) +
                                                   ", or all of them again with --new-job"};
        }
    }
    return {};
}

Result<void> check_unfinished(spool::Spool& spool, const spool::Job& job) {
    const auto unfinished = spool.unfinished_jobs();
    if (!unfinished) {
        return unfinished.error();
    }
    for (const spool::Job& old : *unfinished) {
        if (old.id == job.id || !intake::is_same_way(old.spec.layout, job.spec.layout) || old.records.empty()) {
            continue;
        }
        const auto same = begins_with(spool, job, old);
        if (!same) {
            return same.error();
        }
        if (*same) {
            return Failure{FailureKind::input,
                           job.spec.source.path + " begins with the records of " + name_of(old) +
                               ", which was imported from " + old.spec.source.path +
                               " while it was printed and is not finished: continue it with that file, or print all of "
                               "them again with --new-job"};
        }
    }
    return {};
}

Result<bool> may_be_known(spool::Spool& spool, const spool::JobSpec& spec, spool::JobId id, bool new_job) {
    const auto jobs = spool.jobs();
    const auto mine = spool.read_page(id, spec.base.next());
    if (!jobs || !mine) {
        return jobs ? mine.error() : jobs.error();
    }
    for (const spool::Job& other : *jobs) {
        if (other.id == id || other.records.empty()) {
            continue;
        }
        if (!new_job && other.spec.source.path == spec.source.path) {
            return true;
        }
        if (!intake::is_same_way(other.spec.layout, spec.layout) || other.spec.base != spec.base) {
            continue;
        }
        const auto page = spool.read_page(other.id, spec.base.next());
        if (!page) {
            return page.error();
        }
        const RecordRange both = RecordRange::closed(mine->first, std::min(mine->range().last(), page->range().last()));
        if (mine->slice(both) == page->slice(both)) {
            return true;
        }
    }
    return false;
}

Result<std::optional<spool::Job>> twin_of(spool::Spool& spool, const spool::Job& job, bool new_job) {
    const auto same = spool.find_by_content(job.content_sha256);
    if (!same) {
        return same.error();
    }
    const auto twin = std::find_if(same->rbegin(), same->rend(), [&](const spool::Job& other) {
        return other.id != job.id && intake::is_same_way(other.spec.layout, job.spec.layout);
    });
    if (twin == same->rend()) {
        return std::optional<spool::Job>{};
    }
    if (new_job) {
        const auto finished = check_finished(spool, *twin);
        return finished ? Result<std::optional<spool::Job>>{std::optional<spool::Job>{}} : finished.error();
    }
    return std::optional{*twin};
}

} // namespace linefeed::cli
