// Whatever arrives on the line: the decoder gives the same frames however the bytes are split, its views stay within
// bounds, and no message and no record makes the parsers misbehave. The first two bytes of the input choose the splits.
#include "base/assert.hpp"
#include "protocol/crc32.hpp"
#include "protocol/frame_decoder.hpp"
#include "protocol/messages.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace linefeed::protocol;

/// A result of the decoder with copies of what its views show.
struct Event {
    Frame frame{};
    std::string payload{};
    std::string raw{};
    FrameError error{};
};

bool same(const Event& a, const Event& b) {
    return a.frame.address == b.frame.address && a.frame.group == b.frame.group &&
           a.frame.has_length == b.frame.has_length && a.frame.truncated == b.frame.truncated &&
           a.payload == b.payload && a.raw == b.raw && a.error == b.error;
}

void check(const Frame& frame) {
    LINEFEED_ASSERT(frame.raw.size() >= 3 && frame.raw.size() <= max_frame_bytes);
    LINEFEED_ASSERT(frame.raw.front() == '^');
    LINEFEED_ASSERT(frame.raw.find('\r') == std::string_view::npos);
    const std::size_t head = frame.has_length ? 8 : 3;
    LINEFEED_ASSERT(frame.payload.data() == frame.raw.data() + head);
    LINEFEED_ASSERT(frame.payload.size() + head <= frame.raw.size());
    LINEFEED_ASSERT(!frame.truncated || frame.raw.size() == max_frame_bytes);
    static_cast<void>(crc32(frame.raw));
}

/// What the printer or the host would do with the frame: nothing may be read that was not there.
void parse(const Frame& frame, EscapeMode escapes) {
    const Message message = parse_message(frame, escapes);
    if (const auto* const status = std::get_if<MachineStatus>(&message)) {
        LINEFEED_ASSERT(!to_string(status->nozzle).empty() && !to_string(status->machine).empty());
        LINEFEED_ASSERT(!describe(status->error).empty());
        std::string out;
        append_message(out, *status);
    }
    const auto record = parse_mail_record(frame.payload, escapes);
    LINEFEED_ASSERT(!record || record->fields.size() <= max_fields);
    LINEFEED_ASSERT(unescape(frame.payload, escapes).size() <= frame.payload.size());
}

/// Adds the events of one chunk; garbage reported in parts is put together.
void feed(FrameDecoder& decoder, std::string_view chunk, EscapeMode escapes, std::vector<Event>& events) {
    while (true) {
        const DecodeResult result = decoder.next(chunk);
        if (const auto* const frame = std::get_if<Frame>(&result)) {
            check(*frame);
            parse(*frame, escapes);
            events.push_back({*frame, std::string{frame->payload}, std::string{frame->raw}, {}});
        } else if (const auto* const error = std::get_if<FrameError>(&result)) {
            LINEFEED_ASSERT(error->bytes > 0);
            const bool goes_on = error->code == FrameErrc::garbage && !events.empty() && events.back().raw.empty() &&
                                 events.back().error.code == FrameErrc::garbage && events.back().error.bytes > 0;
            if (goes_on) {
                events.back().error.bytes += error->bytes;
            } else {
                events.push_back({{}, {}, {}, *error});
            }
        } else {
            LINEFEED_ASSERT(chunk.empty());
            return;
        }
    }
}

void check_splits(std::string_view bytes, EscapeMode escapes, std::size_t step, std::size_t more) {
    std::vector<Event> whole;
    FrameDecoder decoder{escapes};
    feed(decoder, bytes, escapes, whole);

    std::vector<Event> split;
    decoder = FrameDecoder{escapes};
    for (std::size_t size = step + 1; !bytes.empty(); size = 1 + (size + more) % 257) {
        const std::string chunk{bytes.substr(0, size)};
        feed(decoder, chunk, escapes, split);
        bytes.remove_prefix(chunk.size());
    }

    LINEFEED_ASSERT(whole.size() == split.size());
    for (std::size_t i = 0; i < whole.size(); ++i) {
        LINEFEED_ASSERT(same(whole[i], split[i]));
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 2) {
        return 0;
    }
    const std::string bytes(data + 2, data + size);
    check_splits(bytes, EscapeMode::backslash, data[0], data[1]);
    check_splits(bytes, EscapeMode::none, data[0], data[1]);
    return 0;
}
