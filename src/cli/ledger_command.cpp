#include "cli/ledger_command.hpp"

#include "cli/print_report.hpp"
#include "cli/progress_view.hpp"
#include "daemon/record_text.hpp"
#include "cli/wall_time.hpp"
#include "spool/ledger_history.hpp"
#include "spool/spool.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iostream>

namespace linefeed::cli {

namespace {

using Json = nlohmann::ordered_json;
using spool::RecordState;

std::string dump(const Json& json, int indent) {
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

constexpr std::array issued_states{RecordState::printed,  RecordState::in_doubt, RecordState::skipped,
                                   RecordState::released, RecordState::unused,   RecordState::open};

std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) {
        return text;
    }
    std::string quoted = "\"";
    for (const char c : text) {
        quoted += c == '"' ? "\"\"" : std::string(1, c);
    }
    return quoted + '"';
}

/// Reads pages one after the other, each once.
class RecordTexts {
public:
    RecordTexts(spool::Spool& spool, const spool::Job& job)
        : spool_(spool)
        , job_(job)
        , format_(daemon::record_format(job)) {}

    Result<std::vector<std::string>> fields(RecordNumber number) {
        if (!page_ || !page_->range().contains(number)) {
            auto page = spool_.read_page(job_.id, number);
            if (!page) {
                return page.error();
            }
            page_ = std::move(*page);
        }
        return daemon::record_fields(*page_, number, format_);
    }

private:
    spool::Spool& spool_;
    const spool::Job& job_;
    daemon::RecordFormat format_;
    std::optional<RecordPage> page_;
};

Result<std::vector<spool::HistoryStretch>> history(spool::Spool& spool, spool::JobId job) {
    constexpr std::size_t rows_at_once = 4096;
    spool::LedgerHistory history;
    for (std::int64_t after = 0;;) {
        const auto rows = spool.ledger_rows(job, after, rows_at_once);
        if (!rows) {
            return rows.error();
        }
        for (const spool::LedgerRow& row : *rows) {
            history.add(row);
            after = row.sequence;
        }
        if (rows->size() < rows_at_once) {
            return history.stretches();
        }
    }
}

Json evidence_json(const std::string& evidence) {
    const Json json = Json::parse(evidence, nullptr, false);
    return json.is_discarded() ? Json(nullptr) : json;
}

Json record_json(RecordNumber number, const std::vector<std::string>& fields, const spool::HistoryStretch& stretch) {
    return {{"number", number.value()},
            {"fields", fields},
            {"state", to_string(stretch.state)},
            {"not_before", format_wall_time(stretch.from_ns)},
            {"not_after", format_wall_time(stretch.to_ns)},
            {"run", static_cast<std::int64_t>(stretch.run)},
            {"evidence", evidence_json(stretch.evidence)}};
}

/// One row per issued record of `wanted`: CSV or JSON lines for programs, a table for people.
Result<void> show_records(spool::Spool& spool, const spool::Job& job, RecordRange wanted, const std::string& format) {
    const auto stretches = history(spool, job.id);
    if (!stretches) {
        return stretches.error();
    }
    RecordTexts texts{spool, job};
    if (format == "csv") {
        std::cout << "number,fields,state,not_before,not_after,run,evidence\r\n";
    }
    for (const spool::HistoryStretch& stretch : *stretches) {
        const RecordRange shown = RecordRange::closed(std::max(stretch.range.first(), wanted.first()),
                                                      std::min(stretch.range.last(), wanted.last()));
        for (std::uint64_t i = 0; i < shown.count().value(); ++i) {
            const RecordNumber number = shown.first() + RecordCount{i};
            const auto fields = texts.fields(number);
            if (!fields) {
                return fields.error();
            }
            const std::string text = daemon::joined(*fields, "\t");
            if (format == "json") {
                std::cout << dump(record_json(number, *fields, stretch), -1) << '\n';
            } else if (format == "csv") {
                std::cout << number << ',' << csv_field(text) << ',' << to_string(stretch.state) << ','
                          << format_wall_time(stretch.from_ns) << ',' << format_wall_time(stretch.to_ns) << ','
                          << static_cast<std::int64_t>(stretch.run) << ',' << csv_field(stretch.evidence) << "\r\n";
            } else {
                std::cout << number << "  " << to_string(stretch.state) << "  " << format_wall_time(stretch.to_ns)
                          << "  run " << static_cast<std::int64_t>(stretch.run) << "  " << printable(text) << "  "
                          << printable(stretch.evidence) << '\n';
            }
        }
    }
    std::cout.flush();
    return {};
}

Json counts_json(const spool::LedgerState& state) {
    Json counts = Json::object();
    for (const RecordState kind : issued_states) {
        counts[std::string{to_string(kind)}] = state.count(kind).value();
    }
    return counts;
}

void show_summary(const spool::Job& job, const spool::LedgerState& state, bool json) {
    if (json) {
        Json segments = Json::array();
        for (const spool::LedgerSegment& segment : state.segments()) {
            segments.push_back({{"first", segment.range.first().value()},
                                {"last", segment.range.last().value()},
                                {"state", to_string(segment.state)},
                                {"run", static_cast<std::int64_t>(segment.run)}});
        }
        std::cout << dump({{"job", static_cast<std::int64_t>(job.id)},
                           {"file", job.spec.source.path},
                           {"first", job.records.first().value()},
                           {"last", job.records.last().value()},
                           {"counts", counts_json(state)},
                           {"segments", segments}},
                          2)
                  << std::endl;
        return;
    }
    std::cout << "job " << static_cast<std::int64_t>(job.id) << ", " << printable(job.spec.source.path) << ", records "
              << job.records << '\n';
    RecordCount issued;
    std::string sum;
    for (const RecordState kind : issued_states) {
        const RecordCount count = state.count(kind);
        issued += count;
        sum += (sum.empty() ? "" : " + ") + std::to_string(count.value()) + ' ' + std::string{to_string(kind)};
    }
    std::cout << "issued " << issued << " = " << sum << '\n';
    for (const spool::LedgerSegment& segment : state.segments()) {
        std::cout << "  " << segment.range << "  " << to_string(segment.state) << "  (run "
                  << static_cast<std::int64_t>(segment.run) << ")\n";
    }
    if (const std::vector<RecordRange> doubt = state.ranges(RecordState::in_doubt); !doubt.empty()) {
        std::cout << "waiting for an operator: " << doubt.front() << (doubt.size() > 1 ? " and more" : "")
                  << " (linefeed print --last-printed, --printed or --in-doubt)" << std::endl;
        return;
    }
    const RecordRange next = state.next_printable(job.records);
    std::cout << (next.empty() ? std::string{"nothing left to print"}
                               : "next to print: " + std::to_string(next.first().value()))
              << std::endl;
}

Result<ExitCode> ledger(const LedgerOptions& options) {
    auto spool = spool::Spool::open_for_reading(options.spool, {});
    if (!spool) {
        return spool.error();
    }
    const auto job = spool->job(spool::JobId{options.job});
    if (!job) {
        return job.error();
    }
    if (!*job) {
        return Failure{FailureKind::usage, "there is no job " + std::to_string(options.job) + " in " +
                                               options.spool.string() + ": see linefeed jobs"};
    }
    if (options.verify) {
        const auto rows = spool->verify_ledger();
        if (!rows) {
            return rows.error();
        }
        std::cout << "the print ledger is whole: " << *rows << " rows, every hash right" << std::endl;
        return ExitCode::done;
    }
    if (options.records || !options.export_format.empty()) {
        const auto shown = show_records(*spool, **job, options.records.value_or((*job)->records),
                                        !options.export_format.empty() ? options.export_format
                                        : options.json                 ? "json"
                                                                       : "");
        if (!shown) {
            return shown.error();
        }
        return ExitCode::done;
    }
    const auto state = spool->ledger_state((*job)->id);
    if (!state) {
        return state.error();
    }
    show_summary(**job, *state, options.json);
    return ExitCode::done;
}

Result<ExitCode> jobs(const JobsOptions& options) {
    auto spool = spool::Spool::open_for_reading(options.spool, {});
    if (!spool) {
        return spool.error();
    }
    const auto jobs = spool->jobs();
    if (!jobs) {
        return jobs.error();
    }
    Json all = Json::array();
    for (const spool::Job& job : *jobs) {
        const auto state = spool->ledger_state(job.id);
        if (!state) {
            return state.error();
        }
        const std::uint64_t printed = state->count(RecordState::printed).value();
        if (options.json) {
            all.push_back(Json{{"job", static_cast<std::int64_t>(job.id)},
                               {"file", job.spec.source.path},
                               {"first", job.records.first().value()},
                               {"last", job.records.last().value()},
                               {"created", format_wall_time(job.created_ns)},
                               {"counts", counts_json(*state)}});
            continue;
        }
        std::cout << "job " << static_cast<std::int64_t>(job.id) << "  " << format_wall_time(job.created_ns)
                  << "  records " << job.records << "  printed " << printed << " of " << job.records.count();
        for (const RecordState kind : {RecordState::in_doubt, RecordState::open}) {
            if (const auto count = state->count(kind); count > RecordCount{0}) {
                std::cout << ", " << count << ' ' << to_string(kind);
            }
        }
        std::cout << "  " << printable(job.spec.source.path) << '\n';
    }
    if (options.json) {
        std::cout << dump(all, 2) << '\n';
    }
    std::cout.flush();
    return ExitCode::done;
}

ExitCode finish(const Result<ExitCode>& result, bool json) {
    if (result) {
        return *result;
    }
    show_failure(result.error(), json);
    return exit_code(result.error().kind);
}

} // namespace

ExitCode run_jobs(const JobsOptions& options) {
    return finish(jobs(options), options.json);
}

ExitCode run_ledger(const LedgerOptions& options) {
    return finish(ledger(options), options.json);
}

} // namespace linefeed::cli
