#include "intake/import.hpp"

#include "spool/json_text.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>

namespace linefeed::intake {

namespace {

/// A page is full when it has one of these.
constexpr std::size_t page_records = 512;
constexpr std::size_t page_bytes = std::size_t{64} * 1024;
/// How many rows lie between two calls of on_progress.
constexpr std::uint64_t progress_rows = 4096;

/// One import in progress.
class Import {
public:
    Import(RowSource& source, spool::Spool& spool, const spool::JobSpec& spec, const ImportOptions& options)
        : source_(source)
        , spool_(spool)
        , spec_(spec)
        , options_(options)
        , encoder_(options.charsets, options.escapes, options.properties) {
        report_.columns = source.column_names();
        report_.charsets = options.charsets;
        report_.charsets.resize(report_.columns.size(), options.charsets.front());
    }

    [[nodiscard]] Result<ImportOutcome> run();

private:
    [[nodiscard]] Result<void> take(const Row& row);
    void report_bad(std::uint64_t line, std::string column, std::string reason);
    [[nodiscard]] Result<void> flush_page();
    [[nodiscard]] Result<ImportOutcome> finish();
    /// Bad rows were found and must not be: nothing is stored any more, the rows are only checked.
    [[nodiscard]] bool refused() const { return report_.bad_rows > 0 && !options_.skip_bad; }

    RowSource& source_;
    spool::Spool& spool_;
    const spool::JobSpec& spec_;
    const ImportOptions& options_;
    protocol::MailRecordEncoder encoder_;
    std::optional<spool::JobImport> job_;
    RecordPage page_;
    std::uint64_t encoded_ = 0; ///< records, stored or not
    ImportReport report_;
};

void Import::report_bad(std::uint64_t line, std::string column, std::string reason) {
    ++report_.bad_rows;
    if (report_.reported.size() < max_reported_rows) {
        report_.reported.push_back({line, std::move(column), std::move(reason)});
    }
    if (refused()) {
        job_.reset(); // removes what was stored
        report_.records = 0;
    }
}

Result<void> Import::take(const Row& row) {
    ++report_.rows;
    if (!row.problem.empty()) {
        report_bad(row.line, row.problem_column, row.problem);
        return {};
    }
    if (spec_.base.value() + encoded_ >= RecordNumber::max().value()) {
        return Failure{FailureKind::input, "row " + std::to_string(report_.rows) +
                                               " has no number any more: record numbers end at 4294967295"};
    }
    const RecordNumber number = spec_.base + RecordCount{encoded_ + 1};
    if (page_.ends.empty()) {
        page_.first = number;
    }
    if (const auto appended = encoder_.append(page_.frames, number, row.fields); !appended) {
        const auto& error = appended.error();
        const auto& names = source_.column_names();
        const bool has_field = error.field > 0 && error.field <= names.size();
        report_bad(row.line, has_field ? names[error.field - 1] : "", protocol::describe(error));
        return {};
    }
    ++encoded_;
    report_.rows_with_empty_field += std::ranges::any_of(row.fields, &std::string_view::empty) ? 1U : 0U;
    page_.ends.push_back(static_cast<std::uint32_t>(page_.frames.size()));
    if (page_.ends.size() >= page_records || page_.frames.size() >= page_bytes) {
        return flush_page();
    }
    return {};
}

Result<void> Import::flush_page() {
    if (!refused() && !page_.ends.empty()) {
        if (auto added = job_->add(page_); !added) {
            return added;
        }
        report_.records += page_.ends.size();
    }
    page_.ends.clear();
    page_.frames.clear();
    return {};
}

/// A file that grew or was replaced while it was read gives a job that is neither the old nor the new one.
Result<void> check_unchanged(const spool::SourceFingerprint& before) {
    std::error_code error;
    if (before.path.empty() || !std::filesystem::exists(before.path, error)) {
        return {}; // not a file, or removed: what was opened was read to its end
    }
    const auto now = fingerprint(before.path);
    if (!now) {
        return now.error();
    }
    if (*now != before) {
        return Failure{FailureKind::input,
                       before.path + ": the file was changed while it was read: try again when it is complete"};
    }
    return {};
}

Result<ImportOutcome> Import::finish() {
    if (auto flushed = flush_page(); !flushed) {
        return flushed.error();
    }
    if (report_.rows == 0) {
        return Failure{FailureKind::input, "the source has no rows"};
    }
    if (auto unchanged = check_unchanged(spec_.source); !unchanged) {
        return unchanged.error();
    }
    if (refused() || report_.records == 0) {
        return ImportOutcome{std::move(report_), std::nullopt};
    }
    auto job = job_->commit(to_json(report_));
    if (!job) {
        return job.error();
    }
    return ImportOutcome{std::move(report_), std::move(*job)};
}

Result<ImportOutcome> Import::run() {
    if (options_.charsets.size() != 1 && options_.charsets.size() != source_.column_names().size()) {
        return Failure{FailureKind::usage, std::to_string(options_.charsets.size()) + " charsets for " +
                                               std::to_string(source_.column_names().size()) +
                                               " columns: give one for all, or one for each"};
    }
    auto job = spool_.begin_import(spec_);
    if (!job) {
        return job.error();
    }
    job_ = std::move(*job);
    Row row;
    while (true) {
        const auto more = source_.next(row);
        if (!more) {
            return more.error();
        }
        if (!*more) {
            return finish();
        }
        if (auto taken = take(row); !taken) {
            return taken.error();
        }
        const bool tell = options_.on_progress && report_.rows % progress_rows == 0;
        if (tell && !options_.on_progress(report_, source_.progress())) {
            return Failure{FailureKind::stopped, "the import was cancelled"};
        }
    }
}

} // namespace

Result<ImportOutcome> import_source(RowSource& source, spool::Spool& spool, const spool::JobSpec& spec,
                                    const ImportOptions& options) {
    if (options.charsets.empty()) {
        return Failure{FailureKind::usage, "a charset is needed"};
    }
    return Import{source, spool, spec, options}.run();
}

std::string to_json(const ImportReport& report) {
    using spool::JsonObject;
    std::vector<std::string> columns;
    for (std::size_t i = 0; i < report.columns.size(); ++i) {
        columns.push_back(JsonObject{}
                              .add("encoding", protocol::to_string(report.charsets[i]))
                              .add("name", report.columns[i])
                              .text());
    }
    std::vector<std::string> reported;
    for (const BadRow& row : report.reported) {
        reported.push_back(
            JsonObject{}.add("column", row.column).add("line", row.line).add("reason", row.reason).text());
    }
    return JsonObject{}
        .add("bad_rows", report.bad_rows)
        .add_json("columns", spool::json_array(columns))
        .add("records", report.records)
        .add_json("reported", spool::json_array(reported))
        .add("rows", report.rows)
        .text();
}

} // namespace linefeed::intake
