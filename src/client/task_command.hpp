// `linefeed printer P …` for every task of printer/tasks.hpp: over the service if P is a name, directly if P is an
// address. Both show the same.
#pragma once

#include "client/direct_printer.hpp"
#include "client/printer_commands.hpp"
#include "printer/task.hpp"

#include <string>
#include <utility>
#include <vector>

namespace linefeed::client {

struct TaskOptions {
    PrinterOptions printer;
    const printer::Task* task = nullptr;
    std::vector<std::pair<std::string, std::string>> arguments; ///< name and text
    bool yes = false;                                           ///< nobody is asked
};

/// The answer to the task, over the service or directly. Nobody is asked.
[[nodiscard]] Result<Json> task_answer(const TaskOptions& options);

/// Asks on the terminal before it does what is destructive.
[[nodiscard]] ExitCode run_task(const TaskOptions& options);

/// `linefeed printer ADDRESS suspend --hold …`: holds the panel as long as it runs.
[[nodiscard]] ExitCode run_direct_suspend(const SuspendOptions& options);

} // namespace linefeed::client
