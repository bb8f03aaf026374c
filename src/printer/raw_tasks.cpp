// Anything: every inquiry, and any frame as it is typed. What comes back is shown decoded and as it came.
#include "printer/exchange.hpp"
#include "printer/message_json.hpp"
#include "printer/tasks.hpp"
#include "protocol/crc32.hpp"
#include "protocol/frame_encoder.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace linefeed::printer {

using protocol::Command;
using protocol::Group;
using protocol::Message;

namespace {

Failure wrong(std::string words) {
    return {FailureKind::usage, std::move(words)};
}

Json heard_json(const HeardFrame& frame) {
    Json json = to_json(frame.message);
    json["raw"] = escaped_bytes(frame.raw);
    return json;
}

/// Bytes of a frame behind `^` and address, without CR.
struct RawFrame {
    Group group = Group::inquiry;
    std::string payload;
};

std::optional<Group> group_of(char character) {
    constexpr std::array groups{Group::script, Group::action, Group::inquiry, Group::parameter, Group::file};
    const auto* const found =
        std::ranges::find_if(groups, [character](Group group) { return static_cast<char>(group) == character; });
    return found == groups.end() ? std::nullopt : std::optional{*found};
}

/// A `^` without escape begins a frame (protocol, section 1): another command would go along unseen.
bool has_second_frame(std::string_view payload, protocol::EscapeMode escapes) {
    for (std::size_t i = 0; i < payload.size(); ++i) {
        if (payload[i] == '^') {
            return true;
        }
        if (payload[i] == '\\' && escapes == protocol::EscapeMode::backslash) {
            ++i;
        }
    }
    return false;
}

Failure second_frame() {
    return wrong("a ^ within a frame begins another one: send one frame at a time, and \\\\^ where ^ is data");
}

/// "=CM100", "^0?RS", "!GO".
Result<RawFrame> read_frame(std::string_view text) {
    const auto bytes = unescaped_bytes(text);
    if (!bytes) {
        return wrong("a backslash begins \\t, \\xNN or \\\\: write \\\\ for one that is to be sent");
    }
    std::string_view rest = *bytes;
    if (rest.starts_with("^0")) {
        rest.remove_prefix(2);
    }
    const auto group = rest.empty() ? std::nullopt : group_of(rest.front());
    if (!group || rest.size() < 2) {
        return wrong("a frame begins with its group and its code, e.g. ?RS, !NO, =CM100, $RDFFSDISK; ^0 before it may "
                     "be left out");
    }
    if (rest.find_first_of("\r\n") != std::string_view::npos) {
        return wrong("there is no line end within a frame: send one frame at a time");
    }
    if (has_second_frame(rest, protocol::EscapeMode::backslash)) {
        return second_frame();
    }
    if (rest.size() + 2 > protocol::max_frame_bytes) {
        return wrong("a frame has at most " + std::to_string(protocol::max_frame_bytes) + " bytes");
    }
    return RawFrame{*group, std::string{rest.substr(1)}};
}

/// Views of the table of commands, or of nothing: an unknown code.
CommandId command_of_frame(const RawFrame& frame) {
    if (frame.group == Group::script) {
        return {Group::script, ""};
    }
    const auto found = std::ranges::find_if(protocol::command_table, [&frame](const Command& row) {
        return row.group == frame.group && std::string_view{frame.payload}.starts_with(row.code);
    });
    return {frame.group, found == protocol::command_table.end() ? "unknown" : found->code};
}

Result<CommandId> sent_by(const Arguments& arguments) {
    const auto frame = read_frame(arguments.text("frame"));
    return frame ? Result<CommandId>{command_of_frame(*frame)} : frame.error();
}

Result<Json> send(PrinterClient& printer, const Order& order) {
    const auto frame = read_frame(order.arguments.text("frame"));
    if (!frame) {
        return frame.error();
    }
    if (has_second_frame(frame->payload, printer.settings().profile.escapes)) {
        return second_frame();
    }
    std::string bytes;
    protocol::append_frame(bytes, frame->group, frame->payload);
    const std::string sent = escaped_bytes(std::string_view{bytes}.substr(0, bytes.size() - 1));
    if (order.arguments.flag("crc")) {
        const std::uint32_t crc = protocol::crc32(std::string_view{bytes}.substr(0, bytes.size() - 1));
        bytes.insert(0, printer.frame_of(protocol::NextCrc{crc}));
    }
    printer.set_secured(false); // all that comes is shown, as it is
    constexpr std::uint64_t default_quiet_ms = 500;
    const std::chrono::milliseconds quiet{order.arguments.number("quiet_ms").value_or(default_quiet_ms)};
    const auto heard = gather(printer, bytes, quiet);
    if (!heard) {
        return heard.error();
    }
    Json answers = Json::array();
    for (const HeardFrame& answer : *heard) {
        answers.push_back(heard_json(answer));
    }
    return json_result({{"sent", sent}, {"answers", std::move(answers)}});
}

/// Where an answer of several frames ends.
class AnswerEnd {
public:
    explicit AnswerEnd(std::string code)
        : code_(std::move(code)) {}

    PrinterClient::Heard take(const Message& message) {
        using Heard = PrinterClient::Heard;
        if (const auto* const line = std::get_if<protocol::ScriptLine>(&message)) {
            return code_ != "JB" ? Heard::ignored : line->is_end() ? Heard::done : Heard::more;
        }
        if (const auto* const action = std::get_if<protocol::ActionMessage>(&message)) {
            return code_ == "GW" && action->action == protocol::Action::end_of_data ? Heard::done : Heard::ignored;
        }
        if (const auto* const block = std::get_if<protocol::ErrorListBlock>(&message)) {
            return code_ == "EL" ? after(block->first, block->entries.size(), block->total) : Heard::ignored;
        }
        if (const auto* const block = std::get_if<protocol::EventListBlock>(&message)) {
            return code_ == "EV" ? after(block->first, block->entries.size(), block->total) : Heard::ignored;
        }
        if (std::holds_alternative<protocol::WysiwygLine>(message)) {
            return code_ == "GW" ? Heard::more : Heard::ignored;
        }
        return is_answer(message) ? Heard::done : Heard::ignored;
    }

private:
    static PrinterClient::Heard after(std::uint32_t first, std::size_t entries, std::uint32_t total) {
        return entries == 0 || first + entries > total ? PrinterClient::Heard::done : PrinterClient::Heard::more;
    }
    [[nodiscard]] bool is_answer(const Message& message) const {
        if (const auto* const unknown = std::get_if<protocol::UnknownMessage>(&message)) {
            return unknown->group == Group::parameter && unknown->payload.starts_with(code_);
        }
        return command_of(message) == '=' + code_;
    }

    std::string code_;
};

Result<Json> query(PrinterClient& printer, const Order& order) {
    std::string code = order.arguments.text("code");
    std::ranges::transform(code, code.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    if (code.starts_with('?')) {
        code.erase(0, 1);
    }
    const bool right =
        code.size() == 2 && std::ranges::all_of(code, [](unsigned char c) { return std::isalnum(c) != 0; });
    const auto argument = unescaped_bytes(order.arguments.text("argument"));
    if (!right || !argument || argument->find_first_of("\r\n") != std::string::npos) {
        return wrong("an inquiry has two letters, e.g. SM, and at most one line behind them");
    }
    if (has_second_frame(*argument, printer.settings().profile.escapes)) {
        return second_frame();
    }
    std::string bytes;
    protocol::append_frame(bytes, Group::inquiry, code + *argument);
    AnswerEnd end{code};
    Json answers = Json::array();
    const bool complete = printer.converse(bytes, [&](const Message& message, std::string_view raw) {
        const auto heard = answers.size() < max_gathered ? end.take(message) : PrinterClient::Heard::done;
        if (heard != PrinterClient::Heard::ignored) {
            answers.push_back(heard_json({message, std::string{raw}}));
        }
        return heard;
    });
    if (answers.empty()) {
        return no_answer(printer, '?' + code);
    }
    return json_result({{"inquiry", '?' + code}, {"complete", complete}, {"answers", std::move(answers)}});
}

/// Every inquiry of the table, with what answers it.
std::span<const CommandId> inquiries() {
    static const std::vector<CommandId> all = [] {
        std::vector<CommandId> ids;
        for (const Command& row : protocol::command_table) {
            const bool answer = row.group == Group::parameter && row.direction != protocol::Direction::to_printer;
            if (row.group == Group::inquiry || answer || row.code == code(protocol::Action::end_of_data)) {
                ids.push_back({row.group, row.code});
            }
        }
        return ids;
    }();
    return all;
}

/// What a frame as it is typed is the way to: records and all that belongs to how frames go.
constexpr std::array send_uses{CommandId{Group::parameter, "MR"}, CommandId{Group::parameter, "NR"},
                               CommandId{Group::parameter, "FC"}, CommandId{Group::action, "OK"}};
constexpr std::array send_arguments{
    Argument{.name = "frame",
             .help = "The frame from its group on, e.g. =CM100; \\t is a TAB, \\xNN a byte, \\\\ a backslash",
             .required = true,
             .positional = true},
    Argument{.name = "crc", .help = "With the frame's CRC-32 before it (=NR)", .type = Argument::Type::flag},
    Argument{.name = "quiet_ms",
             .help = "What comes is shown until so long nothing has come; default: 500",
             .type = Argument::Type::number,
             .smallest = 1,
             .largest = 60'000}};
constexpr std::array query_arguments{
    Argument{.name = "code", .help = "The two letters, e.g. SM", .required = true, .positional = true},
    Argument{.name = "argument", .help = "What stands behind them, e.g. 1 of ?PR1", .positional = true}};

} // namespace

std::span<const Task> raw_tasks() {
    static const std::array list{
        Task{"query", Task::Kind::look, "Any inquiry: its answer decoded and as it came", inquiries(), query_arguments,
             query},
        Task{"send", Task::Kind::change, "Any frame as it is typed, and whatever comes then", send_uses, send_arguments,
             send, sent_by},
    };
    return list;
}

} // namespace linefeed::printer
