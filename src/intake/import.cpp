#include "intake/import.hpp"

#include "intake/page_maker.hpp"
#include "spool/json_text.hpp"

#include <filesystem>
#include <optional>
#include <system_error>

namespace linefeed::intake {

namespace {

class SpoolTarget final : public ImportTarget {
public:
    explicit SpoolTarget(spool::Spool& spool)
        : spool_(spool) {}

    [[nodiscard]] Result<void> begin(const spool::JobSpec& spec) override {
        auto job = spool_.begin_import(spec);
        if (!job) {
            return job.error();
        }
        job_ = std::move(*job);
        return {};
    }
    [[nodiscard]] Result<void> add(RecordPage page) override { return job_->add(page); }
    void refuse() override { job_.reset(); }
    [[nodiscard]] Result<spool::Job> commit(std::string import_report) override {
        return job_->commit(std::move(import_report));
    }

private:
    spool::Spool& spool_;
    std::optional<spool::JobImport> job_;
};

/// One import in progress.
class Import {
public:
    Import(RowSource& source, ImportTarget& target, const spool::JobSpec& spec, const ImportOptions& options)
        : target_(target)
        , spec_(spec)
        , check_source_(options.check_source ? options.check_source : [&spec] { return check_unchanged(spec.source); })
        , check_page_(options.check_page)
        , check_records_(options.check_records)
        , pages_(source, spec.base, options) {}

    [[nodiscard]] Result<ImportOutcome> run();

private:
    [[nodiscard]] Result<ImportOutcome> finish();

    ImportTarget& target_;
    const spool::JobSpec& spec_;
    std::function<Result<void>()> check_source_;
    std::function<Result<void>(const RecordPage&)> check_page_;
    std::function<Result<void>()> check_records_;
    PageMaker pages_;
    bool refused_ = false;
};

} // namespace

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

namespace {

Result<ImportOutcome> Import::finish() {
    ImportReport report = pages_.report();
    if (report.rows == 0) {
        return Failure{FailureKind::input, "the source has no rows"};
    }
    if (auto unchanged = check_source_(); !unchanged) {
        return unchanged.error();
    }
    if (refused_) {
        report.records = 0; // stored
    }
    if (report.records == 0) {
        return ImportOutcome{std::move(report), std::nullopt};
    }
    if (auto right = check_records_ ? check_records_() : Result<void>{}; !right) {
        return right.error();
    }
    auto job = target_.commit(to_json(report));
    if (!job) {
        return job.error();
    }
    return ImportOutcome{std::move(report), std::move(*job)};
}

Result<ImportOutcome> Import::run() {
    if (auto begun = target_.begin(spec_); !begun) {
        return begun.error();
    }
    while (true) {
        RecordPage page;
        const auto more = pages_.next(page);
        if (!more) {
            return more.error();
        }
        if (pages_.refused() && !refused_) {
            refused_ = true;
            target_.refuse(); // the rest is only checked
        }
        if (!*more) {
            return finish();
        }
        const bool stored = !refused_ && !page.ends.empty();
        if (auto right = stored && check_page_ ? check_page_(page) : Result<void>{}; !right) {
            return right.error();
        }
        if (auto added = stored ? target_.add(std::move(page)) : Result<void>{}; !added) {
            return added.error();
        }
    }
}

} // namespace

Result<ImportOutcome> import_source(RowSource& source, ImportTarget& target, const spool::JobSpec& spec,
                                    const ImportOptions& options) {
    if (auto fits = check_charsets(source, options); !fits) {
        return fits.error();
    }
    return Import{source, target, spec, options}.run();
}

Result<ImportOutcome> import_source(RowSource& source, spool::Spool& spool, const spool::JobSpec& spec,
                                    const ImportOptions& options) {
    SpoolTarget target{spool};
    return import_source(source, target, spec, options);
}

ImportReport empty_report(const RowSource& source, const ImportOptions& options) {
    ImportReport report;
    report.columns = source.column_names();
    report.charsets = options.charsets;
    report.charsets.resize(report.columns.size(), options.charsets.front());
    return report;
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
