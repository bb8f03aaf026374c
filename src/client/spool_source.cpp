#include "api/views.hpp"
#include "client/job_source.hpp"
#include "client/json_fields.hpp"
#include "daemon/job_facts.hpp"
#include "daemon/record_text.hpp"
#include "spool/ledger_history.hpp"
#include "spool/spool.hpp"

#include <algorithm>

namespace linefeed::client {

namespace {

constexpr std::size_t rows_at_once = 4096;
constexpr std::size_t jobs_at_once = 100;

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
    Result<Json> view(const spool::Job& job, daemon::JobViews& views);

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

Result<Json> SpoolSource::view(const spool::Job& job, daemon::JobViews& views) {
    const auto facts = daemon::read_facts(spool_, job);
    if (!facts) {
        return facts.error();
    }
    auto view = views.view(*facts);
    if (!view) {
        return view.error();
    }
    if (view->open > RecordCount{0} && view->message.empty()) {
        view->message = "being printed now, or broken off";
    }
    return json_result(api::to_json(*view));
}

Result<std::vector<Json>> SpoolSource::jobs(const JobQuery& query) {
    const auto wanted = [&query](const Json& job) {
        const auto phase = std::find(query.phases.begin(), query.phases.end(), text(job, "phase"));
        return (query.phases.empty() || phase != query.phases.end()) &&
               (query.printer.empty() || text(job, "printer") == query.printer);
    };
    daemon::JobViews views{spool_};
    std::vector<Json> found;
    for (std::optional<spool::JobId> before; found.size() < query.limit;) {
        const auto jobs = spool_.newest_jobs(before, jobs_at_once);
        if (!jobs) {
            return jobs.error();
        }
        for (const spool::Job& job : *jobs) {
            auto json = view(job, views);
            if (!json) {
                return json.error();
            }
            if (wanted(*json) && found.size() < query.limit) {
                found.push_back(std::move(*json));
            }
            before = job.id;
        }
        if (jobs->size() < jobs_at_once) {
            break;
        }
    }
    return found;
}

Result<Json> SpoolSource::job(std::int64_t id) {
    const auto job = find(id);
    if (!job) {
        return job.error();
    }
    daemon::JobViews views{spool_};
    return view(*job, views);
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
