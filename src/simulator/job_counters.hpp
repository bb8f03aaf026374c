// The counter objects of the loaded job (protocol, section 4, AC, CP and RC): they count prints, and new limits hold
// from the moment when the end is reached.
#pragma once

#include "protocol/counter_messages.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace linefeed::simulator {

/// A counter as the job defines it. Its id is its place in the job, from 1.
struct CounterDefinition {
    std::uint64_t start = 1;
    std::uint64_t end = 9999;
    std::uint32_t repetitions = 0; ///< a value is printed so many times; 0 and 1 alike once
};

/// Flow: load() with the job; printed() at each print; what the host sends in between.
class CounterSet {
public:
    void load(const std::vector<CounterDefinition>& definitions);
    void printed();
    /// Back to the job's start or the given one; id 0 = all. Limits sent before do not begin to hold.
    void reset(const protocol::CounterReset& reset);
    /// Holds once the counter has reached its end. False if there is no such counter.
    bool set_limit(const protocol::CounterParameter& parameter);
    /// The limit that holds now, or none if there is no such counter.
    [[nodiscard]] std::optional<std::uint64_t> limit(std::uint32_t id, protocol::CounterLimit which) const;
    [[nodiscard]] protocol::JobCounters state() const;
    [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(counters_.size()); }

private:
    struct Counter {
        CounterDefinition job;     ///< as the job defines it
        CounterDefinition working; ///< with the limits that hold
        std::optional<std::uint64_t> next_start{};
        std::optional<std::uint64_t> next_end{};
        std::uint64_t value = 0;
        std::uint32_t done = 1; ///< prints of this value, the coming one included
    };

    static void advance(Counter& counter);

    std::vector<Counter> counters_;
};

} // namespace linefeed::simulator
