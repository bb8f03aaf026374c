// How a run uses the line that leads to its printer: what it carries, and when noise on it ends the job.
#pragma once

#include "daemon/job_run.hpp"
#include "link/printer_address.hpp"
#include "spool/job.hpp"

#include <cstddef>
#include <cstdint>
#include <string>

namespace linefeed::daemon {

/// Bytes of a record of this job on average, from `^` to CR; a guess while there is none.
[[nodiscard]] std::size_t record_bytes(const spool::Job& job);

/// Where the run finds its printer, and how the line there is used for records of so many bytes. Precondition: the rest
/// of `settings.session` is as the operator wants it.
void use_line(JobRunSettings& settings, const link::PrinterAddress& printer, link::Endpoints endpoints,
              std::size_t record_bytes);

/// What the operator has to know of a serial line before a start: how many records a second it carries, and what is not
/// noticed without CRC32. Empty for any other.
[[nodiscard]] std::string line_words(const link::PrinterAddress& printer, std::size_t record_bytes);

/// A serial line carries less than the conveyor brings.
struct Shortfall {
    std::string words;  ///< what is so
    std::string advice; ///< what the operator has to do about it
};
/// Absent: the line carries so many products a second, or is not serial.
[[nodiscard]] std::optional<Shortfall> shortfall(const link::PrinterAddress& printer, std::size_t record_bytes,
                                                 std::uint32_t products_per_second);

/// A run that ended because of noise is gone on with at once, since nobody has stopped the line but linefeed itself;
/// but not for ever if nothing gets printed. On a bad line little is kept in the FIFO: every record behind the one that
/// is unproven has to be sent again. Flow: goes_on() after every run.
class NoisePatience {
public:
    static constexpr int runs_without_print = 50; ///< in a row, at most

    /// True if the run ended because of noise and the next, with the settings as they are changed, may go on where it
    /// stopped.
    [[nodiscard]] bool goes_on(const feeder::Outcome& outcome, const RunProgress& progress, JobRunSettings& settings);

private:
    int fruitless_ = 0;
    double rate_per_s_ = 0; ///< the highest so far
};

} // namespace linefeed::daemon
