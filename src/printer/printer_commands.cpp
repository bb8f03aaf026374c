#include "printer/printer_commands.hpp"

#include "printer/exchange.hpp"

#include <algorithm>
#include <string>

namespace linefeed::printer {

using protocol::Action;
using protocol::MachineStatus;
using protocol::Parameter;
using protocol::PrinterError;

namespace {

constexpr auto acknowledge_patience = std::chrono::seconds{2};
constexpr auto look_again = std::chrono::milliseconds{50};

bool is(const PrinterError& error, std::uint32_t number) {
    return !error.none() && (error.code() == number || error.code_without_bit_24() == number);
}

} // namespace

Result<PrinterError> acknowledge(const ClientSettings& settings, std::uint32_t error) {
    const auto connected = PrinterClient::connect(settings);
    if (!connected) {
        return connected.error();
    }
    return acknowledge(**connected, error);
}

Result<PrinterError> acknowledge(PrinterClient& printer, std::uint32_t error) {
    auto machine = printer.ask<MachineStatus>(Parameter::RS);
    if (!machine) {
        return no_answer(printer, Parameter::RS);
    }
    if (!is(machine->error, error)) {
        return Failure{FailureKind::stopped, "error " + std::to_string(error) +
                                                 " is not what the printer shows: " + describe(machine->error)};
    }
    const PrinterError acknowledged = machine->error;
    printer.send(Action::acknowledge_errors);
    const auto deadline = std::chrono::steady_clock::now() + acknowledge_patience;
    while (machine && machine->error == acknowledged) {
        if (std::chrono::steady_clock::now() >= deadline) {
            return Failure{FailureKind::stopped,
                           "the printer still shows error " + std::to_string(error) + ": its cause has not gone"};
        }
        std::this_thread::sleep_for(look_again);
        machine = printer.ask<MachineStatus>(Parameter::RS);
    }
    return machine ? Result<PrinterError>{machine->error} : Result<PrinterError>{no_answer(printer, Parameter::RS)};
}

PanelHold::PanelHold(const ClientSettings& settings, Duration repeat)
    : settings_(settings)
    , repeat_(repeat)
    , thread_([this] { run(); }) {}

PanelHold::~PanelHold() {
    {
        const std::lock_guard lock{mutex_};
        ending_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

Result<void> PanelHold::hold(Duration time) {
    const std::lock_guard lock{mutex_};
    const auto suspended = suspend();
    if (suspended) {
        until_ = Clock::now() + time;
    } else {
        resume();
    }
    changed_.notify_all();
    return suspended;
}

void PanelHold::release() {
    const std::lock_guard lock{mutex_};
    resume();
}

void PanelHold::run() {
    std::unique_lock lock{mutex_};
    while (!ending_) {
        if (!until_) {
            changed_.wait(lock);
        } else if (Clock::now() >= *until_) {
            resume();
        } else if (Clock::now() >= next_) {
            static_cast<void>(suspend()); // if it does not work out: again next time
        } else {
            changed_.wait_until(lock, std::min(*until_, next_));
        }
    }
    resume();
}

/// Once, on a new connection if the old one is lost. An answer to `?RS` shows that the command before it has arrived.
Result<void> PanelHold::suspend() {
    next_ = Clock::now() + repeat_;
    for (int attempt = 0; attempt < 2; ++attempt) {
        const bool fresh = !client_ || !client_->open();
        if (fresh) {
            auto connected = PrinterClient::connect(settings_);
            if (!connected) {
                client_.reset();
                held_.store(false, std::memory_order_relaxed);
                return connected.error();
            }
            client_ = *std::move(connected);
        }
        const auto machine =
            client_->send(Action::user_suspend) ? client_->ask<MachineStatus>(Parameter::RS) : std::nullopt;
        if (machine) {
            const bool standby = machine->machine == protocol::MachineState::standby; // then it does nothing of it
            held_.store(!standby, std::memory_order_relaxed);
            return standby ? Failure{FailureKind::stopped,
                                     settings_.address + ": the printer is in standby: its panel is not suspended"}
                           : Result<void>{};
        }
        if (fresh || client_->open()) {
            break; // it is there, but does not answer
        }
    }
    held_.store(false, std::memory_order_relaxed);
    return no_answer(*client_, Parameter::RS);
}

void PanelHold::resume() {
    const bool wanted = until_.has_value() || client_ != nullptr;
    until_.reset();
    held_.store(false, std::memory_order_relaxed);
    if (!wanted) {
        return;
    }
    const auto resumed_on = [](PrinterClient& printer) {
        return printer.send(Action::user_resume) && printer.ask<MachineStatus>(Parameter::RS);
    };
    if (!client_ || !resumed_on(*client_)) {
        if (const auto again = PrinterClient::connect(settings_)) {
            static_cast<void>(resumed_on(**again));
        }
    }
    client_.reset();
}

} // namespace linefeed::printer
