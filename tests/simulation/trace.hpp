// What happened, as a hash (a seed run twice must have the same) and, on request, in words.
#pragma once

#include "base/time.hpp"

#include <cstdint>
#include <string_view>

namespace linefeed::simulation {

class Trace {
public:
    explicit Trace(bool verbose)
        : verbose_(verbose) {}

    void note(Instant now, std::string_view what, std::uint64_t a = 0, std::uint64_t b = 0) {
        mix(static_cast<std::uint64_t>(now.time_since_epoch().count()));
        mix(what.size() * 0x10001U + static_cast<unsigned char>(what.front()));
        mix(a);
        mix(b);
        if (verbose_) {
            print(now, what, a, b);
        }
    }
    /// Only in words; bytes that do not print are shown in hex.
    void say(Instant now, std::string_view what, std::string_view text) const {
        if (verbose_) {
            print(now, what, text);
        }
    }
    [[nodiscard]] bool verbose() const { return verbose_; }
    [[nodiscard]] std::uint64_t hash() const { return hash_; }

private:
    void mix(std::uint64_t value) {
        hash_ = (hash_ ^ value) * 0x9FB21C651E98DF25U;
        hash_ ^= hash_ >> 29U;
    }
    static void print(Instant now, std::string_view what, std::uint64_t a, std::uint64_t b);
    static void print(Instant now, std::string_view what, std::string_view text);

    bool verbose_;
    std::uint64_t hash_ = 0x243F6A8885A308D3U;
};

} // namespace linefeed::simulation
