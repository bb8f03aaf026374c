// What `linefeed print` says at its end: what happened, where the ledger stands, and how to go on. One text for people,
// one JSON object for programs.
#pragma once

#include "base/failure.hpp"
#include "cli/exit_code.hpp"
#include "feeder/outcome.hpp"
#include "intake/import.hpp"
#include "spool/spool.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace linefeed::cli {

/// Records that an operator has to decide about, with what is printed on them.
struct DoubtfulRecord {
    RecordNumber number;
    std::vector<std::string> fields;
};

struct PrintReport {
    spool::Job job;
    RecordRange wanted;
    std::string result;  ///< "finished", "stop_requested", …
    std::string message; ///< one line
    ExitCode code = ExitCode::done;
    RecordCount printed; ///< of the wanted records
    std::optional<RecordNumber> last_printed;
    RecordRange next; ///< what would be printed next; empty = nothing
    RecordCount open; ///< issued, fate to be found out at the next start
    RecordCount in_doubt;
    std::vector<DoubtfulRecord> doubtful; ///< the first of them
    /// Why the last product does not tell which of them are printed (daemon::DoubtEvidence::hole); empty = it does.
    std::string doubt_hole;
    std::vector<intake::BadRow> bad_rows; ///< that have ended the import; the first of them
};

inline constexpr std::size_t max_doubtful_shown = 300;

/// Puts the report together from the ledger.
[[nodiscard]] Result<PrintReport> make_report(spool::Spool& spool, const spool::Job& job, RecordRange wanted,
                                              const feeder::Outcome& outcome, const std::string& detail);

/// The records in doubt with their texts, for a person.
void show_doubtful(const PrintReport& report);
/// For stdout.
void show_report(const PrintReport& report, bool json);
/// The file could not be read to its end.
void reject(PrintReport& report, const Failure& failure);
/// A bad row has ended the import, and all records before it are printed. `rows` is empty if that was an earlier
/// import: then the job knows.
void reject(PrintReport& report, const intake::ImportReport& rows, const std::string& file);
/// The rows that cannot be printed: for stderr, or as JSON on stdout. `unfinished` = the job whose import they have
/// ended; without it nothing is imported.
void show_bad_rows(const intake::ImportReport& report, const std::string& file, bool refused,
                   const spool::Job* unfinished, bool json);
/// A failure before there was anything to report.
void show_failure(const Failure& failure, bool json);

} // namespace linefeed::cli
