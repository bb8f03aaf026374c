// `linefeed jobs` and `linefeed ledger JOB`: what is known about every record of a job, and on what it rests.
#pragma once

#include "base/record_number.hpp"
#include "cli/exit_code.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace linefeed::cli {

struct JobsOptions {
    std::filesystem::path spool;
    bool json = false;
};

struct LedgerOptions {
    std::filesystem::path spool;
    std::int64_t job = 0;
    /// `--records N` or `N-M`: one line per record.
    std::optional<RecordRange> records;
    /// `--verify`: check the hash chain of the whole spool.
    bool verify = false;
    /// `--export csv|json`: one row per record that was ever issued.
    std::string export_format;
    bool json = false;
};

[[nodiscard]] ExitCode run_jobs(const JobsOptions& options);
[[nodiscard]] ExitCode run_ledger(const LedgerOptions& options);

} // namespace linefeed::cli
