#include "cli/print_report.hpp"

#include "cli/doubt_evidence.hpp"
#include "cli/progress_view.hpp"
#include "cli/record_text.hpp"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <iostream>

namespace linefeed::cli {

namespace {

using Json = nlohmann::ordered_json;

std::string dump(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

Json range_json(const RecordRange& range) {
    return range.empty() ? Json(nullptr) : Json{{"first", range.first().value()}, {"last", range.last().value()}};
}

} // namespace

Result<PrintReport> make_report(spool::Spool& spool, const spool::Job& job, RecordRange wanted,
                                const feeder::Outcome& outcome, const std::string& detail) {
    const RecordFormat format = record_format(job);
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
            report.doubtful.push_back({number, record_fields(*page, number, format)});
            if (number == range.last()) {
                break;
            }
        }
    }
    if (report.in_doubt > RecordCount{0}) {
        report.code = ExitCode::in_doubt;
        const auto doubt = doubt_evidence(spool, job);
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
                    {"wanted", range_json(report.wanted)},
                    {"printed", report.printed.value()},
                    {"last_printed", report.last_printed ? Json(report.last_printed->value()) : Json(nullptr)},
                    {"next", report.next.empty() ? Json(nullptr) : Json(report.next.first().value())},
                    {"issued_unknown", report.open.value()},
                    {"in_doubt", report.in_doubt.value()},
                    {"in_doubt_records", doubtful},
                    {"in_doubt_hole", report.doubt_hole.empty() ? Json(nullptr) : Json(report.doubt_hole)}};
    std::cout << dump(json) << std::endl;
}

} // namespace

void show_doubtful(const PrintReport& report) {
    for (const DoubtfulRecord& record : report.doubtful) {
        std::cout << "in doubt: " << record.number << "  " << printable(joined(record.fields, " | ")) << '\n';
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
              << report.wanted.count() << " records (" << report.wanted << ")";
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
    } else if (!report.next.empty()) {
        std::cout << "to go on: the same command again continues with record " << report.next.first() << '\n';
    }
    std::cout.flush();
}

void show_bad_rows(const intake::ImportReport& report, const std::string& file, bool refused, bool json) {
    for (const intake::BadRow& row : report.reported) {
        const std::string column = row.column.empty() ? "" : ", column " + printable(row.column);
        std::fprintf(stderr, "linefeed: %s: line %llu%s: %s\n", printable(file).c_str(),
                     static_cast<unsigned long long>(row.line), column.c_str(), printable(row.reason).c_str());
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
    std::fprintf(stderr,
                 "linefeed: nothing is imported: %llu of %llu rows cannot be printed; mend them, or leave them out "
                 "with --skip-bad\n",
                 static_cast<unsigned long long>(report.bad_rows), static_cast<unsigned long long>(report.rows));
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
