// From type and version to the profile, and from text to it and back, see profile.hpp.
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

std::optional<bool> read_switch(std::string_view value) {
    return value == "on" ? std::optional{true} : value == "off" ? std::optional{false} : std::nullopt;
}

std::string switch_text(bool value) {
    return value ? "on" : "off";
}

/// A property of a profile as people write it.
struct Property {
    std::string_view name;
    std::string_view values;
    /// False: not one of the values.
    bool (*set)(OwnProperties& own, std::string_view value);
    /// Absent: not set.
    std::optional<std::string> (*text)(const OwnProperties& own);
};

template <std::optional<bool> OwnProperties::*member>
constexpr Property on_off(std::string_view name) {
    return {name, "on or off",
            [](OwnProperties& own, std::string_view value) { return (own.*member = read_switch(value)).has_value(); },
            [](const OwnProperties& own) {
                return own.*member ? std::optional{switch_text(*(own.*member))} : std::nullopt;
            }};
}

constexpr std::array properties{
    on_off<&OwnProperties::escapes>("escapes"),
    Property{"speed", "dm/min or m/min",
             [](OwnProperties& own, std::string_view value) {
                 own.speed_in_metres = value == "m/min";
                 return value == "m/min" || value == "dm/min";
             },
             [](const OwnProperties& own) {
                 return own.speed_in_metres ? std::optional<std::string>{*own.speed_in_metres ? "m/min" : "dm/min"}
                                            : std::nullopt;
             }},
    on_off<&OwnProperties::record_properties>("record-properties"),
    on_off<&OwnProperties::output_control>("output-control"),
    on_off<&OwnProperties::counter_parameters>("counter-limits"),
    Property{"graphic-height", "1 to 32",
             [](OwnProperties& own, std::string_view value) {
                 own.graphic_height = read_decimal<std::uint32_t>(value);
                 return own.graphic_height && *own.graphic_height >= 1 && *own.graphic_height <= 32;
             },
             [](const OwnProperties& own) {
                 return own.graphic_height ? std::optional{std::to_string(*own.graphic_height)} : std::nullopt;
             }},
};

Failure wrong(const std::string& words) {
    return {FailureKind::usage, words};
}

/// `NAME=VALUE`
Result<void> read_property(std::string_view text, OwnProperties& own) {
    const std::string_view name = text.substr(0, text.find('='));
    const std::string_view value = text.substr(std::min(name.size() + 1, text.size()));
    const auto* const property = std::ranges::find(properties, name, &Property::name);
    if (property == properties.end()) {
        std::string names;
        for (const Property& known : properties) {
            names += (names.empty() ? "" : ", ") + std::string{known.name};
        }
        return wrong('"' + std::string{name} + "\" is no property of a firmware profile; there are: " + names);
    }
    if (property->text(own)) {
        return wrong(std::string{name} + " is set twice");
    }
    if (!property->set(own, value)) {
        return wrong(std::string{name} + " is " + std::string{property->values} + ", not \"" + std::string{value} +
                     '"');
    }
    return {};
}

} // namespace

Profile with_own_properties(Profile profile, const OwnProperties& own) {
    profile.own = own;
    if (own.escapes) {
        profile.escapes = *own.escapes ? EscapeMode::backslash : EscapeMode::none;
    }
    profile.speed_in_metres = own.speed_in_metres.value_or(profile.speed_in_metres);
    profile.record_properties = own.record_properties.value_or(profile.record_properties);
    profile.output_control = own.output_control.value_or(profile.output_control);
    profile.counter_parameters = own.counter_parameters.value_or(profile.counter_parameters);
    profile.graphic_height = own.graphic_height.value_or(profile.graphic_height);
    return profile;
}

std::string profile_names() {
    std::string names;
    for (const Profile& profile : profiles) {
        names += (names.empty() ? "" : ", ") + std::string{profile.name};
    }
    return names;
}

Result<Profile> parse_profile(std::string_view text) {
    const std::string_view name = text.substr(0, text.find(','));
    const auto profile = profile_by_name(name);
    if (!profile) {
        return wrong("there is no firmware profile \"" + std::string{name} + "\"; there are: " + profile_names());
    }
    OwnProperties own;
    while (text.find(',') != std::string_view::npos) {
        text.remove_prefix(text.find(',') + 1);
        if (auto read = read_property(text.substr(0, text.find(',')), own); !read) {
            return read.error();
        }
    }
    return with_own_properties(*profile, own);
}

std::string to_string(const Profile& profile) {
    std::string text{profile.name};
    for (const Property& property : properties) {
        if (const auto value = property.text(profile.own)) {
            text += ',' + std::string{property.name} + '=' + *value;
        }
    }
    return text;
}

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
