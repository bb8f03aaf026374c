// Runs a decoder over bytes and tells what came out as lines, so that a failing test prints a story.
#pragma once

#include "protocol/frame_decoder.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::protocol {

inline std::string_view name(FrameErrc code) {
    switch (code) {
    case FrameErrc::garbage:
        return "garbage";
    case FrameErrc::interrupted:
        return "interrupted";
    case FrameErrc::bad_address:
        return "bad_address";
    case FrameErrc::bad_group:
        return "bad_group";
    case FrameErrc::bad_length:
        return "bad_length";
    }
    return "?";
}

/// E.g. "0=RS2 [^0=RS2]", with " length" and " truncated" where they apply.
inline std::string story(const Frame& frame) {
    std::string line{frame.address, static_cast<char>(frame.group)};
    line.append(frame.payload).append(" [").append(frame.raw).append("]");
    line += frame.has_length ? " length" : "";
    line += frame.truncated ? " truncated" : "";
    return line;
}

/// E.g. "bad_group 2".
inline std::string story(const FrameError& error) {
    return std::string{name(error.code)} + " " + std::to_string(error.bytes);
}

/// Adds what the decoder makes of one more chunk. Garbage reported in several parts is put together, as the parts
/// depend on the split.
inline void feed(FrameDecoder& decoder, std::string_view chunk, std::vector<std::string>& stories,
                 std::uint64_t& garbage) {
    const auto flush = [&] {
        if (garbage > 0) {
            stories.push_back(story(FrameError{FrameErrc::garbage, garbage}));
            garbage = 0;
        }
    };
    while (true) {
        const DecodeResult result = decoder.next(chunk);
        if (const auto* const frame = std::get_if<Frame>(&result)) {
            flush();
            stories.push_back(story(*frame));
        } else if (const auto* const error = std::get_if<FrameError>(&result)) {
            if (error->code == FrameErrc::garbage) {
                garbage += error->bytes;
            } else {
                flush();
                stories.push_back(story(*error));
            }
        } else {
            return;
        }
    }
}

/// What comes out of `bytes` given in chunks that end at `cuts` (ascending).
inline std::vector<std::string> decode(std::string_view bytes, EscapeMode escapes = EscapeMode::backslash,
                                       const std::vector<std::size_t>& cuts = {}) {
    FrameDecoder decoder{escapes};
    std::vector<std::string> stories;
    std::uint64_t garbage = 0;
    std::size_t begin = 0;
    for (const std::size_t cut : cuts) {
        // A copy of exactly the chunk, so that a sanitizer sees a read beyond it.
        const std::string chunk{bytes.substr(begin, cut - begin)};
        feed(decoder, chunk, stories, garbage);
        begin = cut;
    }
    feed(decoder, bytes.substr(begin), stories, garbage);
    if (garbage > 0) {
        stories.push_back(story(FrameError{FrameErrc::garbage, garbage}));
    }
    return stories;
}

/// The chunks of one byte each.
inline std::vector<std::size_t> every_byte(std::size_t size) {
    std::vector<std::size_t> cuts(size);
    std::generate(cuts.begin(), cuts.end(), [n = std::size_t{0}]() mutable { return ++n; });
    return cuts;
}

} // namespace linefeed::protocol
