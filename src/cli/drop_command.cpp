#include "cli/drop_command.hpp"

#include "cli/print_report.hpp"
#include "cli/progress_view.hpp"
#include "cli/signals.hpp"
#include "daemon/wall_clock.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <iostream>
#include <poll.h>

namespace linefeed::cli {

namespace {

/// Events are collected for so long: a file that is being written raises one for each write.
constexpr int event_pause_ms = 50;
constexpr int longest_wait_ms = 60'000;

Instant now() {
    return Instant{std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch())};
}

/// One line for a person.
std::string line_of(const intake::DropReport& report) {
    const std::string name = report.name + ": ";
    const std::string job = report.job ? "job " + std::to_string(static_cast<std::int64_t>(*report.job)) : "";
    const std::string place = " (" + report.kept_as + ")";
    switch (report.verdict) {
    case intake::DropVerdict::imported:
        return name + "imported " + std::to_string(report.records.count().value()) + " records as " + job +
               (report.reason.empty() ? "" : ", " + report.reason) + place;
    case intake::DropVerdict::duplicate:
        return name + "not imported again, it is " + job + ": " + report.reason + place;
    case intake::DropVerdict::failed:
        return name + "rejected: " + report.reason + place;
    }
    assertion_failed("DropVerdict", __FILE__, __LINE__);
}

/// Flow: construct, run().
class DropCommand final : public intake::DropEvents {
public:
    explicit DropCommand(const DropOptions& options)
        : options_(options)
        , view_(options.json) {}

    Result<ExitCode> run();

    void finished(const intake::DropReport& report) override;
    void note(const std::string& name, const std::string& words) override;
    bool progress(const std::string& name, std::uint64_t rows, double fraction) override;

private:
    Result<ExitCode> watch(intake::DropFolder& folder);
    void wait(const intake::DropFolder& folder, Instant until);
    void tell_staying(const intake::DropFolder& folder);
    bool interrupted();

    const DropOptions& options_;
    SignalWatch signals_;
    ProgressView view_;
    bool interrupted_ = false;
    bool rejected_ = false;
};

bool DropCommand::interrupted() {
    interrupted_ = interrupted_ || signals_.take() > 0;
    return interrupted_;
}

void DropCommand::finished(const intake::DropReport& report) {
    rejected_ = rejected_ || report.verdict == intake::DropVerdict::failed;
    view_.message(printable(line_of(report)));
    if (options_.json) {
        std::cout << intake::to_json(report) << std::endl;
    }
}

void DropCommand::note(const std::string& name, const std::string& words) {
    view_.message(printable(name.empty() ? words : name + ": stays for now: " + words));
}

bool DropCommand::progress(const std::string& name, std::uint64_t rows, double fraction) {
    view_.update({(rows == 0 ? "reading " : "importing ") + printable(name), fraction,
                  rows == 0 ? "" : std::to_string(rows) + " rows", 0, std::nullopt});
    return !interrupted();
}

/// Waits for the time, a signal, or events.
void DropCommand::wait(const intake::DropFolder& folder, Instant until) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - now()).count();
    int timeout_ms = static_cast<int>(std::clamp<std::int64_t>(left, 0, longest_wait_ms));
    std::array<pollfd, 2> waiting{{{signals_.descriptor(), POLLIN, 0}, {folder.descriptor(), POLLIN, 0}}};
    if (::poll(waiting.data(), 1, std::min(timeout_ms, event_pause_ms)) == 0) {
        timeout_ms -= std::min(timeout_ms, event_pause_ms);
        ::poll(waiting.data(), waiting.size(), timeout_ms); // it leaves a descriptor of -1 out
    }
}

void DropCommand::tell_staying(const intake::DropFolder& folder) {
    for (const auto& [name, why] : folder.staying()) {
        note(name, why);
    }
}

Result<ExitCode> DropCommand::watch(intake::DropFolder& folder) {
    while (!interrupted()) {
        const auto next = folder.step(now());
        view_.finish();
        if (!next) {
            return next.error();
        }
        if (options_.once && next->idle) {
            tell_staying(folder);
            return rejected_ ? ExitCode::input_rejected : ExitCode::done;
        }
        if (!next->more) {
            wait(folder, next->at);
        }
    }
    return ExitCode::done;
}

Result<ExitCode> DropCommand::run() {
    auto spool = spool::Spool::open(options_.spool, {daemon::wall_clock_ns, {}});
    if (!spool) {
        return spool.error();
    }
    intake::SpoolBatches batches{*spool};
    auto folder = intake::DropFolder::open(options_.settings, batches, *this);
    if (!folder) {
        return folder.error();
    }
    if (!options_.once) {
        view_.message("watching " + printable(folder->path().string()) + " for " +
                      printable(options_.settings.pattern) +
                      (folder->mode() == intake::WatchMode::poll ? " by polling" : " by inotify") + "; Ctrl-C ends it");
    }
    return watch(*folder);
}

} // namespace

ExitCode run_drop(const DropOptions& options) {
    DropCommand command{options};
    const auto result = command.run();
    if (!result) {
        show_failure(result.error(), false); // stdout has lines about files only
        return exit_code(result.error().kind);
    }
    return *result;
}

} // namespace linefeed::cli
