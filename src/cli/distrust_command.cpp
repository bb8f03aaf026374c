#include "cli/distrust_command.hpp"

#include "cli/earlier_jobs.hpp"
#include "cli/operator_name.hpp"
#include "cli/print_report.hpp"
#include "cli/progress_view.hpp"
#include "daemon/distrust.hpp"
#include "daemon/record_ranges.hpp"

#include <nlohmann/json.hpp>

#include <iostream>

namespace linefeed::cli {

namespace {

using Json = nlohmann::ordered_json;

RecordCount count(const std::vector<RecordRange>& ranges) {
    std::uint64_t sum = 0;
    for (const RecordRange& range : ranges) {
        sum += range.count().value();
    }
    return RecordCount{sum};
}

void show(const daemon::DistrustedJob& distrusted) {
    const spool::Job& job = distrusted.job;
    std::cout << name_of(job) << "  " << printable(job.spec.source.path) << ": " << count(distrusted.in_doubt)
              << " records in doubt, " << daemon::to_text(distrusted.in_doubt) << '\n';
    if (job.state != spool::ImportState::ready) {
        std::cout
            << "       its import was not finished: before you settle it, read the file to its end and run linefeed "
               "distrust again\n";
    }
}

Json to_json(const daemon::DistrustedJob& distrusted) {
    const spool::Job& job = distrusted.job;
    return {{"job", static_cast<std::int64_t>(job.id)},
            {"file", job.spec.source.path},
            {"complete", job.state == spool::ImportState::ready},
            {"in_doubt", count(distrusted.in_doubt).value()},
            {"records", daemon::to_text(distrusted.in_doubt)}};
}

Result<ExitCode> distrust(const DistrustOptions& options) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(options.spool, error)) {
        return Failure{FailureKind::usage,
                       "there is no spool at " + options.spool.string() + ": give its place with --spool"};
    }
    auto spool = spool::Spool::open(options.spool, {});
    if (!spool) {
        return spool.error();
    }
    const auto jobs = daemon::distrust(*spool, operator_name(), options.reason);
    if (!jobs) {
        return jobs.error();
    }
    if (options.json) {
        Json all = Json::array();
        for (const daemon::DistrustedJob& job : *jobs) {
            all.push_back(to_json(job));
        }
        std::cout << all.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
    } else {
        for (const daemon::DistrustedJob& job : *jobs) {
            show(job);
        }
    }
    std::cout.flush();
    return std::cout ? ExitCode::done : ExitCode::other;
}

} // namespace

ExitCode run_distrust(const DistrustOptions& options) {
    const auto result = distrust(options);
    if (result) {
        return *result;
    }
    show_failure(result.error(), options.json);
    return exit_code(result.error().kind);
}

} // namespace linefeed::cli
