#include "api/views.hpp"
#include "client/job_source.hpp"
#include "client/json_fields.hpp"
#include "daemon/record_text.hpp"
#include "spool/ledger_history.hpp"
#include "spool/spool.hpp"

#include <algorithm>

namespace linefeed::client {

namespace {

using daemon::JobPhase;
using spool::RecordState;

constexpr std::size_t rows_at_once = 4096;

/// Where a job stands that no service looks after.
JobPhase phase_of(const spool::Job& job, const spool::LedgerState& state) {
    if (job.state == spool::ImportState::importing) {
        return JobPhase::importing;
    }
    if (state.count(RecordState::in_doubt) > RecordCount{0}) {
        return JobPhase::in_doubt;
    }
    if (state.segments().empty()) {
        return JobPhase::ready;
    }
    const bool over = state.next_printable(job.records).empty() && state.count(RecordState::open) == RecordCount{0};
    return over && job.state == spool::ImportState::ready ? JobPhase::finished : JobPhase::stopped;
}

Json view_of(const spool::Job& job, const spool::LedgerState& state) {
    daemon::JobView view;
    view.id = job.id;
    view.source = job.spec.source.path;
    view.name = std::filesystem::path{view.source}.filename().string();
    view.phase = phase_of(job, state);
    if (job.state == spool::ImportState::stopped) {
        view.message = "a row that cannot be printed has ended its import";
    } else if (state.count(RecordState::open) > RecordCount{0}) {
        view.message = "being printed, or broken off: linefeed print asks the printer how far it is";
    }
    view.records = job.records;
    view.printed = state.count(RecordState::printed);
    view.in_doubt = state.count(RecordState::in_doubt);
    view.open = state.count(RecordState::open);
    view.skipped = state.count(RecordState::skipped);
    if (const auto printed = state.ranges(RecordState::printed); !printed.empty()) {
        view.last_printed = printed.back().last();
    }
    view.next = state.next_printable(job.records);
    view.created_ns = job.created_ns;
    view.created_by = "linefeed";
    return api::to_json(view);
}

class SpoolSource final : public JobSource {
public:
    explicit SpoolSource(spool::Spool spool, std::filesystem::path file)
        : spool_(std::move(spool))
        , file_(std::move(file)) {}

    Result<std::vector<Json>> jobs(const JobQuery& query) override;
    Result<Json> job(std::int64_t id) override;
    Result<std::vector<Json>> history(std::int64_t id, std::optional<RecordRange> records) override;
    Result<void> records(std::int64_t id, RecordRange records,
                         const std::function<bool(const Json&)>& on_record) override;
    Result<std::int64_t> verify() override { return spool_.verify_ledger(); }

private:
    Result<spool::Job> find(std::int64_t id);
    Result<Json> view(const spool::Job& job);

    spool::Spool spool_;
    std::filesystem::path file_;
};

Result<spool::Job> SpoolSource::find(std::int64_t id) {
    auto job = spool_.job(spool::JobId{id});
    if (!job) {
        return job.error();
    }
    if (!*job) {
        return Failure{FailureKind::usage,
                       "there is no job " + std::to_string(id) + " in " + file_.string() + ": see linefeed jobs"};
    }
    return std::move(**job);
}

Result<Json> SpoolSource::view(const spool::Job& job) {
    const auto state = spool_.ledger_state(job.id);
    if (!state) {
        return state.error();
    }
    return json_result(view_of(job, *state));
}

Result<std::vector<Json>> SpoolSource::jobs(const JobQuery& query) {
    auto jobs = spool_.jobs();
    if (!jobs) {
        return jobs.error();
    }
    std::reverse(jobs->begin(), jobs->end());
    std::vector<Json> views;
    for (const spool::Job& job : *jobs) {
        auto json = view(job);
        if (!json) {
            return json.error();
        }
        const bool wanted = query.phases.empty() || std::find(query.phases.begin(), query.phases.end(),
                                                              text(*json, "phase")) != query.phases.end();
        if (wanted && (query.printer.empty() || text(*json, "printer") == query.printer)) {
            views.push_back(std::move(*json));
        }
        if (views.size() == query.limit) {
            break;
        }
    }
    return views;
}

Result<Json> SpoolSource::job(std::int64_t id) {
    const auto job = find(id);
    if (!job) {
        return job.error();
    }
    return view(*job);
}

Result<std::vector<Json>> SpoolSource::history(std::int64_t id, std::optional<RecordRange> records) {
    spool::LedgerHistory history;
    for (std::int64_t after = 0;;) {
        const auto rows = spool_.ledger_rows(spool::JobId{id}, after, rows_at_once);
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
    std::vector<Json> stretches;
    for (spool::HistoryStretch stretch : history.stretches()) {
        if (records) {
            stretch.range = RecordRange::closed(std::max(stretch.range.first(), records->first()),
                                                std::min(stretch.range.last(), records->last()));
        }
        if (!stretch.range.empty()) {
            stretches.push_back(api::to_json(stretch));
        }
    }
    return stretches;
}

Result<void> SpoolSource::records(std::int64_t id, RecordRange records,
                                  const std::function<bool(const Json&)>& on_record) {
    const auto job = find(id);
    if (!job) {
        return job.error();
    }
    const daemon::RecordFormat format = daemon::record_format(*job);
    std::optional<RecordPage> page;
    for (std::uint64_t i = 0; i < records.count().value(); ++i) {
        const RecordNumber number = records.first() + RecordCount{i};
        if (!page || !page->range().contains(number)) {
            auto read = spool_.read_page(job->id, number);
            if (!read) {
                return read.error();
            }
            page = std::move(*read);
        }
        if (!on_record({{"number", number.value()}, {"fields", daemon::record_fields(*page, number, format)}})) {
            break;
        }
    }
    return {};
}

} // namespace

Result<std::unique_ptr<JobSource>> spool_source(const std::filesystem::path& file) {
    auto spool = spool::Spool::open_for_reading(file, {});
    if (!spool) {
        return spool.error();
    }
    return std::make_unique<SpoolSource>(std::move(*spool), file);
}

} // namespace linefeed::client
