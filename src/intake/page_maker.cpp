#include "intake/page_maker.hpp"

#include <algorithm>

namespace linefeed::intake {

namespace {

/// A page is full when it has one of these.
constexpr std::size_t page_records = 512;
constexpr std::size_t page_bytes = std::size_t{64} * 1024;
/// How many rows lie between two calls of on_progress.
constexpr std::uint64_t progress_rows = 4096;

} // namespace

Result<void> check_charsets(const RowSource& source, const ImportOptions& options) {
    if (options.charsets.empty()) {
        return Failure{FailureKind::usage, "a charset is needed"};
    }
    if (options.charsets.size() != 1 && options.charsets.size() != source.column_names().size()) {
        return Failure{FailureKind::usage, std::to_string(options.charsets.size()) + " charsets for " +
                                               std::to_string(source.column_names().size()) +
                                               " columns: give one for all, or one for each"};
    }
    return {};
}

PageMaker::PageMaker(RowSource& source, RecordNumber base, const ImportOptions& options)
    : source_(source)
    , base_(base)
    , options_(options)
    , encoder_(options.charsets, options.escapes, options.properties)
    , graphics_(options.graphics)
    , report_(empty_report(source, options)) {}

void PageMaker::report_bad(std::uint64_t line, std::string column, std::string reason) {
    ++report_.bad_rows;
    if (report_.reported.size() < max_reported_rows) {
        report_.reported.push_back({line, std::move(column), std::move(reason)});
    }
}

Result<void> PageMaker::take(Row& row, RecordPage& page) {
    ++report_.rows;
    if (!row.problem.empty()) {
        report_bad(row.line, row.problem_column, row.problem);
        return {};
    }
    if (base_.value() + report_.records >= RecordNumber::max().value()) {
        return Failure{FailureKind::input, "row " + std::to_string(report_.rows) +
                                               " has no number any more: record numbers end at 4294967295"};
    }
    if (const auto problem = graphics_.apply(row.fields)) {
        report_bad(row.line, source_.column_names()[problem->column], problem->reason);
        return {};
    }
    const RecordNumber number = base_ + RecordCount{report_.records + 1};
    if (page.ends.empty()) {
        page.first = number;
    }
    if (const auto appended = encoder_.append(page.frames, number, row.fields); !appended) {
        const auto& error = appended.error();
        const auto& names = source_.column_names();
        const bool has_field = error.field > 0 && error.field <= names.size();
        report_bad(row.line, has_field ? names[error.field - 1] : "", protocol::describe(error));
        return {};
    }
    if (refused()) {
        return {}; // checked, and left out
    }
    ++report_.records;
    report_.rows_with_empty_field += std::ranges::any_of(row.fields, &std::string_view::empty) ? 1U : 0U;
    page.ends.push_back(static_cast<std::uint32_t>(page.frames.size()));
    return {};
}

bool PageMaker::is_full(const RecordPage& page) const {
    return page.ends.size() >= page_records || page.frames.size() >= page_bytes ||
           (options_.close_page && !page.ends.empty() && options_.close_page());
}

Result<bool> PageMaker::next(RecordPage& page) {
    page.ends.clear();
    page.frames.clear();
    while (!ended_) {
        const auto more = source_.next(row_);
        if (!more) {
            return more.error();
        }
        if (!*more) {
            ended_ = true;
            break;
        }
        const bool was_refused = refused();
        if (auto taken = take(row_, page); !taken) {
            return taken.error();
        }
        const bool tell = options_.on_progress && report_.rows % progress_rows == 0;
        if (tell && !options_.on_progress(report_, source_.progress())) {
            return Failure{FailureKind::stopped, "the import was cancelled"};
        }
        if (was_refused) {
            page.frames.clear();
        } else if (refused() || is_full(page)) {
            return true;
        }
    }
    return !page.ends.empty();
}

} // namespace linefeed::intake
