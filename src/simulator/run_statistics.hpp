// What a run of the simulator amounts to: counted while it goes, told at its end in words or as JSON.
#pragma once

#include "base/histogram.hpp"
#include "simulator/number_sequence.hpp"
#include "simulator/printer_effects.hpp"

#include <algorithm>
#include <cstdint>
#include <iosfwd>
#include <map>
#include <optional>
#include <string>

namespace linefeed::simulator {

/// The counts of one run.
struct RunStatistics {
    std::uint64_t prints = 0;
    std::uint64_t repeats = 0;            ///< of these: the last record of number 0 printed again
    std::uint64_t without_record = 0;     ///< of these: an extern text or the job's own. To a host that sends records,
                                          ///< each is a product that it has missed
    std::uint64_t aborted = 0;            ///< of these: broken off
    std::uint64_t unprinted_products = 0; ///< passed the sensor without a print
    std::uint64_t underruns = 0;
    std::map<std::uint32_t, std::uint64_t> errors; ///< by code (without bit 24)
    Histogram<> lead_times;                        ///< of printed records and of those that came too late
    std::optional<Duration> smallest_lead_time;
    NumberSequence numbers;
    std::uint32_t depth = 0;
    std::uint32_t highest_fill = 0;         ///< records in the printer, the loaded one included
    std::uint32_t lowest_fill = UINT32_MAX; ///< records in the printer when a PrintGo came to a numbered print
    std::uint64_t connections = 0;
    std::uint64_t bad_frames = 0; ///< stretches of bytes that were no frames
    std::uint64_t platform_stalls = 0;
    Duration longest_stall{};

    void add(const Printed& print);
    void add(const Underrun& underrun);
    void add(const ErrorRaised& error);
    void note_fill(std::uint32_t records) { highest_fill = std::max(highest_fill, records); }
    void note_fill_at_print_go(std::uint32_t records) { lowest_fill = std::min(lowest_fill, records); }
};

/// The summary for people, several lines.
void write_summary(std::ostream& out, const RunStatistics& run);
/// The same as one JSON object, for tests: times in ms, absent values null.
[[nodiscard]] std::string summary_json(const RunStatistics& run);

} // namespace linefeed::simulator
