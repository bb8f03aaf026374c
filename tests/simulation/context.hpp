// What all parts of a simulated world share: the time, the queue, the trace, and what is counted.
#pragma once

#include "event_queue.hpp"
#include "scenario.hpp"
#include "trace.hpp"

#include <array>
#include <cstdint>

namespace linefeed::simulation {

struct Counts {
    std::uint64_t prints = 0;       ///< of the job
    std::uint64_t other_prints = 0; ///< other jobs, end markers
    std::uint64_t underruns = 0;    ///< all of them explained
    std::uint64_t runs = 0;
    std::uint64_t starts = 0;    ///< of the program
    std::uint64_t followers = 0; ///< jobs that followed without a stop
    std::uint64_t in_doubt = 0;  ///< records named in doubt
    std::uint64_t bytes_damaged = 0;
    Duration printing{0}; ///< time in state printing
    Duration simulated{0};
    std::array<std::uint64_t, fault_kinds> faults{};

    void add(const Counts& other) {
        prints += other.prints;
        other_prints += other.other_prints;
        underruns += other.underruns;
        runs += other.runs;
        starts += other.starts;
        followers += other.followers;
        in_doubt += other.in_doubt;
        bytes_damaged += other.bytes_damaged;
        printing += other.printing;
        simulated += other.simulated;
        for (std::size_t i = 0; i < fault_kinds; ++i) {
            faults[i] += other.faults[i];
        }
    }
};

/// What noise did to a secured line.
struct Noise {
    Instant at_printer = Instant::min(); ///< when it last arrived there
    /// The last record that was damaged. The host sends none behind it before the printer has confirmed it.
    std::uint32_t record = 0;
    Instant record_left_at = Instant::min();
};

struct Context {
    Context(const Scenario& scenario_, bool verbose)
        : scenario(scenario_)
        , trace(verbose) {}

    const Scenario& scenario;
    Instant now{};
    EventQueue queue;
    Trace trace;
    Counts counts;
    Noise noise;

    void after(Duration delay, EventKind kind, std::uint64_t a = 0, std::uint64_t b = 0) {
        queue.put(now + delay, kind, a, b);
    }
};

} // namespace linefeed::simulation
