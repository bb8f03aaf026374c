#include "session/line_fit.hpp"

#include <algorithm>
#include <limits>

namespace linefeed::session {

namespace {

constexpr std::size_t announcement_bytes = 17; ///< `^0=NR` and ten digits, with CR
constexpr std::size_t word_bytes = 6;          ///< `^0!OK`, with CR
constexpr std::size_t inquiry_bytes = 6;
constexpr std::size_t answer_bytes = 36; ///< a long `=SM`
/// What the kernels and the printer take besides the bytes, for each turn.
constexpr Duration turn = std::chrono::milliseconds{2};

Duration record_time(const protocol::LineSettings& line, std::size_t record_bytes) {
    return line.crc ? line.time_of(announcement_bytes + record_bytes + word_bytes) + turn : line.time_of(record_bytes);
}

Duration inquiry_time(const protocol::LineSettings& line) {
    const std::size_t secured = line.crc ? 2 * announcement_bytes + word_bytes : 0;
    return line.time_of(inquiry_bytes + answer_bytes + secured) + turn;
}

/// How many records go in so long; two at least, since one alone may be taken out ahead.
RecordCount records_in(Duration time, Duration each) {
    constexpr std::uint64_t least = 2;
    return RecordCount{std::max<std::uint64_t>(least, static_cast<std::uint64_t>(time / std::max(each, Duration{1})))};
}

} // namespace

double records_per_second(const protocol::LineSettings& line, std::size_t record_bytes) {
    if (line.bytes_per_second <= 0) {
        return std::numeric_limits<double>::infinity();
    }
    return 1.0 / std::chrono::duration<double>(record_time(line, record_bytes)).count();
}

void fit_to_line(SessionSettings& settings, std::size_t record_bytes) {
    if (settings.line.bytes_per_second <= 0 && !settings.line.crc) {
        return;
    }
    using std::chrono::milliseconds;
    constexpr Duration fill_takes = milliseconds{2000}; // before the first print
    constexpr Duration block_takes = milliseconds{250}; // a stop waits behind it
    constexpr int share_of_inquiries = 4;               // of the time, one in so many
    constexpr int answers_waited_for = 20;              // in a time-out that must hold for several, each repeated
    const Duration record = record_time(settings.line, record_bytes);
    const Duration inquiry = inquiry_time(settings.line);
    feeder::FeederSettings& feeder = settings.feeder;
    feeder.fill_at_most = records_in(fill_takes, record);
    feeder.refill_at_most = records_in(block_takes, record);

    feeder::PacingSettings& pacing = feeder.pacing;
    pacing.poll_min = std::max(pacing.poll_min, share_of_inquiries * inquiry);
    pacing.poll_least = pacing.poll_min;
    pacing.poll_max = std::max(pacing.poll_max, pacing.poll_min);
    pacing.most_inquiries = 1;
    feeder.status_interval = std::max(feeder.status_interval, 2 * share_of_inquiries * inquiry);
    feeder.unguarded_status_interval = std::max(feeder.unguarded_status_interval, share_of_inquiries * inquiry);
    feeder.retry_interval = std::max(feeder.retry_interval, 2 * inquiry);

    const Duration patience =
        answers_waited_for * inquiry + (settings.line.crc ? protocol::SecuredLine::repeats_take() : Duration::zero());
    feeder.flush_timeout += patience;
    feeder.verify_timeout += patience + fill_takes + 2 * record;
    feeder.start_timeout += patience;
    feeder.stop_timeout += patience;
    feeder.finish_timeout += patience;
    settings.farewell_timeout += patience;
}

} // namespace linefeed::session
