// What differs between printers, firmwares and installations: everything about the simulated printer that is a setting.
// A firmware habit of the field notes is a switch here, off by default, so that the default printer is the manual's;
// linefeed-sim switches on what is known of the version that it plays.
#pragma once

#include "base/time.hpp"
#include "protocol/messages.hpp"
#include "protocol/profile.hpp"
#include "simulator/file_transfers.hpp"
#include "simulator/job_counters.hpp"

#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::simulator {

/// In which state the printer is after power-up.
enum class PowerUpState {
    ready_to_print, ///< nozzle open: RS 2, 5
    nozzle_closed,  ///< ready for action: RS 4, 4
    standby,        ///< RS 0, 1
};

/// How the printer ends what it sends (field notes, "Connection").
enum class LineEnd { cr, cr_lf, lf_cr };

/// Deviations of real firmware from the manual (field notes, "Firmware habits").
struct Habits {
    bool ignore_stop_at = false;              ///< `=CM` is ignored, SM shows 0
    bool stop_at_only_while_printing = false; ///< `=CM` is kept only once the printer prints
    bool stale_mail_status = false;           ///< `=SM` is what was true at the previous inquiry
    bool sixth_value = false;                 ///< `=SM` ends with the number of PrintGos
    bool five_value_status = false;           ///< `=RS` without the job-change flag
    bool error_bit_24 = false;                ///< bit 24 of error numbers is set
    bool lead_in_law = false;                 ///< the first number of a new sequence must be 0
    bool speed_in_metres = false;             ///< speeds in m/min
    bool standby_silent = false;              ///< in standby not even `?RS` is answered
    bool abort_print_on_stop = false;         ///< a stop breaks off the running print, which stays "not finished"
    bool escaped_paths = false;               ///< `\` of paths is doubled in answers, as the escape rule demands
    bool missing_jobs_refused = false;        ///< `=JL` with a path where no file is leaves the job as it is
    bool no_total_counter = false;            ///< `=CC` ends before the total print counter
    bool tank_levels = false;                 ///< `?SL` is answered
    bool no_mailing_field = false; ///< set up wrong: the job has no field that takes records; it swallows them
    LineEnd line_end = LineEnd::cr;

    friend bool operator==(const Habits&, const Habits&) = default;
};

/// The names that set_habit() knows, in the order of help texts.
inline constexpr std::array<std::string_view, 17> habit_names{"ignore-stop-at",
                                                              "stop-at-only-while-printing",
                                                              "stale-mail-status",
                                                              "sixth-value",
                                                              "five-value-status",
                                                              "error-bit-24",
                                                              "lead-in-law",
                                                              "speed-in-metres",
                                                              "standby-silent",
                                                              "abort-print-on-stop",
                                                              "escaped-paths",
                                                              "missing-jobs-refused",
                                                              "no-total-counter",
                                                              "tank-levels",
                                                              "no-mailing-field",
                                                              "crlf",
                                                              "lfcr"};

/// Switches the habit of that name on, or with `=off` behind it off (`_` may stand for `-`). False if there is none.
[[nodiscard]] bool set_habit(Habits& habits, std::string_view name);

/// Largest FIFO depth that can be set.
inline constexpr std::uint32_t max_depth = 65536;

/// The simulated printer. Every value is within the range stated here; the program checks what users give.
struct PrinterSettings {
    protocol::Profile profile = protocol::profiles[0];
    Habits habits;
    std::uint32_t depth = 256; ///< records in the printer at most, the loaded one included: 1…max_depth
    Duration margin = std::chrono::milliseconds{3};         ///< how long before its PrintGo a record must be there
    Duration print_duration = std::chrono::milliseconds{1}; ///< shorter than the distance of PrintGos
    Duration initialising_time = std::chrono::seconds{5};
    Duration nozzle_opening_time = std::chrono::seconds{30};
    Duration nozzle_closing_time = std::chrono::seconds{10};
    Duration job_loading_time = std::chrono::milliseconds{100}; ///< protocol, section 4, JL: 50…150 ms
    Duration extern_text_time = std::chrono::milliseconds{30};  ///< protocol, section 4, ET: 20…40 ms
    Duration switch_off_time = std::chrono::minutes{30}; ///< an error not acknowledged for so long ends in standby
    PowerUpState power_up = PowerUpState::ready_to_print;
    bool cover_open = false;
    std::uint32_t speed = 9;        ///< dm/min
    std::uint32_t total_prints = 0; ///< prints of the printer's life so far
    std::string firmware;           ///< version that `?VS` tells; empty: one that fits the profile
    std::string serial_number = "104711";
    std::string job = "\\FFSDISK\\JOBS\\Testprint.job";
    std::chrono::sys_seconds clock_at_zero{
        std::chrono::sys_days{std::chrono::year{2024} / 1 / 1}}; ///< what the printer's clock shows at Instant{}
    std::vector<CounterDefinition> counters;                     ///< of whatever job is loaded
    protocol::InputConfiguration inputs{}; ///< what the inputs do; those that are not set are disabled
    BlockErrors block_errors{};
    bool length_on = false;         ///< somebody has sent `!LN` before
    bool echo_on = false;           ///< somebody has sent `!EM` before
    std::uint32_t block_length = 0; ///< somebody has sent `=FL` before: 1…2048; 0 = nobody
};

/// What `?VS` answers for the profile.
[[nodiscard]] protocol::VersionInfo versions_of(const PrinterSettings& settings);
/// The habits that the field notes report of the very version that `?VS` tells.
[[nodiscard]] Habits habits_of_version(const PrinterSettings& settings);

} // namespace linefeed::simulator
