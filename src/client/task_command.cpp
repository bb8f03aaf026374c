#include "client/task_command.hpp"

#include "api/url.hpp"
#include "cli/signals.hpp"
#include "client/task_text.hpp"
#include "printer/printer_commands.hpp"
#include "printer/tasks.hpp"

#include <chrono>
#include <poll.h>

namespace linefeed::client {

using printer::Arguments;
using printer::Danger;
using printer::Task;

namespace {

Result<ExitCode> show_answer(const TaskOptions& options, const Json& answer) {
    if (options.printer.common.json) {
        show_json(answer);
    } else {
        show(task_text(answer, stdout_screen()));
    }
    return ExitCode::done;
}

Result<Json> ask_service(Service& service, const TaskOptions& options, const Arguments& arguments) {
    const Task& task = *options.task;
    if (task.kind == Task::Kind::change) {
        Json body = arguments.json();
        body["what"] = task.name;
        return service.post(printer_path(options.printer.printer, "/command"), body);
    }
    std::string target = printer_path(options.printer.printer, "/inspect/" + api::url_encoded(task.name));
    for (const auto& [name, text] : options.arguments) {
        target += (target.find('?') == std::string::npos ? "?" : "&") + name + '=' + api::url_encoded(text);
    }
    return service.get(target);
}

Result<Json> ask_printer(const TaskOptions& options, const Arguments& arguments) {
    auto meaning = read_error_words(options.printer.direct);
    if (!meaning) {
        return meaning.error();
    }
    const auto connected = connect_directly(options.printer.printer, options.printer.direct);
    if (!connected) {
        return connected.error();
    }
    return printer::carry_out(*options.task, **connected, {arguments, *std::move(meaning)});
}

std::string question(const TaskOptions& options) {
    std::string words = std::string{options.task->name};
    for (const auto& [name, text] : options.arguments) {
        constexpr std::size_t longest = 80;
        words += ' ' + (text.size() > longest ? std::string{"…"} : text);
    }
    return options.printer.printer + ": " + words + " can lose what is in the printer. Do it";
}

} // namespace

Result<Json> task_answer(const TaskOptions& options) {
    const auto arguments = Arguments::from_texts(options.task->arguments, options.arguments);
    if (!arguments) {
        return arguments.error();
    }
    if (is_address(options.printer.printer)) {
        return ask_printer(options, *arguments);
    }
    const auto place = find_service(options.printer.common.service);
    if (!place) {
        return place.error();
    }
    Service service{*place};
    return ask_service(service, options, *arguments);
}

ExitCode run_task(const TaskOptions& options) {
    const bool json = options.printer.common.json;
    return run_command(json, [&]() -> Result<ExitCode> {
        const auto arguments = Arguments::from_texts(options.task->arguments, options.arguments);
        const auto danger = arguments ? danger_of(*options.task, *arguments) : arguments.error();
        if (!danger) {
            return danger.error();
        }
        if (*danger == Danger::destructive) {
            const auto yes = confirm(question(options), options.yes, json);
            if (!yes || !*yes) {
                return yes ? Result<ExitCode>{ExitCode::stopped} : yes.error();
            }
        }
        const auto answer = task_answer(options);
        return answer ? show_answer(options, *answer) : answer.error();
    });
}

ExitCode run_direct_suspend(const SuspendOptions& options) {
    cli::SignalWatch signals; // before the thread of the panel
    return run_command(options.printer.common.json, [&]() -> Result<ExitCode> {
        const auto settings = direct_settings(options.printer.printer, options.printer.direct);
        if (!settings) {
            return settings.error();
        }
        const std::chrono::seconds time{options.hold_s};
        printer::PanelHold panel{*settings};
        if (auto held = panel.hold(time); !held) {
            return held.error();
        }
        say("the panel is suspended for " + std::to_string(options.hold_s) + " s, or until Ctrl-C");
        pollfd signal{signals.descriptor(), POLLIN, 0};
        static_cast<void>(::poll(&signal, 1, static_cast<int>(std::chrono::milliseconds{time}.count())));
        panel.release();
        if (options.printer.common.json) {
            show_json({{"panel_suspended", false}});
        }
        return ExitCode::done;
    });
}

} // namespace linefeed::client
