// Secured transmission besides the feeding (protocol, section 6): each frame is announced by its CRC32, the printer
// says whether it was right, and of its own frames only those count that were announced and are right.
#include "printer/printer_client.hpp"
#include "protocol/crc32.hpp"

#include <algorithm>
#include <utility>

namespace linefeed::printer {

namespace {

constexpr int max_tries = 5;
constexpr std::size_t group_place = 2;

char group_of(std::string_view frame) {
    return frame.size() > group_place ? frame[group_place] : '\0';
}

/// Whether the frame may be sent again when nobody knows whether it has arrived. Not `!EQ`, which could meet an error
/// that nobody has seen; nor a line of a script, of which two are more than one.
bool may_repeat(std::string_view frame) {
    return group_of(frame) != '*' && !frame.ends_with("!EQ\r");
}

} // namespace

/// Without a listener it is done when the printer says that the frame was right.
bool PrinterClient::exchange(std::string_view frame, const Listener* listener, Duration reply_timeout) {
    if (group_of(frame) == '$') { // has checks of its own, and is outside of this
        return write(std::string{frame}) && (listener == nullptr || listen(*listener, reply_timeout));
    }
    for (int tries = 0; tries < max_tries && open_; ++tries) {
        if (try_exchange(frame, listener, reply_timeout)) {
            return true;
        }
        if (answered_ || (word_ != Word::refused && !may_repeat(frame))) {
            return false;
        }
    }
    return false;
}

bool PrinterClient::try_exchange(std::string_view frame, const Listener* listener, Duration reply_timeout) {
    constexpr Duration word_within = std::chrono::milliseconds{500};
    word_ = Word::none;
    answered_ = false;
    announced_crc_.reset();
    const std::uint32_t crc = protocol::crc32(frame.substr(0, frame.size() - 1));
    if (!write(frame_of(protocol::NextCrc{crc}).append(frame))) {
        return false;
    }
    const auto begun = Clock::now();
    auto deadline = begun + std::min(reply_timeout, word_within) + time_on_line(frame.size());
    const Listener nobody = [](const protocol::Message&, std::string_view) { return Heard::ignored; };
    while (open_ && Clock::now() < deadline) {
        const bool was_right = word_ == Word::right;
        bool prolonged = false;
        const std::string_view bytes = read(deadline);
        if (hear(bytes, listener == nullptr ? nobody : *listener, prolonged)) {
            return true;
        }
        if (word_ == Word::refused || (word_ == Word::right && listener == nullptr)) {
            return word_ == Word::right;
        }
        if (prolonged || (!was_right && word_ == Word::right) || (settings_.endpoints.serial && !bytes.empty())) {
            deadline = Clock::now() + reply_timeout;
        }
    }
    return false;
}

/// Takes what belongs to the transmission itself, and drops what was not announced or is damaged.
bool PrinterClient::is_for_listener(const protocol::Frame& frame, const protocol::Message& message) {
    if (frame.group == protocol::Group::file) {
        return true;
    }
    if (const auto* const next = std::get_if<protocol::NextCrc>(&message)) {
        announced_crc_ = next->crc;
        return false;
    }
    const auto announced = std::exchange(announced_crc_, std::nullopt);
    if (std::holds_alternative<protocol::CrcFailed>(message)) {
        word_ = Word::refused;
        return false;
    }
    if (const auto* const action = std::get_if<protocol::ActionMessage>(&message);
        action != nullptr && action->action == protocol::Action::crc_ok) {
        word_ = Word::right;
        return false;
    }
    if (announced && protocol::is_announced_by(frame.raw, *announced)) {
        return true;
    }
    oddities_.damaged_bytes += frame.raw.size();
    return false;
}

} // namespace linefeed::printer
