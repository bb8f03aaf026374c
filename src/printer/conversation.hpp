// A conversation with a printer, kept in a file as one line of JSON for each thing that was said, and read from there:
// decoded into words, or said once more to a printer or to the simulator.
#pragma once

#include "base/failure.hpp"
#include "printer/json.hpp"
#include "printer/printer_client.hpp"
#include "protocol/frame_decoder.hpp"
#include "protocol/messages.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::printer {

/// Bytes that went one way at once: a frame, or what was read or written together.
struct Utterance {
    std::int64_t time_ns = 0; ///< wall time since the Unix epoch
    bool sent = false;        ///< by linefeed
    std::string bytes;
    /// Of all that was said. More than `bytes`: only the beginning was kept, as the service does with long frames and
    /// with records that go out together.
    std::uint64_t size = 0;

    [[nodiscard]] bool whole() const { return size <= bytes.size(); }
    friend bool operator==(const Utterance&, const Utterance&) = default;
};

/// {"time_ns":…,"direction":"sent","bytes":"^0?RS\\x0D"}, and "size" if it is not whole.
[[nodiscard]] std::string to_line(const Utterance& utterance);
/// FailureKind::input if it is no such line.
[[nodiscard]] Result<Utterance> read_line(std::string_view line);

/// A frame of the conversation.
struct SpokenFrame {
    std::int64_t time_ns = 0;
    bool sent = false;
    std::string raw; ///< from `^` up to and without CR
    protocol::Message message;
    bool whole = true; ///< false: its end, or what followed it, was not kept
};
/// {"time_ns", "direction", "command", "what", "fields", "raw", "words"}
[[nodiscard]] Json to_json(const SpokenFrame& frame);

/// Finds the frames. Flow: add() each utterance, in order.
class FrameFinder {
public:
    explicit FrameFinder(protocol::EscapeMode escapes);
    void add(const Utterance& utterance, const std::function<void(const SpokenFrame&)>& on_frame);

private:
    protocol::EscapeMode escapes_;
    std::array<protocol::FrameDecoder, 2> decoders_; ///< received, sent
};

/// What a printer says differently now.
struct Difference {
    std::string asked;    ///< the frame sent before, raw; empty = none
    std::string expected; ///< the frame that came then
    std::string got;      ///< empty = nothing came
    friend bool operator==(const Difference&, const Difference&) = default;
};
struct Rerun {
    std::size_t sent = 0;
    std::size_t compared = 0; ///< frames that came then
    std::vector<Difference> differences;
};

/// Sends once more what was sent then, each frame when as many frames have come as came before it then, and compares.
/// `wait` is called with the time that had passed before each. FailureKind::usage: the recording does not hold
/// everything; ::unreachable: the connection is lost.
[[nodiscard]] Result<Rerun> say_again(PrinterClient& printer, const std::vector<SpokenFrame>& frames,
                                      const std::function<void(Duration)>& wait);

} // namespace linefeed::printer
