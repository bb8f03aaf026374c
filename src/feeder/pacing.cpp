#include "feeder/pacing.hpp"

#include <algorithm>

namespace linefeed::feeder {

Pacing::Pacing(const PacingSettings& settings)
    : settings_(settings) {
    LINEFEED_ASSERT(Duration{0} < settings.poll_least && settings.poll_least <= settings.poll_min);
    LINEFEED_ASSERT(settings.poll_min <= settings.poll_max);
    LINEFEED_ASSERT(settings.burst_rate > 0 && settings.polls_per_buffer > 0);
}

void Pacing::restart(Instant now, RecordCount printed) {
    oldest_ = 0;
    size_ = 1;
    samples_[0] = {printed, now};
    restarted_at_ = last_at_ = now;
}

void Pacing::printed(RecordCount count, Instant now) {
    LINEFEED_ASSERT(size_ > 0);
    last_at_ = now;
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

void Pacing::answered_after(Duration round_trip) {
    constexpr int memory = 16; // answers until a single slow one is as good as forgotten
    round_trip_ = std::max(round_trip, round_trip_ - round_trip_ / memory);
}

/// Shortly after a start the line may run at any rate.
bool Pacing::rate_is_known() const {
    return size_ == 0 || last_at_ - restarted_at_ >= settings_.unknown_rate;
}

/// More often than every few prints brings nothing, and a slow line has time. What can be under way at once is spread
/// over the time that an answer takes.
Duration Pacing::least_interval() const {
    constexpr double prints = 8.0;
    const std::chrono::duration<double> wanted{prints / std::max(rate(), 1.0)};
    const Duration least = rate_is_known() ? std::clamp(std::chrono::duration_cast<Duration>(wanted),
                                                        settings_.poll_least, settings_.poll_min)
                                           : settings_.poll_least;
    return std::max(least, round_trip_ / max_inquiries);
}

Duration Pacing::poll_interval(RecordCount level) const {
    using Seconds = std::chrono::duration<double>;
    const Duration least = least_interval();
    if (!rate_is_known()) {
        return least;
    }
    const Seconds to_empty{static_cast<double>(level.value()) / std::max(rate(), settings_.burst_rate)};
    const Seconds wanted = (to_empty - round_trip_ - settings_.lead) / settings_.polls_per_buffer;
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
    const std::uint64_t block = std::max<std::uint64_t>(1, depth.value() / 16);
    return !comfortable || credit.value() >= block;
}

} // namespace linefeed::feeder
