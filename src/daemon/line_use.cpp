#include "daemon/line_use.hpp"

#include "link/serial_port.hpp"
#include "session/line_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace linefeed::daemon {

namespace {

protocol::LineSettings line_of(const link::PrinterAddress& printer) {
    const link::SerialAddress* const serial = printer.serial();
    return {.bytes_per_second = serial == nullptr ? 0.0 : link::bytes_per_second(*serial), .crc = printer.crc};
}

/// A fifth is left to inquiries and their answers.
double carried_per_second(const link::PrinterAddress& printer, std::size_t record_bytes) {
    return 0.8 * session::records_per_second(line_of(printer), record_bytes);
}

std::string rate_text(double rate) {
    return rate < 1 ? "less than 1" : "about " + std::to_string(static_cast<int>(std::floor(rate)));
}

} // namespace

std::size_t record_bytes(const spool::Job& job) {
    constexpr std::size_t usual = 40;
    const std::uint64_t records = job.records.count().value();
    return records == 0 || job.frame_bytes == 0 ? usual : static_cast<std::size_t>(job.frame_bytes / records);
}

void use_line(JobRunSettings& settings, const link::PrinterAddress& printer, link::Endpoints endpoints,
              std::size_t record_bytes) {
    settings.printer = printer;
    settings.endpoints = std::move(endpoints);
    settings.session.line = line_of(printer);
    session::fit_to_line(settings.session, record_bytes);
}

std::string line_words(const link::PrinterAddress& printer, std::size_t record_bytes) {
    const link::SerialAddress* const serial = printer.serial();
    if (serial == nullptr) {
        return {};
    }
    return "the serial line carries " + rate_text(carried_per_second(printer, record_bytes)) + " records a second (" +
           std::to_string(serial->baud) + " baud, records of " + std::to_string(record_bytes) + " bytes, " +
           (printer.crc ? "secured by CRC32" : "not secured") + "): at more the printer runs dry and stops" +
           (printer.crc ? ""
                        : ". Without crc=on in the address nobody notices a letter that the line has changed on its "
                          "way into a record");
}

std::optional<Shortfall> shortfall(const link::PrinterAddress& printer, std::size_t record_bytes,
                                   std::uint32_t products_per_second) {
    const link::SerialAddress* const serial = printer.serial();
    const double rate = carried_per_second(printer, record_bytes);
    if (serial == nullptr || rate >= products_per_second) {
        return std::nullopt;
    }
    return Shortfall{"the conveyor is to bring " + std::to_string(products_per_second) +
                         " products a second, and the serial line carries " + rate_text(rate) +
                         ": the printer will run dry and stop",
                     "Slow the conveyor down, raise the baud rate here and at the printer, shorten the records, or "
                     "connect the printer by Ethernet."};
}

bool NoisePatience::goes_on(const feeder::Outcome& outcome, const RunProgress& progress, JobRunSettings& settings) {
    if (outcome.code != feeder::OutcomeCode::line_noise) {
        return false;
    }
    const bool printed = !progress.range.empty() && progress.printed_through >= progress.range.first();
    fruitless_ = printed ? 0 : fruitless_ + 1;
    // So long the printer may print on without having understood anything, until the stop reaches it: an unproven
    // record must lie behind that.
    constexpr double seconds = 2.0;
    constexpr std::uint64_t least = 16;
    rate_per_s_ = std::max(rate_per_s_, progress.rate_per_s);
    const auto needed = std::max(least, static_cast<std::uint64_t>(rate_per_s_ * seconds));
    const std::uint64_t so_far = std::min<std::uint64_t>(settings.session.feeder.level_at_most.value(),
                                                         std::max<std::uint64_t>(progress.fifo_depth, least));
    settings.session.feeder.level_at_most = RecordCount{std::max(needed, so_far / 2)};
    return fruitless_ < runs_without_print;
}

} // namespace linefeed::daemon
