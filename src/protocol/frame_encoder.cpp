// Frames as bytes, see frame_encoder.hpp.
#include "protocol/frame_encoder.hpp"

#include "base/assert.hpp"

#include <array>

namespace linefeed::protocol {

namespace {

constexpr char frame_start = '^';
constexpr char frame_end = '\r';
constexpr std::size_t length_digits = 5;

void append_head(std::string& out) {
    out.push_back(frame_start);
    out.push_back(printer_address);
}

void append_body(std::string& out, Group group, std::string_view payload) {
    LINEFEED_ASSERT(payload.find(frame_end) == std::string_view::npos);
    out.push_back(static_cast<char>(group));
    out.append(payload);
    out.push_back(frame_end);
}

} // namespace

void append_frame(std::string& out, Group group, std::string_view payload) {
    append_head(out);
    append_body(out, group, payload);
}

void append_action(std::string& out, Action action) {
    append_frame(out, Group::action, code(action));
}

void append_inquiry(std::string& out, Parameter parameter) {
    append_frame(out, Group::inquiry, code(parameter));
}

void append_frame_with_length(std::string& out, Group group, std::string_view payload) {
    constexpr std::size_t group_and_cr = 2;
    std::size_t rest = payload.size() + group_and_cr;
    std::array<char, length_digits> digits{};
    for (std::size_t i = length_digits; i-- > 0;) {
        digits[i] = static_cast<char>('0' + rest % 10);
        rest /= 10;
    }
    LINEFEED_ASSERT(rest == 0);
    append_head(out);
    out.append(digits.data(), digits.size());
    append_body(out, group, payload);
}

} // namespace linefeed::protocol
