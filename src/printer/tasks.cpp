#include "printer/tasks.hpp"

#include "printer/exchange.hpp"
#include "printer/look.hpp"
#include "printer/printer_client.hpp"

#include <algorithm>
#include <array>

namespace linefeed::printer {

namespace {

std::vector<Task> joined(const auto& lists) {
    std::vector<Task> all;
    for (const std::span<const Task>& list : lists) {
        all.insert(all.end(), list.begin(), list.end());
    }
    return all;
}

/// In standby, where a restart belongs, nothing but that, files and `!PO` is answered.
bool may_be_done_unheard(const Task& task) {
    return std::ranges::any_of(task.uses, [](const CommandId& used) {
        return used.group == protocol::Group::file || used == CommandId{protocol::Group::action, "RM"};
    });
}

/// Asks the machine itself.
Result<void> check_not_printing(const Task& task, PrinterClient& printer) {
    const auto status = ask_status(printer);
    if (!status) {
        return may_be_done_unheard(task) && printer.open()
                   ? Result<void>{}
                   : Failure{FailureKind::unreachable, no_answer(printer, protocol::Parameter::RS).message +
                                                           "; nobody knows whether it prints: nothing is done"};
    }
    if (status->machine == protocol::MachineState::printing) {
        return Failure{FailureKind::stopped, printer.settings().address +
                                                 ": the printer is ready to print or prints: " +
                                                 "stop it first, then say " + std::string{task.name} + " again"};
    }
    return {};
}

/// Files go in blocks between the printer and a file here, which is no single answer.
std::vector<std::string_view> transfers_using(const CommandId& command) {
    if (command == CommandId{protocol::Group::file, "RF"}) {
        return {"files get", "backup", "restore"};
    }
    constexpr std::array<std::string_view, 3> both_ways{"FH", "FT", "FA"};
    if (command.group == protocol::Group::file && std::ranges::find(both_ways, command.code) != both_ways.end()) {
        return {"files get", "files put", "backup", "restore"};
    }
    return {};
}

} // namespace

std::span<const Task> tasks() {
    static const std::vector<Task> all =
        joined(std::array{look_tasks(), machine_tasks(), setting_tasks(), file_tasks(), probe_tasks(), raw_tasks()});
    return all;
}

const Task* find_task(std::string_view name) {
    const auto found = std::ranges::find(tasks(), name, &Task::name);
    return found == tasks().end() ? nullptr : &*found;
}

Result<const Task*> known_task(std::string_view name, Task::Kind kind) {
    const Task* const task = find_task(name);
    if (task != nullptr && task->kind == kind) {
        return task;
    }
    std::string names;
    for (const Task& known : tasks()) {
        if (known.kind == kind) {
            names += (names.empty() ? "" : ", ") + std::string{known.name};
        }
    }
    return Failure{FailureKind::usage, '"' + std::string{name} + "\" is none of: " + names};
}

Result<Json> carry_out(const Task& task, PrinterClient& printer, const Order& order) {
    const auto danger = danger_of(task, order.arguments);
    if (!danger) {
        return danger.error();
    }
    if (*danger >= Danger::spoiling) {
        if (auto checked = check_not_printing(task, printer); !checked) {
            return checked.error();
        }
    }
    return task.run(printer, order);
}

Result<std::string> carry_out_as_text(const Task& task, PrinterClient& printer, const Order& order) {
    const auto json = carry_out(task, printer, order);
    return json ? Result<std::string>{json->dump(-1, ' ', false, Json::error_handler_t::replace)} : json.error();
}

std::vector<std::string_view> tasks_using(const CommandId& command) {
    std::vector<std::string_view> names = transfers_using(command);
    for (const Task& task : tasks()) {
        if (std::ranges::find(task.uses, command) != task.uses.end()) {
            names.push_back(task.name);
        }
    }
    return names;
}

} // namespace linefeed::printer
