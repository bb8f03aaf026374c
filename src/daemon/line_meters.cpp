#include "daemon/line_meters.hpp"

#include <array>

namespace linefeed::daemon {

namespace {

bool is_shown(Duration border) {
    constexpr std::array shown{1, 2, 3, 5};
    auto digit = border.count();
    while (digit >= 10) {
        digit /= 10;
    }
    return std::ranges::find(shown, digit) != shown.end();
}

} // namespace

HistogramView view(const store::SharedHistogram& histogram) {
    HistogramView shown;
    Duration from = Duration::zero();
    for (const Duration border : histogram_borders) {
        if (is_shown(border)) {
            shown.bounds_s.push_back(std::chrono::duration<double>{border}.count());
            shown.counts.push_back(histogram.count_between(from, border));
            from = border;
        }
    }
    shown.counts.push_back(histogram.count_from(from));
    shown.sum_s = std::chrono::duration<double>{histogram.sum()}.count();
    return shown;
}

PrinterMetrics metrics_of(const std::string& printer, const LineMeters& meters) {
    PrinterMetrics metrics;
    metrics.printer = printer;
    metrics.records_sent = meters.records_sent;
    metrics.records_printed = meters.records_printed;
    metrics.records_in_doubt = meters.records_in_doubt;
    metrics.records_unused = meters.records_unused;
    metrics.underruns = meters.underruns;
    metrics.refills = meters.refills;
    metrics.links_lost = meters.links_lost;
    metrics.frames_unexpected = meters.frames_unexpected;
    metrics.bytes_damaged = meters.bytes_damaged;
    metrics.lead_time = view(meters.lead_time);
    metrics.refill = view(meters.refill);
    return metrics;
}

} // namespace linefeed::daemon
