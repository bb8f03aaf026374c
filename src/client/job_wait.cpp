#include "client/job_wait.hpp"

#include "cli/progress_view.hpp"
#include "cli/signals.hpp"

#include <algorithm>
#include <array>
#include <poll.h>

namespace linefeed::client {

namespace {

constexpr int interval_ms = 250;

/// Flow: construct, run().
class Wait {
public:
    Wait(const Service& service, std::int64_t job, bool quiet)
        : service_(service.impatient())
        , job_(job)
        , view_(quiet) {}

    Result<WaitEnd> run();

private:
    Result<void> look();
    void show();

    Service service_;
    std::int64_t job_;
    cli::SignalWatch signals_;
    cli::ProgressView view_;
    WaitEnd end_;
    std::string message_; ///< of the job, as it was said last
    std::chrono::steady_clock::time_point heard_ = std::chrono::steady_clock::now();
    bool lost_ = false;
};

/// One look at the job. A service that is away for a while is no failure.
Result<void> Wait::look() {
    auto job = service_.get(job_path(job_));
    if (job) {
        if (lost_) {
            view_.message("the service is there again");
        }
        lost_ = false;
        heard_ = std::chrono::steady_clock::now();
        end_.job = std::move(*job);
        return {};
    }
    const bool away = job.error().kind == FailureKind::unreachable;
    if (!away || std::chrono::steady_clock::now() - heard_ > service_patience) {
        return job.error();
    }
    if (!lost_) {
        view_.message(cli::printable(job.error().message) + "; waiting for it");
    }
    lost_ = end_.lost = true;
    return {};
}

void Wait::show() {
    if (std::string message = text(end_.job, "message"); message != message_) {
        message_ = std::move(message);
        if (!message_.empty()) {
            view_.message("job " + std::to_string(job_) + ": " + cli::printable(message_));
        }
    }
    const auto all = number(member(end_.job, "records"), "count");
    const auto printed = number(end_.job, "printed");
    if (text(end_.job, "phase") != "printing" || all <= 0) {
        return;
    }
    double rate = 0;
    if (const auto printer = service_.get(printer_path(text(end_.job, "printer")))) {
        rate = real(member(*printer, "figures"), "rate_per_s").value_or(0);
    }
    view_.update({"printing", static_cast<double>(printed) / static_cast<double>(all),
                  std::to_string(printed) + " of " + std::to_string(all) + " records", rate,
                  rate > 0 ? std::optional{static_cast<double>(all - printed) / rate} : std::nullopt});
}

Result<WaitEnd> Wait::run() {
    while (true) {
        if (const auto looked = look(); !looked) {
            view_.finish();
            return looked.error();
        }
        if (!lost_ && !moves(text(end_.job, "phase"))) {
            break;
        }
        show();
        std::array<pollfd, 1> waiting{{{signals_.descriptor(), POLLIN, 0}}};
        ::poll(waiting.data(), waiting.size(), interval_ms);
        if (signals_.take() > 0) {
            end_.interrupted = true;
            break;
        }
    }
    view_.finish();
    return end_;
}

} // namespace

bool moves(std::string_view phase) {
    constexpr std::array moving{"importing", "arming", "printing", "stopping"};
    return std::find(moving.begin(), moving.end(), phase) != moving.end();
}

ExitCode exit_code_of_phase(std::string_view phase) {
    if (phase == "finished") {
        return ExitCode::done;
    }
    if (phase == "in_doubt") {
        return ExitCode::in_doubt;
    }
    if (phase == "failed") {
        return ExitCode::input_rejected;
    }
    return phase == "cancelled" ? ExitCode::other : ExitCode::stopped;
}

Result<WaitEnd> wait_for_job(const Service& service, std::int64_t job, bool quiet) {
    return Wait{service, job, quiet}.run();
}

} // namespace linefeed::client
