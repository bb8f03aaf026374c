// `linefeed printers`, `linefeed printer P …` and `linefeed stop`: printers of the service.
#pragma once

#include "client/command.hpp"
#include "client/direct_printer.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace linefeed::client {

struct PrinterOptions {
    CommonOptions common;
    std::string printer; ///< its name in the service, or an address
    DirectOptions direct{};
};

struct FramesOptions {
    PrinterOptions printer;
    bool error = false; ///< those before the last error
};

struct AcknowledgeOptions {
    PrinterOptions printer;
    std::optional<std::int64_t> error{}; ///< PrinterError.code; absent = the one that the printer shows
};

struct AcceptOptions {
    PrinterOptions printer;
    std::string serial_number;
};

struct SuspendOptions {
    PrinterOptions printer;
    bool suspend = true; ///< false: give the panel back
    std::int64_t hold_s = 60;
};

struct StopOptions {
    CommonOptions common;
    std::string printer; ///< empty: the only one that prints
    bool all = false;
};

[[nodiscard]] ExitCode run_printers(const CommonOptions& options);
[[nodiscard]] ExitCode run_printer(const PrinterOptions& options);
/// ExitCode::stopped if a job could not start.
[[nodiscard]] ExitCode run_preflight(const PrinterOptions& options);
[[nodiscard]] ExitCode run_frames(const FramesOptions& options);
[[nodiscard]] ExitCode run_acknowledge(const AcknowledgeOptions& options);
[[nodiscard]] ExitCode run_accept(const AcceptOptions& options);
[[nodiscard]] ExitCode run_suspend(const SuspendOptions& options);
/// Ends when the truth is in the ledger. ExitCode::in_doubt if an operator must decide about records then.
[[nodiscard]] ExitCode run_stop(const StopOptions& options);

} // namespace linefeed::client
