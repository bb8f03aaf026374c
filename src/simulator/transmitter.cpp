// Frames on the wire, see transmitter.hpp.
#include "simulator/transmitter.hpp"

#include "base/assert.hpp"
#include "protocol/crc32.hpp"
#include "protocol/frame_encoder.hpp"

namespace linefeed::simulator {
namespace {

/// `^0<group>…CR` taken apart: where the group character stands.
constexpr std::size_t group_place = 2;

} // namespace

std::string Transmitter::with_length(std::string_view frame) const {
    LINEFEED_ASSERT(frame.size() > group_place + 1 && frame.back() == '\r');
    if (!length_on_) {
        return std::string{frame};
    }
    std::string out;
    const auto payload = frame.substr(group_place + 1, frame.size() - group_place - 2);
    protocol::append_frame_with_length(out, static_cast<protocol::Group>(frame[group_place]), payload);
    return out;
}

void Transmitter::append(std::string& out, std::string_view frame, bool secured) const {
    if (secured) {
        const std::string sent = with_length(frame);
        const std::uint32_t crc = protocol::crc32(std::string_view{sent}.substr(0, sent.size() - 1));
        std::string announcement;
        protocol::append_frame(announcement, protocol::Group::parameter, "NR" + std::to_string(crc));
        append_one(out, announcement);
    }
    append_one(out, frame);
}

void Transmitter::append_one(std::string& out, std::string_view frame) const {
    const std::size_t begin = out.size();
    out += with_length(frame);
    switch (line_end_) {
    case LineEnd::cr:
        break;
    case LineEnd::cr_lf:
        out += '\n';
        break;
    case LineEnd::lf_cr:
        out.insert(out.size() - 1, 1, '\n');
        break;
    }
    if (block_length_ != 0) {
        const std::size_t excess = (out.size() - begin) % block_length_;
        out.append(excess == 0 ? 0 : block_length_ - excess, ' ');
    }
}

} // namespace linefeed::simulator
