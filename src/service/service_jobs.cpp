// Jobs as people see them, and what stands in the ledger about them. All of it is read over connections of their own:
// nobody who looks holds up the line.
#include "daemon/doubt_evidence.hpp"
#include "daemon/job_records.hpp"
#include "service/service.hpp"

#include <algorithm>

namespace linefeed::service {

using daemon::JobPhase;
using daemon::JobView;

namespace {

constexpr std::size_t jobs_at_once = 200;
constexpr std::size_t most_doubtful = 300;
constexpr std::size_t most_records = 1000;
constexpr std::size_t most_stretches = 1001; // one more than a page of the API: it sees that there is another
constexpr std::size_t rows_at_once = 4096;

bool wanted(const daemon::JobFilter& filter, const JobView& view) {
    const bool printer = filter.printer.empty() || filter.printer == view.printer;
    const bool phase = filter.phases.empty() || std::ranges::find(filter.phases, view.phase) != filter.phases.end();
    return printer && phase;
}

} // namespace

Result<std::vector<JobView>> Service::jobs(const daemon::JobFilter& filter) {
    std::map<spool::JobId, JobPhase> live;
    for (const LinePtr& line : lines()) {
        for (const Line::Active& job : line->on_line()) {
            live[job.job] = job.phase;
        }
    }
    return access_.read([&](spool::Spool& spool) -> Result<std::vector<JobView>> {
        daemon::JobViews job_views{spool};
        std::vector<JobView> views;
        auto before = filter.after == spool::JobId{} ? std::nullopt : std::optional{filter.after};
        while (true) {
            auto some = spool.newest_jobs(before, jobs_at_once);
            if (!some) {
                return some.error();
            }
            for (spool::Job& job : *some) {
                before = job.id;
                const auto facts = read_facts(spool, std::move(job));
                if (!facts) {
                    return facts.error();
                }
                const auto at = live.find(facts->job.id);
                const bool begun = facts->ticket && facts->ticket->begun; // perhaps since we looked at the lines
                const auto phase = at != live.end() ? std::optional{at->second}
                                   : begun          ? live_phase(facts->job.id)
                                                    : std::nullopt;
                auto view = job_views.view(*facts, phase);
                if (!view) {
                    return view.error();
                }
                if (wanted(filter, *view)) {
                    views.push_back(std::move(*view));
                }
                if (views.size() == std::max<std::size_t>(filter.limit, 1)) {
                    return views;
                }
            }
            if (some->size() < jobs_at_once) {
                return views;
            }
        }
    });
}

Result<std::optional<JobView>> Service::job(spool::JobId id) {
    const auto live = live_phase(id);
    return access_.read([&](spool::Spool& spool) -> Result<std::optional<JobView>> {
        auto job = spool.job(id);
        if (!job) {
            return job.error();
        }
        if (!*job) {
            return std::optional<JobView>{};
        }
        const auto facts = read_facts(spool, std::move(**job));
        if (!facts) {
            return facts.error();
        }
        daemon::JobViews job_views{spool};
        auto view = job_views.view(*facts, live ? live : live_phase(id)); // it may have been started in between
        return view ? Result<std::optional<JobView>>{std::move(*view)} : view.error();
    });
}

Result<daemon::DoubtView> Service::doubt(spool::JobId id) {
    return access_.read([&](spool::Spool& spool) -> Result<daemon::DoubtView> {
        const auto facts = read_facts(spool, id);
        if (!facts) {
            return facts.error();
        }
        const auto as_of = spool.last_ledger_row(id); // first: what comes in between is overtaken
        if (!as_of) {
            return as_of.error();
        }
        const auto evidence = daemon::doubt_evidence(spool, facts->job);
        if (!evidence) {
            return evidence.error();
        }
        daemon::DoubtView view;
        view.hole = evidence->hole;
        view.as_of = *as_of;
        for (const RecordRange& range : evidence->ranges) {
            view.count += range.count();
        }
        auto shown = daemon::records_of(spool, facts->job, evidence->ranges, most_doubtful);
        if (!shown) {
            return shown.error();
        }
        view.records = std::move(*shown);
        return view;
    });
}

Result<std::vector<daemon::DoubtView::Record>> Service::records(spool::JobId id, RecordRange records) {
    return access_.read([&](spool::Spool& spool) -> Result<std::vector<daemon::DoubtView::Record>> {
        const auto facts = read_facts(spool, id);
        if (!facts) {
            return facts.error();
        }
        return daemon::records_of(spool, facts->job, {&records, 1}, most_records);
    });
}

Result<std::vector<spool::HistoryStretch>> Service::history(spool::JobId id, RecordRange records) {
    return access_.read([&](spool::Spool& spool) -> Result<std::vector<spool::HistoryStretch>> {
        if (const auto facts = read_facts(spool, id); !facts) {
            return facts.error();
        }
        spool::LedgerHistory history;
        for (std::int64_t after = 0;;) {
            const auto rows = spool.ledger_rows(id, after, rows_at_once);
            if (!rows) {
                return rows.error();
            }
            for (const spool::LedgerRow& row : *rows) {
                history.add(row);
                after = row.sequence;
            }
            if (rows->size() < rows_at_once) {
                break;
            }
        }
        std::vector<spool::HistoryStretch> found;
        for (spool::HistoryStretch& stretch : history.stretches()) {
            const bool within =
                !records.empty() && stretch.range.first() <= records.last() && records.first() <= stretch.range.last();
            if (within && found.size() < most_stretches) {
                stretch.range = RecordRange::closed(std::max(stretch.range.first(), records.first()),
                                                    std::min(stretch.range.last(), records.last()));
                found.push_back(std::move(stretch));
            }
        }
        return found;
    });
}

Result<std::vector<spool::LedgerRow>> Service::ledger(spool::JobId id, std::int64_t after, std::size_t limit) {
    return access_.read([&](spool::Spool& spool) -> Result<std::vector<spool::LedgerRow>> {
        if (const auto facts = read_facts(spool, id); !facts) {
            return facts.error();
        }
        return spool.ledger_rows(id, after, limit);
    });
}

Result<std::int64_t> Service::verify_ledger() {
    return access_.read([](spool::Spool& spool) { return spool.verify_ledger(); });
}

} // namespace linefeed::service
