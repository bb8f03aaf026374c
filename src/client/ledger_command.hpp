// `linefeed jobs` and `linefeed ledger JOB`: what is known about every record of a job, and on what it rests.
#pragma once

#include "base/record_number.hpp"
#include "cli/exit_code.hpp"
#include "client/job_source.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace linefeed::client {

struct JobsOptions {
    JobSourceOptions source;
    JobQuery query;
    bool json = false;
};

struct LedgerOptions {
    JobSourceOptions source;
    std::int64_t job = 0;
    /// `--records N` or `N-M`: one line per record.
    std::optional<RecordRange> records;
    /// `--verify`: check the hash chain of the whole ledger.
    bool verify = false;
    /// `--export csv|json`: one row per record that was ever issued.
    std::string export_format;
    bool json = false;
};

[[nodiscard]] cli::ExitCode run_jobs(const JobsOptions& options);
[[nodiscard]] cli::ExitCode run_ledger(const LedgerOptions& options);

} // namespace linefeed::client
