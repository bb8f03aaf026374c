// The state machine behind frame_decoder.hpp. Each state takes bytes from the front and says how many; a byte that ends
// something without belonging to it is left for the next state. A bare `^` always begins a frame, so a lost CR costs
// one frame at most. Only an escaped `^` can hide in a frame whose length is wrong: its bytes are then decoded once
// more from there, in place, since the replay never writes beyond where it reads.
#include "protocol/frame_decoder.hpp"

#include "base/assert.hpp"

#include <algorithm>
#include <utility>

namespace linefeed::protocol {

namespace {

constexpr char frame_start = '^';
constexpr char frame_end = '\r';
constexpr char line_feed = '\n';
constexpr char escape = '\\';
constexpr std::size_t head_bytes = 3; ///< `^`, address, group

bool is_filling(char byte) {
    return byte == ' ' || byte == line_feed || byte == '\0';
}
bool is_digit(char byte) {
    return byte >= '0' && byte <= '9';
}
bool is_address(char byte) {
    return is_digit(byte) || (byte >= 'A' && byte <= 'F');
}
/// In a payload: it may end the frame, begin the next, or change the meaning of the byte behind it.
bool is_special(char byte) {
    return byte == frame_end || byte == frame_start || byte == escape;
}
bool is_group(char byte) {
    return std::string_view{"*!?=$"}.find(byte) != std::string_view::npos;
}

} // namespace

DecodeResult FrameDecoder::next(std::string_view& input) {
    while (true) {
        const bool replaying = replay_begin_ < replay_end_;
        const std::string_view bytes =
            replaying ? std::string_view{buffer_.data() + replay_begin_, replay_end_ - replay_begin_} : input;
        if (bytes.empty()) {
            break;
        }
        const Step step = take(bytes);
        if (replaying) {
            replay_begin_ += step.taken;
        } else {
            input.remove_prefix(step.taken);
        }
        if (!std::holds_alternative<std::monostate>(step.result)) {
            return step.result;
        }
    }
    if (garbage_ > 0) {
        return FrameError{FrameErrc::garbage, std::exchange(garbage_, 0)};
    }
    return std::monostate{};
}

void FrameDecoder::reset() {
    state_ = State::between;
    garbage_ = 0;
    replay_begin_ = replay_end_ = 0;
}

FrameDecoder::Step FrameDecoder::take(std::string_view bytes) {
    switch (state_) {
    case State::between:
        return take_between(bytes.front());
    case State::address:
        return take_address(bytes.substr(0, 1));
    case State::head:
        return take_head(bytes.substr(0, 1));
    case State::payload:
        return take_payload(bytes);
    case State::skipping:
        return take_skipping(bytes.front());
    }
    assertion_failed("FrameDecoder::State", __FILE__, __LINE__);
}

FrameDecoder::Step FrameDecoder::take_between(char byte) {
    if (byte != frame_start && byte != frame_end) {
        garbage_ += is_filling(byte) ? 0U : 1U;
        return {1, {}};
    }
    if (garbage_ > 0) {
        return {0, FrameError{FrameErrc::garbage, std::exchange(garbage_, 0)}};
    }
    if (byte == frame_start) {
        state_ = State::address;
        escaped_ = false;
        digits_ = length_ = 0;
        received_ = size_ = 0;
        return keep({&frame_start, 1});
    }
    return {1, {}};
}

FrameDecoder::Step FrameDecoder::take_address(std::string_view bytes) {
    if (bytes.front() == frame_start) {
        return restarted();
    }
    if (!is_address(bytes.front())) {
        return damaged(FrameErrc::bad_address);
    }
    state_ = State::head;
    return keep(bytes);
}

FrameDecoder::Step FrameDecoder::take_head(std::string_view bytes) {
    const char byte = bytes.front();
    if (byte == frame_start) {
        return restarted();
    }
    if (is_digit(byte) && digits_ < length_digits) {
        ++digits_;
        length_ = length_ * 10 + static_cast<std::uint32_t>(byte - '0');
        return keep(bytes);
    }
    constexpr std::uint32_t shortest_length = 2; // the group and the CR
    if (digits_ > 0 && (digits_ < length_digits || length_ < shortest_length)) {
        return damaged(FrameErrc::bad_length);
    }
    if (!is_group(byte)) {
        return damaged(FrameErrc::bad_group);
    }
    state_ = State::payload;
    return keep(bytes);
}

FrameDecoder::Step FrameDecoder::take_payload(std::string_view bytes) {
    const char byte = bytes.front();
    // The length counts from the group to the CR, so this many bytes of the frame precede the CR. Firmware that ends in
    // LF CR may have left the LF out of the count.
    const std::uint64_t expected = head_bytes - 1 + length_digits + length_ - 1;
    const bool has_length = digits_ > 0;
    if (has_length && received_ == expected && byte == line_feed) {
        return keep(bytes.substr(0, 1)); // the only byte that may lie between the counted ones and the CR
    }
    if (has_length && (byte == frame_end) != (received_ >= expected)) {
        return damaged(FrameErrc::bad_length);
    }
    if (byte == frame_end) {
        state_ = State::between;
        return {1, frame()};
    }
    if (byte == frame_start && !escaped_) {
        return restarted();
    }
    const std::string_view window = has_length ? bytes.substr(0, expected - received_) : bytes;
    const auto plain = static_cast<std::size_t>(std::ranges::find_if(window, is_special) - window.begin());
    if (plain > 0) {
        escaped_ = false;
        return keep(window.substr(0, plain));
    }
    escaped_ = byte == escape && !escaped_ && escapes_ == EscapeMode::backslash;
    return keep(window.substr(0, 1));
}

FrameDecoder::Step FrameDecoder::take_skipping(char byte) {
    if (byte != frame_end && byte != frame_start) {
        ++received_;
        return {1, {}};
    }
    state_ = State::between;
    return {0, FrameError{damage_, received_}};
}

/// Adds the bytes to the frame; those beyond the buffer are only counted.
FrameDecoder::Step FrameDecoder::keep(std::string_view bytes) {
    const std::string_view kept = bytes.substr(0, buffer_.size() - size_);
    std::ranges::copy(kept, buffer_.begin() + static_cast<std::ptrdiff_t>(size_));
    size_ += kept.size();
    received_ += bytes.size();
    return {bytes.size(), {}};
}

/// Drops the frame begun: up to the next `^` among its bytes, which are decoded once more from there, or else up to the
/// end that the input shows. The byte at hand is left.
FrameDecoder::Step FrameDecoder::damaged(FrameErrc code) {
    const std::size_t next_start = std::string_view{buffer_.data(), size_}.find(frame_start, 1);
    if (next_start == std::string_view::npos || truncated()) {
        state_ = State::skipping;
        damage_ = code;
        return {0, {}};
    }
    if (replay_begin_ == replay_end_) {
        replay_begin_ = replay_end_ = size_;
    }
    LINEFEED_ASSERT(size_ <= replay_begin_);
    const auto begin = buffer_.begin();
    std::copy_backward(begin + static_cast<std::ptrdiff_t>(next_start), begin + static_cast<std::ptrdiff_t>(size_),
                       begin + static_cast<std::ptrdiff_t>(replay_begin_));
    replay_begin_ -= size_ - next_start;
    state_ = State::between;
    return {0, FrameError{code, next_start}};
}

/// A bare `^` inside the frame: its CR was lost. What is known of an over-long frame is delivered.
FrameDecoder::Step FrameDecoder::restarted() {
    state_ = State::between;
    if (truncated()) {
        return {0, frame()};
    }
    return {0, FrameError{FrameErrc::interrupted, received_}};
}

Frame FrameDecoder::frame() const {
    const std::string_view raw = std::string_view{buffer_.data(), size_};
    const std::size_t group_at = head_bytes - 1 + digits_;
    std::string_view payload = raw.substr(group_at + 1);
    if (!truncated() && payload.ends_with(line_feed)) {
        payload.remove_suffix(1);
    }
    return {.address = raw[1],
            .group = static_cast<Group>(raw[group_at]),
            .payload = payload,
            .raw = raw,
            .has_length = digits_ > 0,
            .truncated = truncated()};
}

} // namespace linefeed::protocol
