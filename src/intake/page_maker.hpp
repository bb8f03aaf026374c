// From rows to pages: every row read, checked and encoded with its number. Knows neither spool nor threads, so an
// import that prints meanwhile runs it on a thread of its own.
#pragma once

#include "base/record_page.hpp"
#include "intake/import.hpp"

namespace linefeed::intake {

/// A charset for all columns, or one for each; FailureKind::usage otherwise.
[[nodiscard]] Result<void> check_charsets(const RowSource& source, const ImportOptions& options);

/// Flow: next() until it returns false or fails. Precondition: check_charsets().
class PageMaker {
public:
    PageMaker(RowSource& source, RecordNumber base, const ImportOptions& options);

    /// The next page of good records. At a row that refuses the source it gives the good records before it, perhaps
    /// none, and after that only checks the rest. False: there are no more. Fails as RowSource::next(), with
    /// FailureKind::input when the numbers are used up, with FailureKind::stopped if it was cancelled.
    [[nodiscard]] Result<bool> next(RecordPage& page);
    /// There was a bad row, and there must be none. What next() gave are the records before it.
    [[nodiscard]] bool refused() const { return report_.bad_rows > 0 && !options_.skip_bad; }
    [[nodiscard]] const ImportReport& report() const { return report_; }

private:
    [[nodiscard]] Result<void> take(Row& row, RecordPage& page);
    void report_bad(std::uint64_t line, std::string column, std::string reason);
    [[nodiscard]] bool is_full(const RecordPage& page) const;

    RowSource& source_;
    RecordNumber base_;
    ImportOptions options_;
    protocol::MailRecordEncoder encoder_;
    GraphicFields graphics_;
    Row row_;
    bool ended_ = false;
    ImportReport report_;
};

} // namespace linefeed::intake
