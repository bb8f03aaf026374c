#include "trace.hpp"

#include <cstdio>
#include <string>

namespace linefeed::simulation {

namespace {

double seconds(Instant now) {
    return std::chrono::duration<double>(now.time_since_epoch()).count();
}

} // namespace

void Trace::print(Instant now, std::string_view what, std::uint64_t a, std::uint64_t b) {
    std::printf("%16.6f %-22.*s %llu %llu\n", seconds(now), static_cast<int>(what.size()), what.data(),
                static_cast<unsigned long long>(a), static_cast<unsigned long long>(b));
}

void Trace::print(Instant now, std::string_view what, std::string_view text) {
    constexpr std::size_t most = 400;
    std::string shown;
    for (const char c : text.substr(0, most)) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '\t') {
            shown += ' ';
        } else if (c == '\r') {
            shown += '|';
        } else if (byte < 0x20 || byte >= 0x7F) {
            char hex[8];
            std::snprintf(hex, sizeof hex, "<%02X>", byte);
            shown += hex;
        } else {
            shown += c;
        }
    }
    std::printf("%16.6f %-22.*s %s%s\n", seconds(now), static_cast<int>(what.size()), what.data(), shown.c_str(),
                text.size() > most ? " …" : "");
}

} // namespace linefeed::simulation
