#include "protocol/secured_reader.hpp"

#include "protocol/crc32.hpp"
#include "protocol/messages.hpp"

#include <string_view>
#include <utility>

namespace linefeed::protocol {

namespace {

bool is_parameter(const Frame& frame, Parameter what) {
    return frame.group == Group::parameter && frame.payload.starts_with(code(what));
}

/// `!OK`, also with one byte damaged: of a frame that it did not check the printer says nothing, and `=FC` differs in
/// all three letters. Were a refused record taken for right, it would be missing, and the printer would stop at the gap
/// behind a record with a number.
bool is_right(const Frame& frame) {
    const std::string_view word = frame.payload.substr(0, frame.payload.find_last_not_of(' ') + 1);
    if (word.size() != 2) {
        return false;
    }
    const int differing = (frame.group != Group::action ? 1 : 0) + (word[0] != 'O' ? 1 : 0) + (word[1] != 'K' ? 1 : 0);
    return differing <= 1;
}

/// Of `=NR` and `=RS`, in which nothing is escaped.
template <typename Expected>
std::optional<Expected> message_of(const Frame& frame) {
    const Message message = parse_message(frame, EscapeMode::backslash);
    const auto* const expected = std::get_if<Expected>(&message);
    return expected != nullptr ? std::optional{*expected} : std::nullopt;
}

} // namespace

SecuredReader::Word SecuredReader::read(const Frame& frame, const SecuredLine& line) {
    const auto announced = std::exchange(announced_, std::nullopt);
    if (is_parameter(frame, Parameter::NR)) {
        if (const auto next = message_of<NextCrc>(frame); next && next->crc != line.announced_sum()) {
            announced_ = next->crc; // or it is an echo of ours
        }
        return Word::announcement;
    }
    const bool proven = announced && is_announced_by(frame.raw, *announced);
    const bool right = !proven && is_right(frame);
    const bool refused = !proven && is_parameter(frame, Parameter::FC);
    secured_once_ = secured_once_ || proven || right || refused;
    if (secured_once_) {
        bare_answers_ = 0;
        return proven      ? Word::proven
               : right     ? Word::right
               : refused   ? Word::refused
               : announced ? Word::damaged
                           : Word::bare;
    }
    if (announced) {
        return Word::damaged;
    }
    if (is_parameter(frame, Parameter::RS)) {
        const auto status = message_of<MachineStatus>(frame);
        if (status && status->machine == MachineState::standby) {
            return Word::standby;
        }
    }
    const auto what = parameter_from_code(frame.payload.substr(0, 2));
    if (frame.group == Group::parameter && what && line.is(*what)) {
        ++bare_answers_;
    }
    return Word::bare;
}

void SecuredReader::forget() {
    *this = {};
}

} // namespace linefeed::protocol
