// The list of tasks: what `linefeed printer P …` can do with a printer. A new task gets its function in the file of its
// theme and its row in the list of that file, which joins the others here.
#pragma once

#include "printer/task.hpp"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::printer {

// One list for each theme
[[nodiscard]] std::span<const Task> look_tasks();    ///< look_tasks.cpp
[[nodiscard]] std::span<const Task> machine_tasks(); ///< machine_tasks.cpp
[[nodiscard]] std::span<const Task> setting_tasks(); ///< setting_tasks.cpp
[[nodiscard]] std::span<const Task> file_tasks();    ///< file_tasks.cpp
[[nodiscard]] std::span<const Task> probe_tasks();   ///< probe.cpp
[[nodiscard]] std::span<const Task> raw_tasks();     ///< raw_tasks.cpp

/// All of them, by theme.
[[nodiscard]] std::span<const Task> tasks();
/// nullptr = there is none of this name.
[[nodiscard]] const Task* find_task(std::string_view name);
/// FailureKind::usage, naming those of this kind.
[[nodiscard]] Result<const Task*> known_task(std::string_view name, Task::Kind kind);

/// Carries a task out. While the machine says that it prints, one that is destructive is refused: FailureKind::stopped.
/// FailureKind::unreachable: the printer does not answer.
[[nodiscard]] Result<Json> carry_out(const Task& task, PrinterClient& printer, const Order& order);

/// The same with its answer as JSON text on one line.
[[nodiscard]] Result<std::string> carry_out_as_text(const Task& task, PrinterClient& printer, const Order& order);

/// What reaches this command from the command line behind `linefeed printer P`: the transfers of files, which are no
/// tasks, then tasks in the order of the list.
[[nodiscard]] std::vector<std::string_view> tasks_using(const CommandId& command);

} // namespace linefeed::printer
