// The words of faults, see fault.hpp.
#include "simulator/fault.hpp"

#include "protocol/decimal.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

namespace linefeed::simulator {
namespace {

using protocol::Action;

constexpr std::uint32_t largest_error_code = 0x01FF'FFFF;
constexpr double longest_time_s = 1e6;

constexpr std::string_view when_expected = "expected \"print N\", \"frame N\" or \"time SECONDS\" in front";

struct Key {
    std::string_view word;
    Action action;
};
constexpr std::array<Key, 7> keys{{
    {"start", Action::start_print},
    {"stop", Action::stop_print},
    {"open-nozzle", Action::nozzle_open},
    {"close-nozzle", Action::nozzle_close},
    {"acknowledge", Action::acknowledge_errors},
    {"power-on", Action::power_on},
    {"power-off", Action::power_off},
}};

struct TroubleWord {
    std::string_view word;
    Trouble trouble;
};
constexpr std::array<TroubleWord, trouble_count> trouble_words{{
    {"lose-answer", Trouble::lost_answer},
    {"damage-answer", Trouble::damaged_answer},
    {"wrong-crc", Trouble::wrong_crc},
    {"refuse-crc", Trouble::refused_crc},
    {"damage-block", Trouble::damaged_block},
    {"refuse-block", Trouble::refused_block},
    {"cancel-transfer", Trouble::cancelled_transfer},
}};

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) {
        text.remove_prefix(1);
    }
    while (!text.empty() && is_blank(text.back())) {
        text.remove_suffix(1);
    }
    return text;
}

/// The first word, taken off together with the blanks behind it. Precondition: no blanks in front.
std::string_view take_word(std::string_view& text) {
    const auto end = static_cast<std::size_t>(std::ranges::find_if(text, is_blank) - text.begin());
    const std::string_view word = text.substr(0, end);
    text = trimmed(text.substr(end));
    return word;
}

/// One of two words.
std::optional<bool> read_either(std::string_view text, std::string_view yes, std::string_view no) {
    return text == yes ? std::optional{true} : text == no ? std::optional{false} : std::nullopt;
}

std::optional<Moment> read_moment(std::string_view unit, std::string_view number) {
    if (unit == "print" || unit == "frame") {
        const auto count = protocol::read_decimal<std::uint64_t>(number);
        return count && *count > 0
                   ? std::optional{Moment{unit == "print" ? Moment::Unit::print : Moment::Unit::frame, *count, {}}}
                   : std::nullopt;
    }
    double seconds = 0;
    const char* const end = number.data() + number.size();
    const auto read = std::from_chars(number.data(), end, seconds, std::chars_format::fixed);
    const bool valid = unit == "time" && read.ec == std::errc{} && read.ptr == end && std::isfinite(seconds) &&
                       seconds >= 0 && seconds <= longest_time_s;
    if (!valid) {
        return std::nullopt;
    }
    return Moment{Moment::Unit::time, 0, std::chrono::duration_cast<Duration>(std::chrono::duration<double>{seconds})};
}

std::optional<Deed> read_input(std::string_view text) {
    const auto input = protocol::input_from_contact(take_word(text));
    const auto on = read_either(text, "on", "off");
    return input && on ? std::optional<Deed>{SetInput{*input, *on}} : std::nullopt;
}

std::optional<Deed> read_error(std::string_view text) {
    const auto code = protocol::read_decimal<std::uint32_t>(text);
    return code && *code > 0 && *code <= largest_error_code ? std::optional<Deed>{RaiseError{*code}} : std::nullopt;
}

std::optional<Deed> read_trouble(Trouble trouble, std::string_view text) {
    const auto times = text.empty() ? 1U : protocol::read_decimal<std::uint32_t>(text);
    return times && *times > 0 ? std::optional<Deed>{ExpectTrouble{trouble, *times}} : std::nullopt;
}

/// What is behind the moment; `text` has no blanks around it.
std::optional<Deed> read_deed(std::string_view text) {
    const std::string_view word = take_word(text);
    for (const Key& key : keys) {
        if (word == key.word) {
            return text.empty() ? std::optional<Deed>{PressKey{key.action}} : std::nullopt;
        }
    }
    for (const TroubleWord& known : trouble_words) {
        if (word == known.word) {
            return read_trouble(known.trouble, text);
        }
    }
    const auto alone = [text](Deed deed) { return text.empty() ? std::optional{std::move(deed)} : std::nullopt; };
    if (word == "cut") {
        return alone(CutConnections{});
    }
    if (word == "mute" || word == "unmute") {
        return alone(Mute{word == "mute"});
    }
    if (word == "power-cycle") {
        return alone(PowerCycle{});
    }
    if (word == "error") {
        return read_error(text);
    }
    if (word == "input") {
        return read_input(text);
    }
    if (word == "job" && !text.empty()) {
        return LoadJob{std::string{text}};
    }
    if (word == "cover") {
        const auto open = read_either(text, "open", "closed");
        return open ? std::optional<Deed>{MoveCover{*open}} : std::nullopt;
    }
    if (word == "stick") {
        const auto present = read_either(text, "in", "out");
        return present ? std::optional<Deed>{MoveStick{*present}} : std::nullopt;
    }
    return std::nullopt;
}

} // namespace

Result<Fault> parse_fault(std::string_view text) {
    const auto refuse = [text](std::string_view expected) {
        return Failure{FailureKind::usage, '"' + std::string{trimmed(text)} + "\": " + std::string{expected}};
    };
    std::string_view rest = trimmed(text);
    const std::string_view unit = take_word(rest);
    const auto moment = read_moment(unit, take_word(rest));
    if (!moment) {
        return refuse(when_expected);
    }
    auto deed = read_deed(rest);
    if (!deed) {
        return refuse("no such fault; see --help");
    }
    return Fault{*moment, *std::move(deed)};
}

Result<std::vector<Fault>> parse_scenario(std::string_view text) {
    std::vector<Fault> faults;
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = trimmed(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        if (line.empty() || line.front() == '#') {
            continue;
        }
        auto fault = parse_fault(line);
        if (!fault) {
            return Failure{FailureKind::usage, "line " + std::to_string(number) + ": " + fault.error().message};
        }
        faults.push_back(*std::move(fault));
    }
    return faults;
}

std::string_view fault_help() {
    return "WHEN is \"print N\", \"frame N\" or \"time SECONDS\" (counted in this run). WHAT is one of\n"
           "start | stop | open-nozzle | close-nozzle | acknowledge | power-on | power-off (at the panel),\n"
           "error CODE, cover open|closed, job PATH, input CONTACT on|off, stick in|out,\n"
           "cut, mute, unmute, power-cycle, and for the next N occasions (1 unless said otherwise)\n"
           "lose-answer, damage-answer, wrong-crc, refuse-crc, damage-block, refuse-block, cancel-transfer [N]";
}

} // namespace linefeed::simulator
