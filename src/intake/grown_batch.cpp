#include "intake/grown_batch.hpp"

#include <algorithm>
#include <filesystem>

namespace linefeed::intake {

Result<bool> has_records(spool::Spool& spool, const spool::Job& job, const RecordPage& page) {
    const RecordNumber last = std::min(page.range().last(), job.records.last());
    for (RecordNumber number = page.first;;) {
        const auto stored = spool.read_page(job.id, number);
        if (!stored) {
            return stored.error();
        }
        const RecordRange both = RecordRange::closed(number, std::min(stored->range().last(), last));
        if (stored->slice(both) != page.slice(both)) {
            return false;
        }
        if (both.last() == last) {
            return true;
        }
        number = both.last().next();
    }
}

namespace {

/// Cancelled before anything of it was printed.
Result<bool> is_given_up(spool::Spool& spool, spool::JobId job) {
    const auto ticket = spool.ticket(job);
    if (!ticket) {
        return ticket.error();
    }
    if (!*ticket || !(*ticket)->cancelled) {
        return false;
    }
    const auto ledger = spool.ledger_state(job);
    return ledger ? Result<bool>{ledger->segments().empty()} : ledger.error();
}

} // namespace

Result<void> GrownCheck::add(const RecordPage& page) {
    const bool first = records_.empty();
    records_ = first ? page.range() : RecordRange::closed(records_.first(), page.range().last());
    if (first) {
        return read_([&](spool::Spool& spool) {
            auto found = find(spool, page);
            return found ? compare(spool, page) : found;
        });
    }
    const bool more_to_compare =
        std::ranges::any_of(alike_, [&](const spool::Job& job) { return job.records.last() >= page.first; });
    return more_to_compare ? read_([&](spool::Spool& spool) { return compare(spool, page); }) : Result<void>{};
}

Result<void> GrownCheck::find(spool::Spool& spool, const RecordPage& page) {
    auto jobs = spool.find_by_first_record(page.slice({page.first, RecordCount{1}}));
    if (!jobs) {
        return jobs.error();
    }
    const auto folder = std::filesystem::path{spec_.source.path}.parent_path();
    for (spool::Job& job : *jobs) {
        if (std::filesystem::path{job.spec.source.path}.parent_path() != folder) {
            continue;
        }
        const auto given_up = is_given_up(spool, job.id);
        if (!given_up) {
            return given_up.error();
        }
        if (!*given_up) {
            alike_.push_back(std::move(job));
        }
    }
    std::ranges::sort(alike_, {}, [](const spool::Job& job) { return job.records.last(); });
    return {};
}

/// Those that go on otherwise are left out from now on.
Result<void> GrownCheck::compare(spool::Spool& spool, const RecordPage& page) {
    for (auto job = alike_.begin(); job != alike_.end();) {
        const bool over = job->records.last() < page.first;
        const auto same = over ? Result<bool>{true} : has_records(spool, *job, page);
        if (!same) {
            return same.error();
        }
        job = *same ? job + 1 : alike_.erase(job);
    }
    return {};
}

Result<void> GrownCheck::finish() const {
    const bool known =
        std::ranges::any_of(alike_, [this](const spool::Job& job) { return job.records.last() == records_.last(); });
    const auto longest = std::find_if(alike_.rbegin(), alike_.rend(),
                                      [this](const spool::Job& job) { return job.records.last() < records_.last(); });
    if (known || longest == alike_.rend()) { // the very same batch is found by its content, see earlier_job()
        return {};
    }
    return Failure{FailureKind::input,
                   "its first " + std::to_string(longest->records.count().value()) + " records are those of job " +
                       std::to_string(static_cast<std::int64_t>(longest->id)) + ", which came from " +
                       longest->spec.source.path +
                       ", and would be printed again: drop only what is new, or set grown_files: print for this "
                       "folder"};
}

ImportOptions GrownCheck::in(const ImportOptions& options) {
    ImportOptions with = options;
    with.check_page = [this](const RecordPage& page) { return add(page); };
    with.check_records = [this] { return finish(); };
    return with;
}

} // namespace linefeed::intake
