// Texts that stand inside parameters: graphics, nibbles, short dates, firmware versions. What is read can be written,
// and reads the same.
#include "base/assert.hpp"
#include "protocol/graphic.hpp"
#include "protocol/nibbles.hpp"
#include "protocol/printer_time.hpp"
#include "protocol/profile.hpp"

#include <cstddef>
#include <cstdint>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace linefeed::protocol;
    const std::string text(data, data + size);
    if (const auto graphic = parse_graphic(text)) {
        std::string written;
        append_graphic(written, *graphic);
        LINEFEED_ASSERT(parse_graphic(written) == graphic);
        static_cast<void>(graphic->dot(graphic->width - 1, graphic->height - 1));
    }
    if (const auto bytes = read_nibbles(text)) {
        std::string written;
        append_nibbles(written, *bytes);
        LINEFEED_ASSERT(written == text);
    }
    if (const auto time = read_short_date(text)) {
        std::string written;
        append_short_date(written, *time);
        LINEFEED_ASSERT(read_short_date(written) == time);
        if (const auto moment = to_sys_seconds(*time)) {
            LINEFEED_ASSERT(to_printer_time(*moment) == *time && weekday_of(*moment) <= 6);
        }
    }
    for (const char* const type : {"JET3", "JET3up", "JET2neo"}) {
        static_cast<void>(profile_for(type, text));
    }
    static_cast<void>(profile_for(text, "V60.0.1.17"));
    return 0;
}
