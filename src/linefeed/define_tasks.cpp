#include "client/monitor_command.hpp"
#include "client/task_command.hpp"
#include "linefeed/definitions.hpp"
#include "printer/tasks.hpp"

#include <algorithm>
#include <memory>

namespace linefeed {

using printer::Argument;
using printer::Task;

namespace {

/// What was given for an argument.
struct Given {
    const Argument* argument = nullptr;
    CLI::Option* option = nullptr;
    std::string text;
};

/// The arguments of one or two tasks, a look and what may be set with it, and what of them was given.
struct Form {
    std::vector<std::unique_ptr<Given>> given;
    const Task* look = nullptr;
    const Task* set = nullptr; ///< nullptr = there is none
    bool yes = false;
};

std::vector<std::string> words_of(std::string_view name) {
    std::vector<std::string> words;
    while (!name.empty()) {
        const std::size_t end = std::min(name.find(' '), name.size());
        words.emplace_back(name.substr(0, end));
        name.remove_prefix(std::min(name.size(), end + 1));
    }
    return words;
}

/// "--stop-after", or "COUNTER" for one that stands in its place.
std::string option_name(const Argument& argument) {
    if (!argument.option.empty()) {
        return std::string{argument.option};
    }
    std::string name{argument.name};
    std::ranges::replace(name, '_', '-');
    if (!argument.positional) {
        return "--" + name;
    }
    std::ranges::transform(name, name.begin(),
                           [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    return name;
}

void add_argument(CLI::App& command, Form& form, const Argument& argument, bool optional) {
    const auto known = std::ranges::find_if(
        form.given, [&argument](const auto& given) { return given->argument->name == argument.name; });
    if (known != form.given.end()) {
        return; // the look has it already
    }
    Given& given = *form.given.emplace_back(std::make_unique<Given>());
    given.argument = &argument;
    const std::string help{argument.help};
    if (argument.type == Argument::Type::flag) {
        given.option = command.add_flag(option_name(argument), help);
        return;
    }
    given.option = command.add_option(option_name(argument), given.text, help);
    given.option->required(argument.required && !optional);
    if (argument.value_optional) {
        given.option->expected(0, 1);
    }
}

/// What of the form belongs to the task.
client::TaskOptions options_for(const Form& form, const Task& task, const client::PrinterOptions& printer) {
    client::TaskOptions options{printer, &task, {}, form.yes};
    for (const auto& given : form.given) {
        const bool belongs = std::ranges::any_of(
            task.arguments, [&given](const Argument& argument) { return argument.name == given->argument->name; });
        if (belongs && given->option->count() > 0) {
            options.arguments.emplace_back(given->argument->name, given->text);
        }
    }
    return options;
}

/// Whether anything was given that only the change takes.
bool sets_something(const Form& form) {
    return form.set != nullptr && std::ranges::any_of(form.given, [&form](const auto& given) {
               const auto of_look = [&given](const Argument& argument) {
                   return argument.name == given->argument->name;
               };
               return given->option->count() > 0 && std::ranges::none_of(form.look->arguments, of_look);
           });
}

bool may_be_destructive(const Task& task) {
    const auto danger = printer::danger_of(task, printer::Arguments{});
    return task.sends != nullptr || (danger && *danger == printer::Danger::destructive);
}

/// The subcommand that the words lead to, made where it is not there yet.
CLI::App& subcommand(CLI::App& above, const std::vector<std::string>& words) {
    CLI::App* at = &above;
    for (const std::string& word : words) {
        const auto there = at->get_subcommands([&word](const CLI::App* known) { return known->get_name() == word; });
        at = there.empty() ? at->add_subcommand(word) : there.front();
        at->fallthrough();
    }
    return *at;
}

/// Of a word that is no task itself: what stands behind it.
void describe_groups(CLI::App& above) {
    for (CLI::App* const command : above.get_subcommands([](const CLI::App*) { return true; })) {
        if (command->get_description().empty()) {
            std::string names;
            for (const CLI::App* const below : command->get_subcommands([](const CLI::App*) { return true; })) {
                names += (names.empty() ? "" : ", ") + below->get_name();
            }
            command->description(names);
            command->require_subcommand(1);
        }
    }
}

/// With the change whose options stand beside the look's.
const Task* set_beside(const Task& look) {
    const Task* const set = printer::find_task(std::string{look.name} + " set");
    return set != nullptr && set->options_of_look ? set : nullptr;
}

void add_monitor(CLI::App& printer, Commands& commands,
                 const std::shared_ptr<client::PrinterOptions>& printer_options) {
    const auto options = std::make_shared<client::MonitorOptions>();
    const auto interval_s = std::make_shared<double>(1);
    const auto duration_s = std::make_shared<double>(0);
    CLI::App& monitor = *printer.add_subcommand("monitor", "Follow the conversation with the printer, in words");
    CLI::App& record = *printer.add_subcommand("record", "Write the conversation with the printer into a file");
    record.add_option("FILE", options->file, "Lines of JSON: time, direction, bytes")->required();
    record.add_flag("--replace", options->replace, "Replace FILE");
    for (CLI::App* const command : {&monitor, &record}) {
        command->fallthrough();
        command->footer("Of a printer of the service its session is shown, of an address an own one, which asks ?RS "
                        "and ?SM.\nThe service keeps 128 bytes of each frame, and of records that go out together the "
                        "first one.");
        command->add_option("--interval", *interval_s, "Of an address: seconds between two inquiries")
            ->capture_default_str()
            ->check(CLI::Range(0.01, 3600.0));
        command->add_option("--for", *duration_s, "End after so many seconds; default: with Ctrl-C")
            ->check(CLI::Range(0.1, 1e6));
        commands.push_back({command, [=] {
                                using std::chrono::milliseconds;
                                options->printer = *printer_options;
                                options->interval = milliseconds{static_cast<std::int64_t>(*interval_s * 1000)};
                                if (*duration_s > 0) {
                                    options->duration = milliseconds{static_cast<std::int64_t>(*duration_s * 1000)};
                                }
                                return client::run_monitor(*options);
                            }});
    }
}

void add_replay(CLI::App& printer, Commands& commands, const std::shared_ptr<client::PrinterOptions>& printer_options) {
    const auto options = std::make_shared<client::ReplayOptions>();
    CLI::App& replay = *printer.add_subcommand("replay", "Show a recorded conversation in words, or say it again");
    replay.fallthrough();
    replay.footer("Exit codes with --against: 0 the printer answers as it did, 1 it does not.");
    replay.add_option("FILE", options->file, "What record has written")->required();
    replay.add_flag("--fast", options->fast, "Without the pauses");
    replay.add_option("--against", options->against,
                      "Send the host's side to this address again, e.g. a linefeed-sim, and compare the answers");
    replay.add_flag("-y,--yes", options->yes, "Send also what is more than an inquiry, without asking");
    commands.push_back({&replay, [=] {
                            options->printer = *printer_options;
                            return client::run_replay(*options);
                        }});
}

void add_task(CLI::App& printer, Commands& commands, const std::shared_ptr<client::PrinterOptions>& printer_options,
              const Task& task) {
    const auto form = std::make_shared<Form>();
    form->look = &task;
    form->set = set_beside(task);
    CLI::App& command = subcommand(printer, words_of(task.name));
    command.description(std::string{task.help} +
                        (form->set == nullptr ? "" : "; with options: " + std::string{form->set->help}));
    for (const Argument& argument : task.arguments) {
        add_argument(command, *form, argument, false);
    }
    if (form->set != nullptr) {
        for (const Argument& argument : form->set->arguments) {
            add_argument(command, *form, argument, true);
        }
    }
    if (may_be_destructive(task)) {
        command.add_flag("-y,--yes", form->yes, "Do also what can lose what is in the printer, without asking");
        command.footer("Refused while a job is printed: stop it first.");
    }
    commands.push_back({&command, [form, printer_options] {
                            const Task& chosen = sets_something(*form) ? *form->set : *form->look;
                            return client::run_task(options_for(*form, chosen, *printer_options));
                        }});
}

} // namespace

void define_tasks(CLI::App& printer, Commands& commands, const std::shared_ptr<client::PrinterOptions>& options) {
    Commands all;
    for (const Task& task : printer::tasks()) {
        const bool defined_by_hand = task.name == "acknowledge" || task.name == "suspend" || task.name == "release" ||
                                     task.name == "preview" || task.name.starts_with("script ");
        if (!task.options_of_look && !defined_by_hand) {
            add_task(printer, all, options, task);
        }
    }
    add_monitor(printer, all, options);
    add_replay(printer, all, options);
    define_files(printer, all, options);
    describe_groups(printer);
    // A command that stands below another comes first: that other one is parsed too.
    std::ranges::stable_sort(all, [](const Command& a, const Command& b) {
        const auto depth = [](const CLI::App* command) {
            int above = 0;
            for (; command != nullptr; command = command->get_parent()) {
                ++above;
            }
            return above;
        };
        return depth(a.app) > depth(b.app);
    });
    commands.insert(commands.end(), all.begin(), all.end());
}

} // namespace linefeed
