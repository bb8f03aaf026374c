// Names of habits and versions of profiles, see printer_settings.hpp.
#include "simulator/printer_settings.hpp"

#include <algorithm>

namespace linefeed::simulator {
namespace {

/// A habit that is a switch, and its name.
struct NamedHabit {
    std::string_view name;
    bool Habits::*member;
};

constexpr std::array<NamedHabit, 15> switches{{
    {"ignore-stop-at", &Habits::ignore_stop_at},
    {"stop-at-only-while-printing", &Habits::stop_at_only_while_printing},
    {"stale-mail-status", &Habits::stale_mail_status},
    {"sixth-value", &Habits::sixth_value},
    {"five-value-status", &Habits::five_value_status},
    {"error-bit-24", &Habits::error_bit_24},
    {"lead-in-law", &Habits::lead_in_law},
    {"speed-in-metres", &Habits::speed_in_metres},
    {"standby-silent", &Habits::standby_silent},
    {"abort-print-on-stop", &Habits::abort_print_on_stop},
    {"escaped-paths", &Habits::escaped_paths},
    {"missing-jobs-refused", &Habits::missing_jobs_refused},
    {"no-total-counter", &Habits::no_total_counter},
    {"tank-levels", &Habits::tank_levels},
    {"no-mailing-field", &Habits::no_mailing_field},
}};

} // namespace

bool set_habit(Habits& habits, std::string_view name) {
    constexpr std::string_view switched_off = "=off";
    const bool on = !name.ends_with(switched_off);
    std::string wanted{name.substr(0, name.size() - (on ? 0 : switched_off.size()))};
    std::replace(wanted.begin(), wanted.end(), '_', '-');
    if (on && (wanted == "crlf" || wanted == "lfcr")) {
        habits.line_end = wanted == "crlf" ? LineEnd::cr_lf : LineEnd::lf_cr;
        return true;
    }
    const auto* found = std::find_if(switches.begin(), switches.end(),
                                     [&wanted](const NamedHabit& habit) { return habit.name == wanted; });
    if (found == switches.end()) {
        return false;
    }
    habits.*(found->member) = on;
    return true;
}

protocol::VersionInfo versions_of(const PrinterSettings& settings) {
    protocol::VersionInfo versions;
    versions.serial_number = settings.serial_number;
    versions.kernel = "6.0.0";
    versions.font_pack = "V2.10";
    if (settings.profile.name == "jet3") {
        versions.firmware = "V60.0.25.0";
        versions.type = "JET3";
    } else if (settings.profile.name == "jet2neo") {
        versions.firmware = "V75.0.11.2";
        versions.type = "JET2neo";
    } else if (settings.profile.name == "jet2neo-v71") {
        versions.firmware = "V71.0.22.00";
        versions.type = "JET2neo";
    } else {
        versions.firmware = "V62.0.9.0";
        versions.type = "JET3up";
    }
    if (!settings.firmware.empty()) {
        versions.firmware = settings.firmware;
    }
    versions.fpga = "V3.14";
    versions.rip = versions.firmware;
    versions.sdc = "V4.07";
    versions.fep = versions.firmware;
    versions.system_type = versions.type;
    versions.language_pack = "V1.30";
    return versions;
}

Habits habits_of_version(const PrinterSettings& settings) {
    Habits habits;
    habits.ignore_stop_at = settings.profile.is_jet2neo() && versions_of(settings).firmware == "V75.0.11.2";
    return habits;
}

} // namespace linefeed::simulator
