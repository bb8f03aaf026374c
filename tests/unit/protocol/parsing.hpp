// From the bytes of one frame to its message and back, for tests that speak in literal frames.
#pragma once

#include "protocol/frame_decoder.hpp"
#include "protocol/messages.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace linefeed::protocol {

/// The message in a stream of one frame.
inline Message parsed(std::string_view bytes, EscapeMode escapes = EscapeMode::backslash) {
    FrameDecoder decoder{escapes};
    const DecodeResult result = decoder.next(bytes);
    const auto* const frame = std::get_if<Frame>(&result);
    EXPECT_NE(frame, nullptr) << bytes;
    return frame != nullptr ? parse_message(*frame, escapes) : Message{};
}

template <typename T>
T parsed_as(std::string_view bytes, EscapeMode escapes = EscapeMode::backslash) {
    const Message message = parsed(bytes, escapes);
    const auto* const malformed = std::get_if<MalformedMessage>(&message);
    EXPECT_TRUE(std::holds_alternative<T>(message))
        << bytes << " is alternative " << message.index() << (malformed != nullptr ? ": " + malformed->reason : "");
    const T* const typed = std::get_if<T>(&message);
    return typed != nullptr ? *typed : T{};
}

/// Why the frame cannot be read.
inline std::string reason(std::string_view bytes) {
    return parsed_as<MalformedMessage>(bytes).reason;
}

inline std::string encoded(const Message& message, EscapeMode escapes = EscapeMode::backslash) {
    std::string out = ">"; // encoders append
    append_any_message(out, message, escapes);
    return out.substr(1);
}

/// What the frame says, written again.
inline std::string rewritten(std::string_view bytes, EscapeMode escapes = EscapeMode::backslash) {
    return encoded(parsed(bytes, escapes), escapes);
}

} // namespace linefeed::protocol
