// What differs between firmwares is a setting, never a constant in code (field notes).
#pragma once

#include "protocol/escapes.hpp"

#include <array>
#include <optional>
#include <string_view>

namespace linefeed::protocol {

/// A firmware profile.
struct Profile {
    std::string_view name;
    std::string_view description;
    EscapeMode escapes = EscapeMode::backslash;
    /// RS speed in m/min instead of dm/min.
    bool speed_in_metres = false;
    /// The property block {h o r} of mail records.
    bool record_properties = true;
};

/// The profiles that ship with linefeed; the first is the default.
inline constexpr std::array<Profile, 4> profiles{{
    {"jet3up", "JET3up", EscapeMode::backslash, false, true},
    {"jet3", "JET3 (knows no escapes: ^ and \\ cannot be printed)", EscapeMode::none, false, true},
    {"jet2neo", "JET2neo newer than V71.0.27.00", EscapeMode::backslash, false, true},
    {"jet2neo-v71", "JET2neo up to V71.0.27.00 (knows no escapes)", EscapeMode::none, false, true},
}};

/// The profile of that name.
[[nodiscard]] constexpr std::optional<Profile> profile_by_name(std::string_view name) {
    for (const Profile& profile : profiles) {
        if (profile.name == name) {
            return profile;
        }
    }
    return std::nullopt;
}

} // namespace linefeed::protocol
