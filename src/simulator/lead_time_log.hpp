// Every lead time of a run, exactly, and every PrintGo that missed its record: what the benchmarks judge a host by. The
// histogram of the summary is for people; this is for figures like "the 0.001th percentile of a million".
#pragma once

#include "base/time.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace linefeed::simulator {

/// A PrintGo that found no record that had been there for the margin.
struct Miss {
    Instant at;                   ///< when the PrintGo was given
    Duration late{};              ///< how long after its time on the grid: a stall of the simulator
    std::optional<Duration> lead; ///< of the record that came too late, negative when it came after the PrintGo; none:
                                  ///< no record came any more
};

/// A PrintGo that was given late.
struct LatePrintGo {
    Instant due;
    Instant at;
};

/// Flow: printed(), missed(), arrived() and late() as it happens, then the figures.
class LeadTimeLog {
public:
    /// More misses and late PrintGos are counted only.
    static constexpr std::size_t max_listed = 100000;

    /// The lead times of the first `first_fill` prints are left out: how long those records lay there tells when the
    /// line began to move, not how fast the host is. Room for `prints` is made now, so that nothing is copied later.
    LeadTimeLog(std::size_t first_fill, std::size_t prints)
        : first_fill_(first_fill) {
        leads_.reserve(prints);
    }

    void printed(Instant at, Duration lead);
    /// `arrival` of the record that was too late; none: the FIFO was empty.
    void missed(Instant at, Duration late, std::optional<Instant> arrival);
    /// A record has come into an empty FIFO: the one that the last misses wanted.
    void arrived(Instant now);
    void late(Instant due, Instant at);

    [[nodiscard]] std::uint64_t prints() const { return prints_; }
    [[nodiscard]] std::uint64_t misses() const { return misses_; }
    [[nodiscard]] std::uint64_t late_print_gos() const { return late_count_; }
    [[nodiscard]] const std::vector<Miss>& listed_misses() const { return listed_; }
    [[nodiscard]] const std::vector<LatePrintGo>& listed_late() const { return late_; }
    /// Instants of the first and the last print; none while nothing was printed.
    [[nodiscard]] std::optional<Instant> first_print() const { return first_print_; }
    [[nodiscard]] std::optional<Instant> last_print() const { return last_print_; }
    /// The lead time that `share` (0…1) of the prints did not reach; 0 is the smallest. None while there are none.
    /// Sorts: not in the middle of a run.
    [[nodiscard]] std::optional<Duration> quantile(double share);

private:
    std::size_t first_fill_;
    std::uint64_t prints_ = 0;
    std::vector<Duration> leads_;
    std::vector<Miss> listed_;
    std::vector<LatePrintGo> late_;
    std::uint64_t misses_ = 0;
    std::uint64_t late_count_ = 0;
    std::size_t waiting_ = 0; ///< so many of the last misses wait for the arrival of their record
    std::optional<Instant> first_print_;
    std::optional<Instant> last_print_;
    bool sorted_ = false;
};

} // namespace linefeed::simulator
