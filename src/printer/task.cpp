#include "printer/task.hpp"

#include <algorithm>
#include <charconv>
#include <initializer_list>

namespace linefeed::printer {

using protocol::Action;
using protocol::Command;
using protocol::Group;
using protocol::Parameter;
using protocol::Risk;

namespace {

Failure wrong(std::string words) {
    return {FailureKind::usage, std::move(words)};
}

std::string in_quotes(std::string_view name) {
    return '"' + std::string{name} + '"';
}

std::string names_of(std::span<const Argument> known) {
    std::string names;
    for (const Argument& argument : known) {
        names += (names.empty() ? "" : ", ") + std::string{argument.name};
    }
    return names.empty() ? "it takes none" : "it takes " + names;
}

/// What is wrong with a value; empty = nothing.
std::string check(const Argument& argument, const Json& value) {
    switch (argument.type) {
    case Argument::Type::text:
        return value.is_string() ? "" : in_quotes(argument.name) + " must be a text";
    case Argument::Type::flag:
        return value.is_boolean() ? "" : in_quotes(argument.name) + " must be true or false";
    case Argument::Type::number:
        break;
    }
    if (value.is_number_unsigned() || (value.is_number_integer() && value.get<std::int64_t>() >= 0)) {
        const auto number = value.get<std::uint64_t>();
        if (number >= argument.smallest && number <= argument.largest) {
            return "";
        }
    }
    return in_quotes(argument.name) + " must be a whole number from " + std::to_string(argument.smallest) + " to " +
           std::to_string(argument.largest);
}

bool is_one_of(const Command& command, std::initializer_list<Action> actions) {
    return command.group == Group::action && std::ranges::any_of(actions, [&command](Action action) {
               return command.index == static_cast<std::uint8_t>(action);
           });
}

bool is_spoiling(const Command& command) {
    return is_one_of(command, {Action::nozzle_close, Action::motor_close, Action::reload_fonts});
}

bool is_feeding(const Command& command) {
    const auto transfer = [&command](Parameter wanted) {
        return command.group == Group::parameter && command.index == static_cast<std::uint8_t>(wanted);
    };
    const auto file = [&command](protocol::FileCommand wanted) {
        return command.group == Group::file && command.index == static_cast<std::uint8_t>(wanted);
    };
    return is_one_of(command, {Action::start_print, Action::stop_print}) || transfer(Parameter::MR) ||
           transfer(Parameter::CM) || transfer(Parameter::CC) || transfer(Parameter::JL) ||
           file(protocol::FileCommand::FH) || file(protocol::FileCommand::FT); // a file may be the job that prints
}

/// nullptr = linefeed does not know it.
const Command* find_command(const CommandId& id) {
    const auto found = std::ranges::find_if(
        protocol::command_table, [&id](const Command& row) { return row.group == id.group && row.code == id.code; });
    return found == protocol::command_table.end() ? nullptr : &*found;
}

/// What nobody knows is taken for the worst, unless it only asks.
Danger danger_of_sent(const CommandId& id) {
    const Command* const command = find_command(id);
    if (command != nullptr) {
        return danger_of(*command);
    }
    return id.group == Group::inquiry ? Danger::none : Danger::destructive;
}

} // namespace

Result<Arguments> Arguments::read(std::span<const Argument> known, const Json& object) {
    Arguments arguments;
    if (!object.is_null() && !object.is_object()) {
        return wrong("the arguments must be a JSON object");
    }
    for (const auto& [name, value] : object.items()) {
        const auto argument = std::ranges::find(known, std::string_view{name}, &Argument::name);
        if (argument == known.end()) {
            return wrong("there is no argument " + in_quotes(name) + ": " + names_of(known));
        }
        if (auto problem = check(*argument, value); !problem.empty()) {
            return wrong(std::move(problem));
        }
        arguments.values_[name] = value;
    }
    for (const Argument& argument : known) {
        if (argument.required && !arguments.has(argument.name)) {
            return wrong(in_quotes(argument.name) + " is missing: " + std::string{argument.help});
        }
    }
    return arguments;
}

Result<Arguments> Arguments::parse(std::span<const Argument> known, std::string_view text) {
    const Json object = text.empty() ? Json{} : Json::parse(text, nullptr, false);
    return object.is_discarded() ? wrong("the arguments are no JSON") : read(known, object);
}

Result<Arguments> Arguments::from_texts(std::span<const Argument> known,
                                        std::span<const std::pair<std::string, std::string>> texts) {
    Json object = Json::object();
    for (const auto& [name, text] : texts) {
        const auto argument = std::ranges::find(known, std::string_view{name}, &Argument::name);
        const auto type = argument == known.end() ? Argument::Type::text : argument->type;
        std::uint64_t number = 0;
        const auto end = std::from_chars(text.data(), text.data() + text.size(), number);
        if (type == Argument::Type::number && end.ec == std::errc{} && end.ptr == text.data() + text.size()) {
            object[name] = number;
        } else if (type == Argument::Type::flag && (text.empty() || text == "true" || text == "false")) {
            object[name] = text != "false";
        } else {
            object[name] = text; // of another type than it should be: read() says so
        }
    }
    return read(known, object);
}

std::string Arguments::text(std::string_view name) const {
    return has(name) ? values_[name].get<std::string>() : std::string{};
}

std::optional<std::uint64_t> Arguments::number(std::string_view name) const {
    return has(name) ? std::optional{values_[name].get<std::uint64_t>()} : std::nullopt;
}

bool Arguments::flag(std::string_view name) const {
    return has(name) && values_[name].get<bool>();
}

Danger danger_of(const Command& command) {
    if (command.risk == Risk::destructive || command.group == Group::script) {
        return Danger::destructive; // a script begins with the deletion of the current job
    }
    return is_spoiling(command) ? Danger::spoiling : is_feeding(command) ? Danger::feeding : Danger::none;
}

bool empties_fifo(const CommandId& command) {
    return command.group == Group::action &&
           (command.code == code(Action::flush_fifo) || command.code == code(Action::factory_reset) ||
            command.code == code(Action::power_off));
}

Result<Danger> danger_of(const Task& task, const Arguments& arguments) {
    if (task.kind == Task::Kind::look) {
        return Danger::none;
    }
    if (task.sends != nullptr) {
        const auto sent = task.sends(arguments);
        const Danger danger = sent ? danger_of_sent(*sent) : Danger::none;
        const bool unchecked =
            danger == Danger::feeding && sent->group != Group::action; // a task of its own looks first
        return sent ? Result<Danger>{unchecked ? Danger::spoiling : danger} : sent.error();
    }
    Danger worst = Danger::none;
    for (const CommandId& used : task.uses) {
        worst = std::max(worst, danger_of_sent(used));
    }
    return worst;
}

Result<bool> empties_fifo(const Task& task, const Arguments& arguments) {
    if (task.sends != nullptr) {
        const auto sent = task.sends(arguments);
        return sent ? Result<bool>{empties_fifo(*sent)} : sent.error();
    }
    return std::ranges::any_of(task.uses, [](const CommandId& used) { return empties_fifo(used); });
}

} // namespace linefeed::printer
