// Secured transmission besides the feeding (protocol, section 6): each frame is announced by its CRC32, the printer
// says whether it was right, and of its own frames only those count that were announced and are right.
#include "printer/printer_client.hpp"

#include <algorithm>
#include <utility>

namespace linefeed::printer {

using protocol::Action;
using protocol::Parameter;
using protocol::SecuredLine;
using Kind = SecuredLine::Kind;
using Word = protocol::SecuredReader::Word;

namespace {

constexpr std::size_t group_place = 2;
constexpr std::size_t code_letters = 2;
constexpr std::string_view power_off = "^0!PF\r";

char group_of(std::string_view frame) {
    return frame.size() > group_place ? frame[group_place] : '\0';
}

std::string_view code_of(std::string_view frame) {
    return frame.substr(std::min(frame.size(), group_place + 1), code_letters);
}

Instant now() {
    return Instant{std::chrono::steady_clock::now().time_since_epoch()};
}

/// Files have checks of their own, and are outside of this. In standby the printer knows nothing of it.
bool goes_bare(std::string_view frame) {
    return group_of(frame) == '$' || (group_of(frame) == '!' && (code_of(frame) == code(Action::power_on) ||
                                                                 code_of(frame) == code(Action::restart)));
}

/// Whether the frame sent twice does the same as sent once. Not `!EQ`, which could meet an error that nobody has seen;
/// nor a line of a script, or a step of a motor, of which two are more than one.
bool may_repeat(std::string_view frame) {
    constexpr std::array once_actions{Action::acknowledge_errors, Action::start_print, Action::motor_open,
                                      Action::motor_close, Action::reset_counters};
    constexpr std::array once_parameters{Parameter::CC, Parameter::MR, Parameter::RC};
    const auto is = [letters = code_of(frame)](auto command) { return code(command) == letters; };
    switch (group_of(frame)) {
    case '!':
        return std::ranges::none_of(once_actions, is);
    case '=':
        return std::ranges::none_of(once_parameters, is);
    default:
        return group_of(frame) == '?';
    }
}

SecuredLine::Frame secured_frame(std::string_view frame) {
    const auto what = group_of(frame) == '?' ? protocol::parameter_from_code(code_of(frame)) : std::nullopt;
    const Kind kind = what ? Kind::inquiry : may_repeat(frame) ? Kind::command : Kind::once;
    return {.kind = kind, .what = what.value_or(Parameter::SM), .bytes = std::string{frame}};
}

} // namespace

/// Without a listener it is done when the printer says that the frame was right.
bool PrinterClient::exchange(std::string_view frame, const Listener& listener, Duration reply_timeout) {
    if (goes_bare(frame)) {
        return write(std::string{frame}) && (listener == nullptr || listen(listener, reply_timeout));
    }
    line_.add(secured_frame(frame));
    static_cast<void>(line_.begin());
    to_send_ = true;
    bool done = false;
    bool answered = false;
    const bool proven = settle([&](const protocol::Message& message, std::string_view raw) {
        const Heard heard = listener == nullptr || done ? Heard::ignored : listener(message, raw);
        done = done || heard == Heard::done;
        answered = answered || heard != Heard::ignored;
        return heard;
    });
    if (frame == power_off) {
        line_reader_.forget();
    }
    if (done || listener == nullptr) {
        return done || proven;
    }
    return (proven || answered) && listen(listener, reply_timeout);
}

/// Until the frame that is under way is settled, or nothing comes for a reply time-out: true if the printer has shown
/// that it has arrived.
bool PrinterClient::settle(const Listener& listener) {
    constexpr auto at_least = std::chrono::milliseconds{20};
    const Duration longest_frame = time_on_line(protocol::max_frame_bytes);
    const auto latest = Clock::now() + longest_frame + settings_.reply_timeout;
    auto heard_at = Clock::now() + time_on_line(line_.current().bytes.size());
    while (open_ && line_.busy() && Clock::now() < heard_at + settings_.reply_timeout) {
        if (std::exchange(to_send_, false)) {
            if (!write(std::string{line_.announced(now())})) {
                break;
            }
        }
        const auto deadline = Clock::time_point{line_.deadline()->time_since_epoch()};
        const std::string_view bytes = read(std::max(deadline, Clock::now() + at_least));
        heard_at = bytes.empty() ? heard_at : Clock::now();
        const bool goes_on = settings_.endpoints.serial && !bytes.empty() && Clock::now() < latest;
        static_cast<void>(hear(bytes, listener));
        if (!goes_on && !to_send_) {
            step(line_.on_time(now()));
        }
    }
    if (line_.busy()) {
        line_.give_up();
        return false;
    }
    return line_.proven();
}

void PrinterClient::step(SecuredLine::Step step) {
    to_send_ = to_send_ || step == SecuredLine::Step::send;
}

/// Takes what belongs to the transmission itself, and drops what was not announced or is damaged.
PrinterClient::Heard PrinterClient::take_secured(const protocol::Frame& frame, const protocol::Message& message,
                                                 const Listener& listener) {
    const Word word = line_reader_.read(frame, line_);
    if (frame.group == protocol::Group::file) {
        return listener == nullptr ? Heard::ignored : listener(message, frame.raw);
    }
    oddities_.unsecured = line_reader_.unsecured();
    switch (word) {
    case Word::announcement:
        break;
    case Word::right:
        step(line_.on_right(now()));
        break;
    case Word::refused:
        step(line_.on_refused());
        break;
    case Word::proven:
        return take_proven(frame, message, listener);
    case Word::standby:
        return take_standby(frame, message, listener);
    case Word::damaged:
        oddities_.damaged_bytes += frame.raw.size();
        line_.on_echo(frame.raw);
        break;
    case Word::bare:
        line_.on_echo(frame.raw);
        if (oddities_.unsecured) {
            line_.clear();
        }
        break;
    }
    return Heard::ignored;
}

PrinterClient::Heard PrinterClient::take_proven(const protocol::Frame& frame, const protocol::Message& message,
                                                const Listener& listener) {
    line_.on_echo(frame.raw);
    if (line_.syncing()) {
        const auto what = protocol::parameter_from_code(code_of(frame.raw));
        step(what ? line_.on_answer(*what, now()) : SecuredLine::Step::wait);
        return Heard::ignored;
    }
    const Heard heard = listener == nullptr ? Heard::ignored : listener(message, frame.raw);
    if (heard != Heard::ignored && line_.busy()) {
        const bool inquiry = line_.current().kind == Kind::inquiry;
        step(inquiry ? line_.on_answer(line_.current().what, now()) : line_.on_right(now()));
    }
    return heard;
}

PrinterClient::Heard PrinterClient::take_standby(const protocol::Frame& frame, const protocol::Message& message,
                                                 const Listener& listener) {
    const Heard heard = listener == nullptr ? Heard::ignored : listener(message, frame.raw);
    if (heard == Heard::done) {
        line_.clear();
    }
    return heard;
}

} // namespace linefeed::printer
