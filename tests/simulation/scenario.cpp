#include "scenario.hpp"

#include "random.hpp"

#include <algorithm>

namespace linefeed::simulation {

using namespace std::chrono_literals;

std::string_view to_string(Fault fault) {
    constexpr std::array<std::string_view, fault_kinds> names{
        "operator stop",      "stop and go",     "stop under refill", "panel start",     "start between looks",
        "stop by linefeed",   "printer error",   "cover opened",      "nozzle closed",   "printer restart",
        "another job",        "another printer", "second client",     "foreign stop",    "foreign flush",
        "foreign stop point", "foreign record",  "process kill",      "kill in step",    "host power loss",
        "both power loss",    "link cut",        "link silent",       "link stall",      "host pause",
        "slow disk",          "disk full",       "belt pause",        "start under fill"};
    return names[static_cast<std::size_t>(fault)];
}

bool Scenario::supply_is_sufficient() const {
    const double per_second = 1e9 / static_cast<double>((period - period_jitter).count()) * (bursts ? 2.0 : 1.0);
    const auto seconds = [](Duration d) { return std::chrono::duration<double>(d).count(); };
    const double depth = printer.depth;
    // Split bytes and slow writes take up to four latencies each; the feeder polls every depth / 8000 s, 1 ms at least.
    // A printer whose answers vary by more than three is asked half a round trip later at the most
    // (Pacing::inquiries_at_most()): that, and the collecting of blocks, is in the half of the depth.
    const double parts = (split > 0 ? 4.0 : 1.0) + (slow_write > 0 ? 4.0 : 0.0);
    const double supply =
        2 * seconds(latency.high) * parts + std::max(depth / 8000.0, 0.001) + seconds(printer.margin) + 0.002;
    const double ledger = 2 * seconds(commit.high) + seconds(gather) + 0.002;
    return damage == 0 && !crc && per_second * supply < depth / 2 - 1 && per_second * ledger < depth;
}

Duration Scenario::first_refill() const {
    const int parts = (split > 0 ? 4 : 1) + (slow_write > 0 ? 4 : 0); // as above
    return commit.high * 2 + gather + latency.high * parts + printer.margin + std::chrono::milliseconds{2};
}

void Scenario::text_of(std::uint32_t number, std::string& out) const {
    static constexpr char digits[] = "0123456789ABCDEF";
    std::uint32_t mixed = (number ^ static_cast<std::uint32_t>(seed)) * 2654435761U;
    mixed ^= mixed >> 15U;
    char text[19];
    std::size_t size = 0;
    text[size++] = 'R';
    for (unsigned shift = 28; size < 9; shift -= 4) {
        text[size++] = digits[(mixed >> shift) & 0xFU];
    }
    if (two_fields) {
        text[size++] = '\t';
        text[size++] = '\\'; // has to be escaped on its way
        for (unsigned shift = 0; shift < 28; shift += 4) {
            text[size++] = digits[(number >> shift) & 0xFU];
        }
    }
    out.assign(text, size);
}

namespace {

/// No such printer is known; but in a smaller FIFO, or with slow answers, no flush of another client would show
/// (Faults::gap_would_show()).
constexpr std::uint32_t large_depth = 1024;

void draw_faults(Scenario& scenario, Random random) {
    scenario.faults = static_cast<std::uint32_t>(random.spread(1, 24));
    for (std::uint32_t& weight : scenario.weights) {
        weight = random.chance(0.35) ? static_cast<std::uint32_t>(random.spread(1, 32)) : 0;
    }
    if (std::all_of(scenario.weights.begin(), scenario.weights.end(), [](std::uint32_t w) { return w == 0; })) {
        scenario.weights[random.below(static_cast<std::uint64_t>(Fault::printer_restart))] = 1;
    }
    if (scenario.printer.depth == large_depth) {
        scenario.weights[static_cast<std::size_t>(Fault::foreign_flush)] = 32;
    }
    // Around the time that some records take, so that faults meet a printing line as well as one another.
    const Duration typical =
        std::clamp<Duration>(scenario.period * static_cast<std::int64_t>(scenario.printer.depth), 20ms, 120s);
    scenario.fault_gap = {1ms, typical * static_cast<std::int64_t>(random.spread(1, 8))};
}

void draw_printer(Scenario& scenario, Random random) {
    constexpr std::uint32_t depths[]{3, 16, 256};
    simulator::PrinterSettings& printer = scenario.printer;
    printer.depth = depths[random.below(3)];
    if (printer.depth == 256 && random.chance(0.3)) {
        printer.depth = large_depth;
        const Duration latency = random.spread(Duration{50us}, Duration{2ms});
        scenario.latency = {latency, 2 * latency};
        scenario.records = static_cast<std::uint32_t>(random.between(2048, 8192));
    }
    const Duration shortest = (scenario.period - scenario.period_jitter) / (scenario.bursts ? 2 : 1);
    printer.print_duration = std::min<Duration>(random.spread(Duration{200us}, Duration{200ms}), shortest * 6 / 10);
    printer.nozzle_opening_time = 30s;
    printer.total_prints =
        static_cast<std::uint32_t>(random.chance(0.05) ? 0xFFFFFF00U + random.below(256) : random.below(1000000));
    printer.length_on = random.chance(0.1);
    printer.echo_on = random.chance(0.1);
    printer.block_length = random.chance(0.05) ? static_cast<std::uint32_t>(random.between(1, 256)) : 0;
    simulator::Habits& habits = printer.habits;
    habits.ignore_stop_at = random.chance(0.2);
    habits.stop_at_only_while_printing = random.chance(0.15);
    habits.stale_mail_status = random.chance(0.2);
    habits.sixth_value = random.chance(0.3);
    habits.five_value_status = random.chance(0.2);
    habits.error_bit_24 = random.chance(0.15);
    habits.abort_print_on_stop = random.chance(0.25);
    habits.standby_silent = random.chance(0.2);
    habits.line_end = static_cast<simulator::LineEnd>(random.below(3));
}

/// A printer without total print counter. Where no stop point shows a gap either, nobody can know of it: then nobody
/// makes one.
void draw_counter(Scenario& scenario, Random random) {
    scenario.printer.habits.no_total_counter = random.chance(0.25);
    if (scenario.gap_would_show()) {
        return;
    }
    for (const Fault fault : {Fault::stop_and_go, Fault::stop_under_refill, Fault::panel_start,
                              Fault::start_between_looks, Fault::foreign_flush}) {
        scenario.weights[static_cast<std::size_t>(fault)] = 0;
    }
    scenario.weights[static_cast<std::size_t>(Fault::operator_stop)] += 1;
    scenario.start_under_fill = false;
}

/// The records in several jobs. What other clients send is told from ours by its numbers, which must not begin anew for
/// that.
void draw_jobs(Scenario& scenario, Random random) {
    for (const Fault fault :
         {Fault::another_job, Fault::foreign_flush, Fault::foreign_stop_point, Fault::foreign_record}) {
        scenario.weights[static_cast<std::size_t>(fault)] = 0;
    }
    scenario.weights[static_cast<std::size_t>(Fault::stop_by_linefeed)] += 1;
    scenario.records = std::max(scenario.records, 100U);
    if (random.chance(0.8)) { // a printer that lets a job follow
        simulator::PrinterSettings& printer = scenario.printer;
        printer.habits.no_total_counter = printer.habits.ignore_stop_at = false;
        printer.depth = std::max(printer.depth, 16U);
    }
    std::uint32_t next = scenario.first();
    while (next <= scenario.last()) {
        const std::uint32_t rest = scenario.last() - next + 1;
        const auto drawn =
            static_cast<std::uint32_t>(random.chance(0.15) ? random.between(1, 3) : random.spread(8, 400));
        const std::uint32_t count = std::min(drawn, rest);
        const std::uint32_t base = next == scenario.first() ? scenario.base
                                   : random.chance(0.7)     ? 0
                                                            : static_cast<std::uint32_t>(random.below(next));
        scenario.jobs.push_back({next, next + count - 1, next - 1 - base});
        next += count;
    }
}

} // namespace

Scenario draw_scenario(std::uint64_t seed, Profile profile) {
    Scenario scenario;
    scenario.seed = seed;
    if (profile == Profile::line) {
        scenario.records = 200'000;
        scenario.period = 1ms;
        scenario.printer.print_duration = 200us;
        scenario.gather = 40ms;
        scenario.latency = {100us, 100us};
        scenario.commit = {1ms, 1ms};
        scenario.jobs.push_back({scenario.first(), scenario.last(), 0});
        return scenario;
    }
    Random random = Random{seed}.fork(1);
    const bool faulty = random.chance(0.9);
    const std::uint64_t rate = random.spread(1, 1000);
    scenario.period = std::max<Duration>(Duration{1s} / static_cast<std::int64_t>(rate), 1ms);
    scenario.period_jitter = random.chance(0.3) ? scenario.period / 5 : Duration{0};
    scenario.bursts = scenario.period >= 2500us && random.chance(0.3);
    scenario.records = static_cast<std::uint32_t>(faulty ? random.spread(8, 2000) : random.spread(500, 20000));
    scenario.base = random.chance(0.2) ? static_cast<std::uint32_t>(random.spread(1, 1U << 31U)) : 0;
    scenario.page_records = static_cast<std::uint32_t>(faulty ? random.spread(32, 512) : 512);
    scenario.two_fields = random.chance(0.15);
    const Duration typical_latency = random.spread(Duration{50us}, Duration{60ms});
    scenario.latency = {typical_latency, random.chance(0.5) ? typical_latency * 3 : typical_latency};
    scenario.split = random.chance(0.4) ? 0.2 : 0;
    scenario.slow_write = random.chance(0.25) ? 0.2 : 0;
    const Duration typical_commit = random.spread(Duration{100us}, Duration{50ms});
    scenario.commit = {typical_commit, typical_commit * 3};
    scenario.gather = random.chance(0.5) ? 10ms : 40ms;
    scenario.open_nozzle = random.chance(0.5);
    draw_printer(scenario, Random{seed}.fork(2));
    // A line that outruns its network starves at every start: right, but it teaches little.
    const bool may_starve = random.chance(0.1);
    while (!scenario.supply_is_sufficient() && !may_starve && scenario.period < 1s) {
        scenario.period *= 2;
    }
    // The feeder asks up to 1 000 times a second when the FIFO is small, however slow the line: such worlds are kept
    // short.
    const Duration longest = scenario.printer.depth >= 256  ? Duration{3000s}
                             : scenario.printer.depth >= 16 ? Duration{100s}
                                                            : Duration{20s};
    const std::int64_t most = std::max<std::int64_t>(longest / scenario.period, 8);
    scenario.records = static_cast<std::uint32_t>(std::min<std::int64_t>(scenario.records, most));
    if (!scenario.supply_is_sufficient()) {
        scenario.records = std::min(scenario.records, 60U);
    }
    scenario.skips_percent = random.chance(0.2) ? 30 : 0;
    scenario.reprints_percent = random.chance(0.2) ? 30 : 0;
    if (faulty) {
        draw_faults(scenario, Random{seed}.fork(3));
        Random serial = Random{seed}.fork(4);
        scenario.damage = serial.chance(0.2) ? 1e-5 * static_cast<double>(serial.spread(10, 1000)) : 0;
        if (profile == Profile::secured) {
            Random secured = Random{seed}.fork(7);
            scenario.crc = true; // one frame at a time: the line must be as slow as that
            scenario.period = std::max<Duration>(scenario.period, 8 * scenario.latency.high);
            scenario.records = std::min(scenario.records, 100U);
            scenario.damage = 1e-4 * static_cast<double>(secured.spread(1, 300));
        }
        scenario.start_under_fill = Random{seed}.fork(5).chance(0.1);
    }
    if (profile != Profile::counted) {
        draw_counter(scenario, Random{seed}.fork(6));
    }
    if (profile == Profile::chained) {
        draw_jobs(scenario, Random{seed}.fork(8));
    } else {
        scenario.jobs.push_back({scenario.first(), scenario.last(), 0});
    }
    return scenario;
}

} // namespace linefeed::simulation
