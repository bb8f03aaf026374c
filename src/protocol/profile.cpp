// From type and version to the profile, see profile.hpp.
#include "protocol/profile.hpp"

#include "protocol/decimal.hpp"

#include <algorithm>
#include <string>

namespace linefeed::protocol {

namespace {

/// Four numbers, e.g. V60.0.1.17; numbers that are missing are 0. Letters behind a number (V60.0.01.04D) are dropped.
using Version = std::array<std::uint32_t, 4>;

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

std::optional<Version> read_version(std::string_view text) {
    if (text.starts_with('V') || text.starts_with('v')) {
        text.remove_prefix(1);
    }
    Version version{};
    for (std::size_t i = 0; i < version.size() && !text.empty(); ++i) {
        const std::string_view part = text.substr(0, text.find('.'));
        text.remove_prefix(std::min(part.size() + 1, text.size()));
        const auto digits = static_cast<std::size_t>(std::ranges::find_if_not(part, is_digit) - part.begin());
        const auto number = read_decimal<std::uint32_t>(part.substr(0, digits));
        if (!number) {
            return std::nullopt;
        }
        version[i] = *number;
    }
    return version == Version{} ? std::nullopt : std::optional{version};
}

bool contains(std::string_view text, std::string_view upper_case_word) {
    std::string upper{text};
    std::ranges::transform(upper, upper.begin(),
                           [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    return upper.find(upper_case_word) != std::string::npos;
}

Profile jet2neo_profile(const Version& version) {
    const bool knows_escapes = version > Version{71, 0, 27, 0};
    Profile profile = *profile_by_name(knows_escapes ? "jet2neo" : "jet2neo-v71");
    profile.speed_in_metres = version <= Version{71, 0, 0, 11};
    profile.record_properties = version >= Version{71, 0, 22, 0};
    return profile;
}

Profile jet3_profile(Profile profile, const Version& version) {
    profile.speed_in_metres = version <= Version{60, 0, 1, 17};
    profile.record_properties = version >= Version{60, 0, 1, 22};
    profile.output_control = version >= Version{60, 0, 25, 0};
    profile.counter_parameters = profile.family == PrinterFamily::jet3up && version >= Version{62, 0, 7, 0};
    return profile;
}

} // namespace

std::optional<Profile> profile_for(std::string_view type, std::string_view firmware) {
    const auto version = read_version(firmware);
    if (!version) {
        return std::nullopt;
    }
    if (contains(type, "JET2NEO")) {
        return jet2neo_profile(*version);
    }
    if (contains(type, "JET3UP")) {
        return jet3_profile(*profile_by_name("jet3up"), *version);
    }
    if (contains(type, "JET3")) {
        return jet3_profile(*profile_by_name("jet3"), *version);
    }
    return std::nullopt;
}

} // namespace linefeed::protocol
