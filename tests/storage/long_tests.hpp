// Every program of this folder runs a slice in CI, and everything with `--long` or LINEFEED_LONG_TESTS=1.
#pragma once

#include <cstdlib>
#include <string_view>

namespace linefeed::test {

inline bool& long_tests() {
    static bool wanted = [] {
        const char* value = std::getenv("LINEFEED_LONG_TESTS");
        return value != nullptr && std::string_view{value} != "" && std::string_view{value} != "0";
    }();
    return wanted;
}

/// Takes `--long` from the command line.
inline void read_long_option(int argc, char** argv) {
    for (int i = 1; i < argc; ++i) {
        long_tests() = long_tests() || std::string_view{argv[i]} == "--long";
    }
}

} // namespace linefeed::test
