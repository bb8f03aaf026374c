// One thing that can be asked of a printer, or done to it, besides the feeding: `linefeed printer P …`, the service's
// inspect and command, help and documentation all come from the same list of tasks (tasks.hpp).
#pragma once

#include "base/failure.hpp"
#include "printer/json.hpp"
#include "protocol/command_table.hpp"
#include "protocol/printer_error.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace linefeed::printer {

class PrinterClient;

/// A row of protocol::command_table, as (group, code).
struct CommandId {
    protocol::Group group = protocol::Group::inquiry;
    std::string_view code;
    friend bool operator==(const CommandId&, const CommandId&) = default;
};

/// One argument of a task: a member of the JSON object that it takes.
struct Argument {
    enum class Type : std::uint8_t { text, number, flag };

    std::string_view name; ///< lower case, `_` between words
    std::string_view help; ///< for people: a few words
    Type type = Type::text;
    bool required = false;
    /// On the command line: stands without a name, in its place. Otherwise it is an option, `--name`.
    bool positional = false;
    std::uint64_t smallest = 0; ///< of a number
    std::uint64_t largest = UINT32_MAX;
    std::string_view option{};   ///< on the command line, if not as `name`: "--set"
    bool value_optional = false; ///< the option may stand without its value, which is empty then
};

/// The arguments of a task, checked against its list. Flow: read(), then the getters of what the list has.
class Arguments {
public:
    /// `object` is a JSON object, or null for none. FailureKind::usage: a member that the task does not know, of
    /// another type or out of range, or one that must be there and is not.
    [[nodiscard]] static Result<Arguments> read(std::span<const Argument> known, const Json& object);
    /// The same from JSON text; empty = none.
    [[nodiscard]] static Result<Arguments> parse(std::span<const Argument> known, std::string_view text);

    /// The same from texts, as command lines and addresses have them. A flag is "true", "false", or empty for true.
    [[nodiscard]] static Result<Arguments> from_texts(std::span<const Argument> known,
                                                      std::span<const std::pair<std::string, std::string>> texts);

    [[nodiscard]] bool has(std::string_view name) const { return values_.contains(name); }
    [[nodiscard]] std::string text(std::string_view name) const;
    [[nodiscard]] std::optional<std::uint64_t> number(std::string_view name) const;
    [[nodiscard]] bool flag(std::string_view name) const;
    [[nodiscard]] const Json& json() const { return values_; }

private:
    Json values_ = Json::object();
};

/// What the plant's table of error numbers says.
struct ErrorWords {
    std::string meaning; ///< empty = not listed
    std::string advice;
};

/// What a task is given besides the printer.
struct Order {
    Arguments arguments;
    std::function<ErrorWords(const protocol::PrinterError&)> meaning = [](const auto&) { return ErrorWords{}; };
};

/// What a task does while a job prints.
enum class Danger : std::uint8_t {
    none,        ///< may be done at any time
    feeding,     ///< starts, stops or disturbs the feeding: not while a job is on the line
    spoiling,    ///< spoils what is being printed, whoever has started it: not while the machine prints
    destructive, ///< loses what is in the printer: neither, and needs to be confirmed
};
/// What is done with that command: of `^0=MR`, `^0!GO` … linefeed's own feeding lives.
[[nodiscard]] Danger danger_of(const protocol::Command& command);
/// The mailing FIFO is lost: not before the ledger knows what of it is printed.
[[nodiscard]] bool empties_fifo(const CommandId& command);

struct Task {
    enum class Kind : std::uint8_t {
        look,   ///< changes nothing: Operations::inspect
        change, ///< Operations::command; audited
    };

    std::string_view name; ///< words as on the command line, "nozzle open"
    Kind kind = Kind::look;
    std::string_view help;           ///< one line
    std::span<const CommandId> uses; ///< what it sends and reads
    std::span<const Argument> arguments{};
    Result<Json> (*run)(PrinterClient& printer, const Order& order) = nullptr;
    /// For tasks that send what their arguments say; nullptr = `uses` decides.
    Result<CommandId> (*sends)(const Arguments& arguments) = nullptr;
    /// On the command line no subcommand of its own, but options of the look whose name stands before " set".
    bool options_of_look = false;
    /// The service keeps the answer with the printer: a probe.
    bool remembered = false;
};

/// How careful this task with these arguments has to be. FailureKind::usage if what it would send is no command.
[[nodiscard]] Result<Danger> danger_of(const Task& task, const Arguments& arguments);
[[nodiscard]] Result<bool> empties_fifo(const Task& task, const Arguments& arguments);

} // namespace linefeed::printer
