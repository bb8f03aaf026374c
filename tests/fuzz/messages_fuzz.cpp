// Every message of the protocol: what is read can be written, and what is written reads the same. The lists, listings
// and pictures that messages make together stay within their bounds.
#include "base/assert.hpp"
#include "protocol/frame_decoder.hpp"
#include "protocol/messages.hpp"
#include "protocol/wysiwyg.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace {

using namespace linefeed::protocol;

/// The one frame in the bytes; null if there is none or another number of them.
const Frame* only_frame(FrameDecoder& decoder, std::string_view bytes, DecodeResult& result) {
    result = decoder.next(bytes);
    const auto* const frame = std::get_if<Frame>(&result);
    return bytes.empty() ? frame : nullptr;
}

void check_round_trip(const Message& message, EscapeMode escapes) {
    std::string written;
    append_any_message(written, message, escapes);
    if (escapes == EscapeMode::none && written.find('^', 1) != std::string::npos) {
        return; // firmware without escapes cannot be sent a ^
    }
    if (written.ends_with("\n\r")) {
        return; // a LF directly before the CR belongs to the end of the frame
    }
    FrameDecoder decoder{escapes};
    DecodeResult result;
    const Frame* const frame = only_frame(decoder, written, result);
    LINEFEED_ASSERT(frame != nullptr);
    std::string again;
    append_any_message(again, parse_message(*frame, escapes), escapes);
    if (std::holds_alternative<MailRecord>(message) || std::holds_alternative<ExternText>(message) ||
        std::holds_alternative<DirectoryBlock>(message)) {
        return; // what is cut at the printer's limit, or looks like properties or a directory, may read differently
    }
    LINEFEED_ASSERT(again == written);
}

/// What several messages make together.
struct Assemblies {
    ListAssembly<ErrorListBlock> errors;
    ListAssembly<EventListBlock> events;
    DirectoryListing listing;
    WysiwygAssembly picture;

    void add(const Message& message) {
        if (const auto* const block = std::get_if<ErrorListBlock>(&message)) {
            static_cast<void>(errors.add(*block));
            LINEFEED_ASSERT(errors.entries().size() <= ListAssembly<ErrorListBlock>::max_total);
        } else if (const auto* const event_block = std::get_if<EventListBlock>(&message)) {
            static_cast<void>(events.add(*event_block));
            LINEFEED_ASSERT(events.entries().size() <= ListAssembly<EventListBlock>::max_total);
        } else if (const auto* const directory = std::get_if<DirectoryBlock>(&message)) {
            static_cast<void>(listing.add(*directory));
        } else if (const auto* const line = std::get_if<WysiwygLine>(&message)) {
            picture.add(*line);
            if (const auto image = picture.image()) {
                LINEFEED_ASSERT(image->delivered() <= image->width);
                static_cast<void>(to_lines(*image));
            }
        } else if (const auto* const states = std::get_if<ExternalStates>(&message)) {
            LINEFEED_ASSERT(!describe_inputs(states->inputs.value_or(0)).empty());
        } else if (const auto* const history = std::get_if<ServiceHistory>(&message)) {
            const auto packed = static_cast<std::uint32_t>(history->last_service_date.value_or(0));
            LINEFEED_ASSERT(pack_date(unpack_date(packed)) == packed);
        }
    }
};

void read_all(std::string_view bytes, EscapeMode escapes) {
    FrameDecoder decoder{escapes};
    Assemblies assemblies;
    while (true) {
        const DecodeResult result = decoder.next(bytes);
        if (std::holds_alternative<std::monostate>(result)) {
            return;
        }
        if (const auto* const frame = std::get_if<Frame>(&result)) {
            const Message message = parse_message(*frame, escapes);
            check_round_trip(message, escapes);
            assemblies.add(message);
        }
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string bytes(data, data + size);
    read_all(bytes, EscapeMode::backslash);
    read_all(bytes, EscapeMode::none);
    return 0;
}
