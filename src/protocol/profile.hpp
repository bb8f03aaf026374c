// What differs between firmwares is a setting, never a constant in code (field notes). A profile is chosen by name, or
// from what `?VS` tells; whoever knows his printer better sets single properties of it.
#pragma once

#include "base/failure.hpp"
#include "protocol/escapes.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace linefeed::protocol {

/// The printer families of the manual.
enum class PrinterFamily : std::uint8_t { jet3, jet3up, jet2neo };

/// What is so of a printer by its owner's word, whatever its type and version say (parse_profile()). Absent: as they
/// say.
struct OwnProperties {
    std::optional<bool> escapes{};
    std::optional<bool> speed_in_metres{};
    std::optional<bool> record_properties{};
    std::optional<bool> output_control{};
    std::optional<bool> counter_parameters{};
    std::optional<std::uint32_t> graphic_height{};

    friend constexpr bool operator==(const OwnProperties&, const OwnProperties&) = default;
};

/// A firmware profile.
struct Profile {
    std::string_view name;
    std::string_view description;
    EscapeMode escapes = EscapeMode::backslash;
    /// The speeds of RS, EX and PR in m/min instead of dm/min: JET3 up to V60.0.1.17, JET2neo up to V71.0.00.11.
    bool speed_in_metres = false;
    /// The property block {h o r} of mail records: JET3 from V60.0.1.22, JET2neo from V71.0.22.00.
    bool record_properties = true;
    PrinterFamily family = PrinterFamily::jet3up;
    /// `=CO`: from V60.0.25.0, not on JET2neo.
    bool output_control = true;
    /// `=CP`: JET3up from V62.0.7.0.
    bool counter_parameters = true;
    /// How many dots high a graphic may be.
    std::uint32_t graphic_height = 32;
    /// These stand in the properties above already.
    OwnProperties own{};

    /// Inputs whose function is configured (IC), from X4.9 on.
    [[nodiscard]] constexpr std::uint32_t configured_inputs() const { return is_jet2neo() ? 3 : 6; }
    /// Outputs (OC), from X3.1 on.
    [[nodiscard]] constexpr std::uint32_t outputs() const { return is_jet2neo() ? 4 : 8; }
    /// Job select inputs: X4.7 and X4.20 are reserved on JET2neo.
    [[nodiscard]] constexpr std::uint32_t job_select_inputs() const { return is_jet2neo() ? 8 : 10; }
    /// Paths on an SD card begin with `Storage Card\LJ3`.
    [[nodiscard]] constexpr bool has_sd_card() const { return family == PrinterFamily::jet3; }
    /// Where the folders of a USB stick are.
    [[nodiscard]] constexpr std::string_view usb_root() const {
        return is_jet2neo() ? "USB-Stick\\LJet2neo" : "USB-Stick\\LJ3";
    }
    [[nodiscard]] constexpr bool is_jet2neo() const { return family == PrinterFamily::jet2neo; }
};

/// The profiles that ship with linefeed; the first is the default.
inline constexpr std::array<Profile, 5> profiles{{
    {"jet3up", "JET3up", EscapeMode::backslash, false, true, PrinterFamily::jet3up, true, true},
    {"jet3", "JET3 (knows no escapes: ^ and \\ cannot be printed)", EscapeMode::none, false, true, PrinterFamily::jet3,
     true, false},
    {"jet2neo", "JET2neo newer than V71.0.27.00", EscapeMode::backslash, false, true, PrinterFamily::jet2neo, false,
     false, 24},
    {"jet2neo-v71", "JET2neo up to V71.0.27.00 (knows no escapes)", EscapeMode::none, false, true,
     PrinterFamily::jet2neo, false, false, 24},
    // Until the printer has told: records that need an escape are refused, and all others mean the same everywhere.
    {"auto", "as the printer says (?VS)", EscapeMode::none, false, true, PrinterFamily::jet3up, true, true},
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

/// The profile that is written so: a name, and behind it properties that differ from those of the name, e.g.
/// `jet3,escapes=on,speed=m/min`:
///   escapes=on|off, speed=dm/min|m/min, record-properties=on|off, output-control=on|off, counter-limits=on|off,
///   graphic-height=1…32
/// FailureKind::usage with the words for whoever wrote it.
[[nodiscard]] Result<Profile> parse_profile(std::string_view text);
/// As parse_profile() reads it.
[[nodiscard]] std::string to_string(const Profile& profile);
/// "jet3up, jet3, …": for help texts and errors.
[[nodiscard]] std::string profile_names();

/// The profile for what `?VS` tells: `type` is "JET3", "JET3up" or "JET2neo" (whatever the case, other words around
/// it), `firmware` e.g. "V60.0.1.17". What the manual ties to a version is set by the version. std::nullopt for a type
/// or a version that cannot be read.
[[nodiscard]] std::optional<Profile> profile_for(std::string_view type, std::string_view firmware);

/// The profile with what its owner has set.
[[nodiscard]] Profile with_own_properties(Profile profile, const OwnProperties& own);

/// The profile is to be chosen by what the printer says.
[[nodiscard]] constexpr bool is_automatic(const Profile& profile) {
    return profile.name == "auto";
}

} // namespace linefeed::protocol
