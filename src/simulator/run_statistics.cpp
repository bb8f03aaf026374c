// Counting and telling, see run_statistics.hpp.
#include "simulator/run_statistics.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cstdio>
#include <ostream>

namespace linefeed::simulator {
namespace {

using std::chrono::milliseconds;

/// Lower borders of the lead times that are told; above the last there is none.
constexpr std::array<Duration, 16> told_borders{
    milliseconds{0},    milliseconds{1},    milliseconds{2},     milliseconds{3},
    milliseconds{5},    milliseconds{10},   milliseconds{20},    milliseconds{50},
    milliseconds{100},  milliseconds{200},  milliseconds{500},   milliseconds{1000},
    milliseconds{2000}, milliseconds{5000}, milliseconds{10000}, milliseconds{60000}};

std::uint64_t count_told(const Histogram<>& lead_times, std::size_t bucket) {
    const bool last = bucket + 1 == told_borders.size();
    return last ? lead_times.count_from(told_borders.at(bucket))
                : lead_times.count_between(told_borders.at(bucket), told_borders.at(bucket + 1));
}

void add_lead_time(RunStatistics& run, Duration lead) {
    run.lead_times.record(lead);
    run.smallest_lead_time = std::min(run.smallest_lead_time.value_or(lead), lead);
}

double in_ms(Duration duration) {
    return std::chrono::duration<double, std::milli>{duration}.count();
}

std::string fixed(double value) {
    std::array<char, 64> text{};
    const int size = std::snprintf(text.data(), text.size(), "%.3f", value);
    return {text.data(), static_cast<std::size_t>(size)};
}

std::string bucket_name(std::size_t bucket) {
    const auto ms = [](std::size_t border) {
        return std::to_string(std::chrono::duration_cast<milliseconds>(told_borders.at(border)).count());
    };
    const std::string from = ms(bucket);
    return bucket + 1 < told_borders.size() ? from + "-" + ms(bucket + 1) + " ms" : "from " + from + " ms";
}

void write_errors(std::ostream& out, const RunStatistics& run) {
    out << "errors:";
    for (const auto& [code, count] : run.errors) {
        out << ' ' << code << " x " << count;
    }
    out << (run.errors.empty() ? " none\n" : "\n");
}

void write_lead_times(std::ostream& out, const RunStatistics& run) {
    const auto& smallest = run.smallest_lead_time;
    out << "smallest lead time before a PrintGo: " << (smallest ? fixed(in_ms(*smallest)) + " ms" : "none") << '\n';
    if (smallest) {
        out << "lead times:\n";
    }
    for (std::size_t bucket = 0; bucket < told_borders.size(); ++bucket) {
        if (const std::uint64_t count = count_told(run.lead_times, bucket); count > 0) {
            out << "  " << bucket_name(bucket) << ": " << count << '\n';
        }
    }
}

} // namespace

void RunStatistics::add(const Printed& print) {
    ++prints;
    numbers.add(print.number);
    if (print.lead_time) {
        add_lead_time(*this, *print.lead_time);
    }
    switch (print.source) {
    case PrintSource::record:
        return;
    case PrintSource::last_record_again:
        ++repeats;
        return;
    case PrintSource::extern_text:
    case PrintSource::job:
        ++without_record;
        return;
    }
}

void RunStatistics::add(const Underrun& underrun) {
    ++underruns;
    if (underrun.lead_time) {
        add_lead_time(*this, *underrun.lead_time);
    }
}

void RunStatistics::add(const ErrorRaised& error) {
    ++errors[error.error.code_without_bit_24()];
}

void write_summary(std::ostream& out, const RunStatistics& run) {
    out << "linefeed-sim: summary\n";
    out << "prints: " << run.prints << " (numbers " << run.numbers.smallest() << " to " << run.numbers.largest()
        << "; printed again: " << run.repeats << "; without a record: " << run.without_record
        << "; broken off: " << run.aborted << ")\n";
    out << "doubles: " << run.numbers.doubles() << ", gaps: " << run.numbers.gaps()
        << ", missing numbers: " << run.numbers.missing() << '\n';
    out << "unprinted products: " << run.unprinted_products << '\n';
    write_errors(out, run);
    out << "PrintGos without a record in time: " << run.underruns << '\n';
    write_lead_times(out, run);
    out << "highest fill: " << run.highest_fill << " of " << run.depth << " records; lowest fill at a PrintGo: ";
    if (run.lowest_fill == UINT32_MAX) {
        out << "none\n";
    } else {
        out << run.lowest_fill << " records\n";
    }
    out << "connections: " << run.connections << ", damaged frames: " << run.bad_frames << '\n';
    out << "platform stalls: " << run.platform_stalls << ", longest " << fixed(in_ms(run.longest_stall)) << " ms\n";
}

std::string summary_json(const RunStatistics& run) {
    using nlohmann::json;
    json histogram = json::array();
    for (std::size_t i = 0; i < told_borders.size(); ++i) {
        histogram.push_back({{"from_ms", in_ms(told_borders.at(i))},
                             {"to_ms", i + 1 < told_borders.size() ? json(in_ms(told_borders.at(i + 1))) : json()},
                             {"count", count_told(run.lead_times, i)}});
    }
    json errors = json::object();
    for (const auto& [code, count] : run.errors) {
        errors[std::to_string(code)] = count;
    }
    const auto& smallest = run.smallest_lead_time;
    const json summary{
        {"prints", run.prints},
        {"first_number", run.numbers.smallest().value()},
        {"last_number", run.numbers.largest().value()},
        {"printed_again", run.repeats},
        {"without_record", run.without_record},
        {"broken_off", run.aborted},
        {"doubles", run.numbers.doubles()},
        {"gaps", run.numbers.gaps()},
        {"missing_numbers", run.numbers.missing()},
        {"unprinted_products", run.unprinted_products},
        {"errors", errors},
        {"underruns", run.underruns},
        {"smallest_lead_ms", smallest ? json(in_ms(*smallest)) : json()},
        {"lead_histogram", histogram},
        {"depth", run.depth},
        {"highest_fill", run.highest_fill},
        {"lowest_fill", run.lowest_fill == UINT32_MAX ? json() : json(run.lowest_fill)},
        {"connections", run.connections},
        {"damaged_frames", run.bad_frames},
        {"platform_stalls", run.platform_stalls},
        {"longest_stall_ms", in_ms(run.longest_stall)},
    };
    return summary.dump();
}

} // namespace linefeed::simulator
