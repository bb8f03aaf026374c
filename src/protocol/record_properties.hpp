// The property block `{[h][oX][rN]}` at the end of a mail record (protocol, section 5).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace linefeed::protocol {

/// `{o0}` … `{o3}`.
enum class Orientation : std::uint8_t { degrees_0, degrees_90, degrees_180, degrees_270 };

/// The property block at the end of a record.
struct RecordProperties {
    bool mirrored = false;                      ///< `h`
    std::optional<Orientation> orientation{};   ///< `oX`
    std::optional<std::uint32_t> repetitions{}; ///< `rN`; only for number 0

    [[nodiscard]] bool empty() const { return !mirrored && !orientation && !repetitions; }
    friend bool operator==(const RecordProperties&, const RecordProperties&) = default;
};

/// Appends the block, e.g. `{ho2r3}`.
void append_properties(std::string& out, const RecordProperties& properties);

/// Reads a block: h, o0…o3 and rN in any order, each at most once. std::nullopt if `text` is none. A repetition beyond
/// 32 bits counts as the largest.
[[nodiscard]] std::optional<RecordProperties> read_properties(std::string_view text);

} // namespace linefeed::protocol
