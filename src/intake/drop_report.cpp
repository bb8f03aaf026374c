#include "intake/drop_report.hpp"

#include "base/assert.hpp"
#include "spool/json_text.hpp"

namespace linefeed::intake {

std::string_view to_string(DropVerdict verdict) {
    switch (verdict) {
    case DropVerdict::imported:
        return "imported";
    case DropVerdict::duplicate:
        return "duplicate";
    case DropVerdict::failed:
        return "failed";
    }
    assertion_failed("DropVerdict", __FILE__, __LINE__);
}

std::string to_json(const DropReport& report) {
    const std::string null = "null";
    const bool any = !report.records.empty();
    return spool::JsonObject{}
        .add("name", report.name)
        .add("verdict", to_string(report.verdict))
        .add("reason", report.reason)
        .add("kept_as", report.kept_as)
        .add("bytes", report.size_bytes)
        .add("sha256", report.sha256)
        .add_json("job", report.job ? std::to_string(static_cast<std::int64_t>(*report.job)) : null)
        .add("records", report.records.count().value())
        .add_json("first", any ? std::to_string(report.records.first().value()) : null)
        .add_json("last", any ? std::to_string(report.records.last().value()) : null)
        .add_json("import", report.import ? to_json(*report.import) : null)
        .text();
}

std::string describe_bad_rows(const ImportReport& report) {
    if (report.bad_rows == 0) {
        return {};
    }
    std::string text =
        std::to_string(report.bad_rows) + " of " + std::to_string(report.rows) + " rows cannot be printed";
    if (!report.reported.empty()) {
        const BadRow& first = report.reported.front();
        text += "; the first: line " + std::to_string(first.line) +
                (first.column.empty() ? "" : ", column " + first.column) + ": " + first.reason;
    }
    return text;
}

} // namespace linefeed::intake
