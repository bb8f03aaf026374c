#include "feeder/pacing.hpp"

#include <algorithm>

namespace linefeed::feeder {

Pacing::Pacing(const PacingSettings& settings)
    : settings_(settings)
    , inquiries_at_most_(std::min(first_inquiries, settings.most_inquiries)) {
    LINEFEED_ASSERT(Duration{0} < settings.poll_least && settings.poll_least <= settings.poll_min);
    LINEFEED_ASSERT(settings.poll_min <= settings.poll_max);
    LINEFEED_ASSERT(settings.burst_rate > 0 && settings.polls_per_buffer > 0);
    LINEFEED_ASSERT(0 < settings.polls_per_filling && settings.polls_per_filling <= settings.polls_per_filling_max);
    LINEFEED_ASSERT(settings.missing_share > 0 && settings.most_inquiries > 0);
}

void Pacing::restart(Instant now, RecordCount printed) {
    oldest_ = 0;
    size_ = 1;
    samples_[0] = {printed, now};
    restarted_at_ = last_at_ = now;
    last_count_ = printed;
}

void Pacing::printed(RecordCount count, Instant now) {
    LINEFEED_ASSERT(size_ > 0);
    last_at_ = now;
    last_count_ = count;
    const std::size_t newest = (oldest_ + size_ - 1) % samples_kept;
    LINEFEED_ASSERT(count >= samples_[newest].count);
    // Samples closer together than this would let the array cover less than the window at fast polling.
    constexpr Duration spacing = window / samples_kept * 2;
    if (size_ > 1 && now - samples_[newest].at < spacing) {
        return;
    }
    while (size_ > 1 && now - samples_[oldest_].at > window) {
        oldest_ = (oldest_ + 1) % samples_kept;
        --size_;
    }
    LINEFEED_ASSERT(size_ < samples_kept); // the spacing sees to that
    samples_[(oldest_ + size_) % samples_kept] = {count, now};
    ++size_;
}

double Pacing::rate() const {
    if (size_ < 2) {
        return 0.0;
    }
    const Sample& first = samples_[oldest_];
    const Sample& last = samples_[(oldest_ + size_ - 1) % samples_kept];
    const double seconds = std::chrono::duration<double>(last.at - first.at).count();
    return seconds > 0 ? static_cast<double>((last.count - first.count).value()) / seconds : 0.0;
}

bool Pacing::leaps(RecordCount count, Instant now) const {
    LINEFEED_ASSERT(size_ > 0);
    const Sample& newest = samples_[(oldest_ + size_ - 1) % samples_kept];
    constexpr double jitter = 8.0;      // answers do not come as evenly as they were asked for
    constexpr double any_line = 4000.0; // prints/s
    const double at_most = std::max(2.0 * rate(), any_line);
    const double seconds = std::chrono::duration<double>(now - newest.at).count();
    return static_cast<double>((count - newest.count).value()) > jitter + at_most * seconds;
}

/// Since the last sample: a line that starts after a standstill shows here long before it shows in the rate.
double Pacing::latest_rate() const {
    if (size_ == 0) {
        return 0.0;
    }
    const Sample& newest = samples_[(oldest_ + size_ - 1) % samples_kept];
    const double seconds = std::chrono::duration<double>(last_at_ - newest.at).count();
    constexpr double least = 0.005; // one answer more or less must not look like a rate
    return static_cast<double>((last_count_ - newest.count).value()) / std::max(seconds, least);
}

void Pacing::answered_after(Duration round_trip, int under_way) {
    constexpr int memory = 16;                               // answers until a single slow one is as good as forgotten
    constexpr Duration noise = std::chrono::milliseconds{1}; // of the schedulers
    round_trip_ = std::max(round_trip, round_trip_ - round_trip_ / memory);
    shortest_round_trip_ = std::min(shortest_round_trip_, round_trip);
    shortest_of_late_ = std::min(shortest_of_late_, round_trip);
    if (under_way >= inquiries_at_most_ && round_trip <= shortest_round_trip_ + shortest_round_trip_ / 4 + noise) {
        inquiries_at_most_ = std::min(inquiries_at_most_ + 1, settings_.most_inquiries);
    }
    if (++answers_since_judged_ == answers_judged) {
        if (shortest_of_late_ > 2 * shortest_round_trip_ + 2 * noise) {
            inquiries_at_most_ =
                std::max(inquiries_at_most_ / 2, std::min(least_inquiries, settings_.most_inquiries)); // they queue
        }
        answers_since_judged_ = 0;
        shortest_before_ = shortest_of_late_;
        shortest_of_late_ = Duration::max();
    }
}

/// Whether the second had to wait for the first: a line may start at once at its full rate, which leaves no time to
/// find out.
void Pacing::pair_answered_after(Duration first, Duration second) {
    constexpr Duration noise = std::chrono::milliseconds{2};
    if (second - first > std::max(first / 2, noise)) {
        inquiries_at_most_ = std::min(least_inquiries, settings_.most_inquiries);
    }
}

/// Shortly after a start the line may run at any rate.
bool Pacing::rate_is_known() const {
    return size_ == 0 || last_at_ - restarted_at_ >= settings_.unknown_rate;
}

/// More often than every few prints brings nothing, and a slow line has time. What can be under way at once is spread
/// over the time that an answer takes.
Duration Pacing::least_interval(RecordCount level) const {
    constexpr double polls_per_filling = 32.0;
    const double prints = std::max(static_cast<double>(level.value()) / polls_per_filling, 1.0);
    const std::chrono::duration<double> wanted{prints / std::max(rate(), 1.0)};
    const Duration least = rate_is_known() ? std::clamp(std::chrono::duration_cast<Duration>(wanted),
                                                        settings_.poll_least, settings_.poll_min)
                                           : settings_.poll_least;
    const Duration typical = std::min(shortest_before_, shortest_of_late_); // a stall of ours was not the printer's
    return typical == Duration::max() ? least : std::max(least, typical / inquiries_at_most_);
}

Duration Pacing::poll_interval(RecordCount level) const {
    using Seconds = std::chrono::duration<double>;
    const Duration least = least_interval(level);
    if (!rate_is_known()) {
        return least;
    }
    const auto records = static_cast<double>(level.value());
    const double rate_now = std::max(rate(), latest_rate());
    // The line may run at burst_rate in a moment: the buffer must not come to an end between two polls.
    const Seconds to_empty{records / std::max(rate_now, settings_.burst_rate)};
    const Seconds cautious = (to_empty - round_trip_ - settings_.lead) / settings_.polls_per_buffer;
    // At the rate that it has: what the round trip leaves of the share that may be missing. No more than once a print.
    const Seconds filling{records / std::max(rate_now, 1e-3)};
    const Seconds print{1.0 / std::max(rate_now, 1e-3)};
    const Seconds share = std::max(print, std::clamp<Seconds>(filling * settings_.missing_share - round_trip_,
                                                              filling / settings_.polls_per_filling_max,
                                                              filling / settings_.polls_per_filling));
    const Seconds wanted = std::min(cautious, share);
    if (wanted >= Seconds{settings_.poll_max}) {
        return settings_.poll_max; // before the cast: the wish of a very slow line may not fit in a Duration
    }
    return std::max(std::chrono::duration_cast<Duration>(wanted), least);
}

bool Pacing::worth_sending(RecordCount credit, RecordCount level, RecordCount depth) {
    if (credit == RecordCount{0}) {
        return false;
    }
    const bool comfortable = level.value() * 2 >= depth.value();
    constexpr std::uint64_t blocks = 128; // in a FIFO; half of what a poll brings when answers are quick
    const std::uint64_t block = std::max<std::uint64_t>(1, depth.value() / blocks);
    return !comfortable || credit.value() >= block;
}

} // namespace linefeed::feeder
