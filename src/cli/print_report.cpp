#include "cli/print_report.hpp"

#include "cli/progress_view.hpp"
#include "daemon/doubt_evidence.hpp"
#include "daemon/record_text.hpp"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <iostream>

namespace linefeed::cli {

namespace {

using Json = nlohmann::ordered_json;

std::string dump(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string_view name_of(spool::ImportState state) {
    switch (state) {
    case spool::ImportState::importing:
        return "broken_off";
    case spool::ImportState::stopped:
        return "stopped_at_bad_row";
    case spool::ImportState::ready:
        return "complete";
    }
    assertion_failed("ImportState", __FILE__, __LINE__);
}

void show_row(const std::string& file, const intake::BadRow& row) {
    const std::string column = row.column.empty() ? "" : ", column " + printable(row.column);
    std::fprintf(stderr, "linefeed: %s: line %llu%s: %s\n", printable(file).c_str(),
                 static_cast<unsigned long long>(row.line), column.c_str(), printable(row.reason).c_str());
}

Json rows_json(const std::vector<intake::BadRow>& rows) {
    Json json = Json::array();
    for (const intake::BadRow& row : rows) {
        json.push_back({{"line", row.line}, {"column", row.column}, {"reason", row.reason}});
    }
    return json;
}

Json range_json(const RecordRange& range) {
    return range.empty() ? Json(nullptr) : Json{{"first", range.first().value()}, {"last", range.last().value()}};
}

} // namespace

Result<PrintReport> make_report(spool::Spool& spool, const spool::Job& job, RecordRange wanted,
                                const feeder::Outcome& outcome, const std::string& detail) {
    const daemon::RecordFormat format = daemon::record_format(job);
    const auto state = spool.ledger_state(job.id);
    if (!state) {
        return state.error();
    }
    PrintReport report;
    report.job = job;
    report.wanted = wanted;
    report.result = to_string(outcome.code);
    report.message = feeder::describe(outcome) + (detail.empty() ? "" : ": " + detail);
    report.code = exit_code(outcome);
    for (const RecordRange& range : state->ranges(spool::RecordState::printed)) {
        const RecordRange within =
            RecordRange::closed(std::max(range.first(), wanted.first()), std::min(range.last(), wanted.last()));
        report.printed += within.count();
        if (!within.empty()) {
            report.last_printed = within.last();
        }
    }
    report.next = state->next_printable(wanted);
    report.open = state->count(spool::RecordState::open);
    report.in_doubt = state->count(spool::RecordState::in_doubt);
    for (const RecordRange& range : state->ranges(spool::RecordState::in_doubt)) {
        for (RecordNumber number = range.first(); report.doubtful.size() < max_doubtful_shown; number = number.next()) {
            const auto page = spool.read_page(job.id, number);
            if (!page) {
                return page.error();
            }
            report.doubtful.push_back({number, daemon::record_fields(*page, number, format)});
            if (number == range.last()) {
                break;
            }
        }
    }
    if (report.in_doubt > RecordCount{0}) {
        report.code = ExitCode::in_doubt;
        const auto doubt = daemon::doubt_evidence(spool, job);
        if (!doubt) {
            return doubt.error();
        }
        report.doubt_hole = doubt->hole;
    }
    return report;
}

namespace {

void show_json(const PrintReport& report) {
    Json doubtful = Json::array();
    for (const DoubtfulRecord& record : report.doubtful) {
        doubtful.push_back({{"number", record.number.value()}, {"fields", record.fields}});
    }
    const Json json{{"result", report.result},
                    {"message", report.message},
                    {"exit_code", static_cast<int>(report.code)},
                    {"job", static_cast<std::int64_t>(report.job.id)},
                    {"file", report.job.spec.source.path},
                    {"records", range_json(report.job.records)},
                    {"import", name_of(report.job.state)},
                    {"wanted", range_json(report.wanted)},
                    {"printed", report.printed.value()},
                    {"last_printed", report.last_printed ? Json(report.last_printed->value()) : Json(nullptr)},
                    {"next", report.next.empty() ? Json(nullptr) : Json(report.next.first().value())},
                    {"issued_unknown", report.open.value()},
                    {"in_doubt", report.in_doubt.value()},
                    {"in_doubt_records", doubtful},
                    {"in_doubt_hole", report.doubt_hole.empty() ? Json(nullptr) : Json(report.doubt_hole)},
                    {"bad_rows", rows_json(report.bad_rows)}};
    std::cout << dump(json) << std::endl;
}

} // namespace

void show_doubtful(const PrintReport& report) {
    for (const DoubtfulRecord& record : report.doubtful) {
        std::cout << "in doubt: " << record.number << "  " << printable(daemon::joined(record.fields, " | ")) << '\n';
    }
    if (report.in_doubt.value() > report.doubtful.size()) {
        std::cout << "in doubt: " << report.in_doubt.value() - report.doubtful.size() << " more, see linefeed ledger "
                  << static_cast<std::int64_t>(report.job.id) << '\n';
    }
    std::cout.flush();
}

void show_report(const PrintReport& report, bool json) {
    if (report.code != ExitCode::done) {
        std::fprintf(stderr, "linefeed: %s\n", printable(report.message).c_str());
    }
    if (json) {
        show_json(report);
        return;
    }
    std::cout << "job " << static_cast<std::int64_t>(report.job.id) << ": printed " << report.printed << " of "
              << report.wanted.count() << " records (" << report.wanted << ")"
              << (report.job.state == spool::ImportState::importing ? " that are read so far" : "");
    if (report.last_printed) {
        std::cout << ", last printed " << *report.last_printed;
    }
    std::cout << '\n';
    show_doubtful(report);
    if (!report.doubt_hole.empty()) {
        std::cout << "the last product does not tell which of them are printed: " << report.doubt_hole
                  << "\nto go on: look which of these records are on products, and start again with --printed N-M,N "
                     "(or none); or with --in-doubt skip or reprint\n";
    } else if (report.in_doubt > RecordCount{0}) {
        std::cout << "to go on: look at the last product, and start again with --last-printed NUMBER (or its text); "
                     "or with --in-doubt skip or reprint\n";
    } else if (report.open > RecordCount{0}) {
        std::cout << "to go on: the same command again asks the printer how far the " << report.open
                  << " records were printed that may be in it, and continues there\n";
    } else if (report.code == ExitCode::input_rejected) {
        std::cout
            << "to go on: mend the file behind record " << report.job.records.last()
            << ", and the same command again continues there; or print it from its first record as a new job with "
               "--new-job\n";
    } else if (report.next.empty() && report.job.state == spool::ImportState::importing) {
        std::cout << "to go on: the same command again reads the file on\n";
    } else if (!report.next.empty()) {
        std::cout << "to go on: the same command again continues with record " << report.next.first() << '\n';
    }
    std::cout.flush();
}

void reject(PrintReport& report, const Failure& failure) {
    report.code = exit_code(failure.kind);
    report.result = report.code == ExitCode::input_rejected ? "input_rejected" : to_string(failure.kind);
    report.message = failure.message;
}

void reject(PrintReport& report, const intake::ImportReport& rows, const std::string& file) {
    report.bad_rows = rows.reported;
    std::string count = std::to_string(rows.bad_rows) + " of " + std::to_string(rows.rows) + " rows";
    if (rows.bad_rows == 0) { // the job knows the first of them
        const Json known = Json::parse(report.job.import_report, nullptr, false);
        for (const Json& row : known.is_object() ? known.value("reported", Json::array()) : Json::array()) {
            report.bad_rows.push_back({row.value("line", std::uint64_t{0}), row.value("column", std::string{}),
                                       row.value("reason", std::string{})});
        }
        count = "the next row";
    }
    for (const intake::BadRow& row : report.bad_rows) {
        show_row(file, row);
    }
    reject(report, Failure{FailureKind::input, "the line has stopped behind record " +
                                                   std::to_string(report.job.records.last().value()) + ": " + count +
                                                   " of " + file + " cannot be printed"});
}

void show_bad_rows(const intake::ImportReport& report, const std::string& file, bool refused,
                   const spool::Job* unfinished, bool json) {
    for (const intake::BadRow& row : report.reported) {
        show_row(file, row);
    }
    if (report.bad_rows > report.reported.size()) {
        std::fprintf(stderr, "linefeed: %s: and %llu more bad rows\n", printable(file).c_str(),
                     static_cast<unsigned long long>(report.bad_rows - report.reported.size()));
    }
    if (!refused) {
        std::fprintf(stderr, "linefeed: left out %llu bad rows of %llu (--skip-bad)\n",
                     static_cast<unsigned long long>(report.bad_rows), static_cast<unsigned long long>(report.rows));
        return;
    }
    const auto bad = static_cast<unsigned long long>(report.bad_rows);
    const auto all = static_cast<unsigned long long>(report.rows);
    if (unfinished != nullptr) {
        std::fprintf(stderr,
                     "linefeed: nothing more is printed: %llu of %llu rows cannot be printed; mend them, and the same "
                     "command goes on with job %lld\n",
                     bad, all, static_cast<long long>(unfinished->id));
    } else {
        std::fprintf(stderr,
                     "linefeed: nothing is imported: %llu of %llu rows cannot be printed; mend them, or leave them out "
                     "with --skip-bad\n",
                     bad, all);
    }
    if (json) {
        Json result{{"result", "input_rejected"}, {"exit_code", static_cast<int>(ExitCode::input_rejected)}};
        result["import"] = Json::parse(intake::to_json(report));
        std::cout << dump(result) << std::endl;
    }
}

void show_failure(const Failure& failure, bool json) {
    std::fprintf(stderr, "linefeed: %s\n", printable(failure.message).c_str());
    if (json) {
        std::cout << dump({{"result", to_string(failure.kind)},
                           {"message", failure.message},
                           {"exit_code", static_cast<int>(exit_code(failure.kind))}})
                  << std::endl;
    }
}

} // namespace linefeed::cli
