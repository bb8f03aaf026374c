// The import of a source into the spool: every row read, checked, encoded with its number, and stored in pages. Bad
// rows refuse the whole import, with a report of each, or are left out if asked for: never guessed at.
#pragma once

#include "base/failure.hpp"
#include "base/record_number.hpp"
#include "intake/graphic_fields.hpp"
#include "intake/row_source.hpp"
#include "protocol/mail_record.hpp"
#include "spool/spool.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace linefeed::intake {

/// How many bad rows a report names; the rest is counted.
inline constexpr std::size_t max_reported_rows = 100;

/// One row that cannot be printed.
struct BadRow {
    std::uint64_t line = 0;
    std::string column; ///< empty = the row as a whole
    std::string reason;

    friend bool operator==(const BadRow&, const BadRow&) = default;
};

struct ImportReport {
    std::uint64_t rows = 0;     ///< read
    std::uint64_t records = 0;  ///< stored, or on the way to the spool
    std::uint64_t bad_rows = 0; ///< not stored
    std::uint64_t rows_with_empty_field =
        0;                              ///< stored; the printer may show its placeholder for an empty text (Annex B)
    std::vector<std::string> columns{}; ///< names, one for each field of a record
    std::vector<protocol::Charset> charsets{}; ///< of the columns
    std::vector<BadRow> reported;              ///< the first max_reported_rows of them
};

struct ImportOptions {
    /// One for all fields, or one per column.
    std::vector<protocol::Charset> charsets{protocol::Charset::latin1};
    protocol::EscapeMode escapes = protocol::EscapeMode::backslash;
    protocol::RecordProperties properties;
    /// Which fields are graphics.
    GraphicOptions graphics{};
    /// Leave bad rows out instead of refusing the import. The records that remain are numbered without gaps.
    bool skip_bad = false;
    /// Asked behind each record: true closes the page although it is not full.
    std::function<bool()> close_page{};
    /// Asked about each page that is to be stored; a failure refuses the source. Empty = none is asked about.
    std::function<Result<void>(const RecordPage&)> check_page{};
    /// A BatchStore refuses a source with FailureKind::input that begins with all the records of an earlier batch of
    /// its folder and has more.
    bool refuse_grown = false;
    /// Asked when all pages are stored and check_source has nothing against it; a failure refuses the source. Not asked
    /// about a source that is refused for its bad rows already.
    std::function<Result<void>()> check_records{};
    /// import_source() asks it before it makes the job: a failure refuses the source. Default: check_unchanged().
    std::function<Result<void>()> check_source{};
    /// Called now and then; returning false cancels the import, which then fails with FailureKind::stopped.
    std::function<bool(const ImportReport&, double progress)> on_progress;
};

/// What came of an import.
struct ImportOutcome {
    ImportReport report;
    /// The job; absent if the import was refused because of bad rows, or none was good (nothing is stored then).
    std::optional<spool::Job> job;
};

/// Where an import puts its job: the spool itself, or whoever has it.
class ImportTarget {
public:
    virtual ~ImportTarget() = default;
    [[nodiscard]] virtual Result<void> begin(const spool::JobSpec& spec) = 0;
    /// Pages in order, none of them empty.
    [[nodiscard]] virtual Result<void> add(RecordPage page) = 0;
    /// There will be no job: what was added goes.
    virtual void refuse() = 0;
    /// As JobImport::commit().
    [[nodiscard]] virtual Result<spool::Job> commit(std::string import_report) = 0;
};

/// Reads `source` to its end into a new job. Fails with FailureKind::input if the source breaks off, has no rows or
/// more than there are numbers, or if the file at spec.source.path is not as the fingerprint says when it has been
/// read; with FailureKind::storage if the spool cannot take it; nothing is stored then.
[[nodiscard]] Result<ImportOutcome> import_source(RowSource& source, spool::Spool& spool, const spool::JobSpec& spec,
                                                  const ImportOptions& options);
[[nodiscard]] Result<ImportOutcome> import_source(RowSource& source, ImportTarget& target, const spool::JobSpec& spec,
                                                  const ImportOptions& options);

/// A file that grew or was replaced while it was read gives a job that is neither the old nor the new one:
/// FailureKind::input if it is not as `before` says. A file that is gone was read to its end all the same.
[[nodiscard]] Result<void> check_unchanged(const spool::SourceFingerprint& before);

/// What is known of a source before its first row.
[[nodiscard]] ImportReport empty_report(const RowSource& source, const ImportOptions& options);

/// The report as JSON: {"rows":…,"records":…,"bad_rows":…,"columns":[{"name":…,"encoding":…}],
/// "reported":[{"line":…,"column":…,"reason":…}]}.
[[nodiscard]] std::string to_json(const ImportReport& report);

} // namespace linefeed::intake
