// Finds frames in a byte stream (protocol, section 1). One read is not one message: bytes arrive in any split, LF may
// follow CR or precede it, blanks fill a block (`=FL`), a length may stand behind the address (`!LN`), a line may be
// damaged. The decoder is bounded and never stops for good: whatever comes, it goes on at the next `^`.
#pragma once

#include "protocol/escapes.hpp"
#include "protocol/frame.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>

namespace linefeed::protocol {

/// What is wrong with bytes that are not a frame.
enum class FrameErrc {
    garbage,     ///< bytes outside any frame that are neither CR, LF, NUL nor blank
    interrupted, ///< a new `^` before the CR of the frame (a CR was lost): the first part is dropped
    bad_address, ///< the byte behind `^` is not 0-9 or A-F
    bad_group,   ///< the byte behind the address (and length) is not one of the five groups
    bad_length, ///< the length of `!LN` does not agree with the place of the CR, a LF directly before it counted or not
};

/// One damaged stretch of the stream.
struct FrameError {
    FrameErrc code = FrameErrc::garbage;
    /// How many bytes were dropped, from `^` up to and without the CR; for garbage without blanks and the like.
    std::uint64_t bytes = 0;

    friend bool operator==(const FrameError&, const FrameError&) = default;
};

/// Needs more bytes, a frame, or an error.
using DecodeResult = std::variant<std::monostate, Frame, FrameError>;

/// Flow: for each chunk of bytes, call next() until it returns std::monostate; it takes bytes from the front of
/// `input`. Memory is bounded by max_frame_bytes; nothing is allocated.
class FrameDecoder {
public:
    explicit FrameDecoder(EscapeMode escapes = EscapeMode::backslash)
        : escapes_(escapes) {}

    /// Consumes bytes from `input` up to the end of the next frame or error, or all of them. The same bytes give the
    /// same results however they are split, except that a run of garbage may be reported in several parts.
    [[nodiscard]] DecodeResult next(std::string_view& input);

    /// Forgets a frame begun: for a new connection.
    void reset();

private:
    enum class State : std::uint8_t {
        between,  ///< outside any frame: ends of lines, filling, garbage
        address,  ///< behind `^`
        head,     ///< behind the address: the digits of a length, or the group
        payload,  ///< behind the group
        skipping, ///< in a frame that is damaged: up to its CR or the next `^`
    };
    /// What one state made of the bytes at hand.
    struct Step {
        std::size_t taken = 0;
        DecodeResult result;
    };

    [[nodiscard]] Step take(std::string_view bytes);
    [[nodiscard]] Step take_between(char byte);
    [[nodiscard]] Step take_address(std::string_view bytes);
    [[nodiscard]] Step take_head(std::string_view bytes);
    [[nodiscard]] Step take_payload(std::string_view bytes);
    [[nodiscard]] Step take_skipping(char byte);

    [[nodiscard]] Step keep(std::string_view bytes);
    [[nodiscard]] Step damaged(FrameErrc code);
    [[nodiscard]] Step restarted();
    [[nodiscard]] Frame frame() const;
    [[nodiscard]] bool truncated() const { return received_ > max_frame_bytes; }

    static constexpr std::size_t length_digits = 5;

    EscapeMode escapes_;
    State state_ = State::between;
    bool escaped_ = false;                  ///< the last byte of the payload was a `\` that escapes the next one
    std::uint32_t digits_ = 0;              ///< digits of the length seen
    std::uint32_t length_ = 0;              ///< their value
    FrameErrc damage_ = FrameErrc::garbage; ///< why the state is skipping
    std::uint64_t garbage_ = 0;             ///< bytes of garbage not yet reported
    std::uint64_t received_ = 0;            ///< bytes of the frame since `^`, also those dropped
    std::size_t size_ = 0;                  ///< bytes of the frame in buffer_
    std::size_t replay_begin_ = 0;          ///< bytes of a damaged frame that are decoded once more: they lie
    std::size_t replay_end_ = 0;            ///< behind the frame in buffer_ and come before the input
    std::array<char, max_frame_bytes> buffer_{};
};

} // namespace linefeed::protocol
