// Where jobs and their ledger are read from: the service, or the file of a spool that no service keeps. Both give the
// JSON of openapi.yaml, so that what is made of it is made once.
#pragma once

#include "base/failure.hpp"
#include "base/record_number.hpp"
#include "client/service.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace linefeed::client {

/// Which jobs.
struct JobQuery {
    std::string printer;             ///< empty = all
    std::vector<std::string> phases; ///< names of JobPhase; empty = all
    std::size_t limit = 50;          ///< the newest
};

class JobSource {
public:
    virtual ~JobSource() = default;

    /// Job objects, newest first.
    [[nodiscard]] virtual Result<std::vector<Json>> jobs(const JobQuery& query) = 0;
    /// A Job object. FailureKind::usage if there is none with this number.
    [[nodiscard]] virtual Result<Json> job(std::int64_t id) = 0;
    /// HistoryStretch objects, ascending, cut to `records`; absent = all.
    [[nodiscard]] virtual Result<std::vector<Json>> history(std::int64_t id, std::optional<RecordRange> records) = 0;
    /// What is printed on each of these records, ascending: {"number", "fields"}, until `on_record` returns false.
    [[nodiscard]] virtual Result<void> records(std::int64_t id, RecordRange records,
                                               const std::function<bool(const Json&)>& on_record) = 0;
    /// Checks the hash chain of the whole ledger: how many rows it has.
    [[nodiscard]] virtual Result<std::int64_t> verify() = 0;
};

/// Where the user wants jobs to be read from.
struct JobSourceOptions {
    ServiceOptions service;
    std::filesystem::path spool;         ///< `--spool`; empty = not given
    std::filesystem::path default_spool; ///< where `linefeed print` keeps its jobs
};

/// The file of --spool. Without it the service, if one is chosen or its socket is there; otherwise the default spool. A
/// choice that the user has not made himself is said on stderr. FailureKind::usage if two are chosen.
[[nodiscard]] Result<std::unique_ptr<JobSource>> open_job_source(const JobSourceOptions& options);

/// The service as a source.
[[nodiscard]] std::unique_ptr<JobSource> service_source(const ServicePlace& place);
/// A spool, opened for reading.
[[nodiscard]] Result<std::unique_ptr<JobSource>> spool_source(const std::filesystem::path& file);

} // namespace linefeed::client
