// What has come of a dropped file: for the report beside it, for the operator, for the service.
#pragma once

#include "intake/drop_directory.hpp"
#include "intake/import.hpp"
#include "spool/job.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace linefeed::intake {

enum class DropVerdict {
    imported,  ///< a new job; in done/
    duplicate, ///< a job has these records already, nothing new is stored; in done/
    failed,    ///< nothing is stored; in failed/
};

/// "imported", "duplicate", "failed".
[[nodiscard]] std::string_view to_string(DropVerdict verdict);

/// Names and texts are as they are in the file and its folder: escape them wherever they are shown.
struct DropReport {
    std::string name; ///< it was dropped under; after a crash, that in processing/
    DropVerdict verdict = DropVerdict::failed;
    std::string reason;  ///< one sentence; empty for a file that was imported whole
    std::string kept_as; ///< "done/names.csv", in the drop folder
    std::uint64_t size_bytes = 0;
    std::string sha256;                 ///< of the file's bytes, hex; empty if it could not be read
    std::optional<spool::JobId> job;    ///< the new one, or that which has the records
    RecordRange records;                ///< of that job
    std::optional<ImportReport> import; ///< with each bad row; absent if no row was read now

    [[nodiscard]] DropEnd end() const { return verdict == DropVerdict::failed ? DropEnd::failed : DropEnd::done; }
};

/// One line of JSON: {"name":…,"verdict":…,"reason":…,"kept_as":…,"bytes":…,"sha256":…,"job":…|null,"records":…,
/// "first":…|null,"last":…|null,"import":to_json(ImportReport)|null}.
[[nodiscard]] std::string to_json(const DropReport& report);

/// "3 of 10 rows cannot be printed; the first: line 4, column code: …"; empty without bad rows.
[[nodiscard]] std::string describe_bad_rows(const ImportReport& report);

} // namespace linefeed::intake
