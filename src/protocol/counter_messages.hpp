// Counters: `=AC =CC =CP =RC` (protocol, section 4).
#pragma once

#include "protocol/commands.hpp"
#include "protocol/limits.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace linefeed::protocol {

/// `=CC`: counters. Host to printer, an absent value is left as it is.
struct Counters {
    static constexpr Parameter parameter = Parameter::CC;
    std::optional<std::uint32_t> product{};
    std::optional<std::uint32_t> stop_after{}; ///< 0 = off
    std::optional<std::uint32_t> total{};      ///< prints of the printer's life; printer to host only

    static void describe(auto& visitor, auto& self) {
        visitor.optional("product", "a product counter", self.product);
        visitor.optional("stop_after", "a number of products", self.stop_after);
        visitor.added("total", "a print counter", self.total);
    }
    friend bool operator==(const Counters&, const Counters&) = default;
};

/// One counter of the job, in `=AC`.
struct JobCounter {
    std::uint32_t done_repetitions = 1; ///< always 1 if the counter repeats 0 times
    std::uint64_t value = 0;            ///< up to 10 figures: sent as value high × 2³² + value low
    friend bool operator==(const JobCounter&, const JobCounter&) = default;
};

/// `=AC`, printer to host: all counters of the job.
struct JobCounters {
    std::vector<JobCounter> counters{};
    friend bool operator==(const JobCounters&, const JobCounters&) = default;
};

/// Counters of a job have up to 10 figures.
inline constexpr std::uint64_t max_counter_value = 9'999'999'999;

/// CP, parameter 2.
enum class CounterLimit : std::uint32_t { start = 1, end = 2 };

/// `=CP`: a counter's start or end value. Taken when the counter reaches its end; not stored in the job. JET3up from
/// V62.0.7.0.
struct CounterParameter {
    static constexpr Parameter parameter = Parameter::CP;
    std::uint32_t counter = 0; ///< its id
    CounterLimit limit = CounterLimit::start;
    std::uint64_t value = 0; ///< 0…max_counter_value

    static void describe(auto& visitor, auto& self) {
        visitor.number("counter", "a counter id", self.counter);
        visitor.number("limit", "1 or 2", self.limit, Limits{1, 2});
        visitor.wide("value", "a counter value", self.value, max_counter_value);
    }
    friend bool operator==(const CounterParameter&, const CounterParameter&) = default;
};

/// `=RC`, host to printer: sets a counter back.
struct CounterReset {
    std::uint32_t counter = 0;            ///< its id; 0 = all
    std::optional<std::uint64_t> start{}; ///< 0…max_counter_value; none (sent as nothing, or −1): the job's own
    friend bool operator==(const CounterReset&, const CounterReset&) = default;
};

} // namespace linefeed::protocol
