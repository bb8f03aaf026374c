// Where the lines of the log go: the journal, with fields that can be asked for, or standard error.
#pragma once

#include "config/settings.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

struct iovec;

namespace linefeed::daemon {

/// Everything in it is printable, and lives as long as the call.
struct LogLine {
    std::chrono::system_clock::time_point time;
    std::string_view component;
    config::LogLevel level = config::LogLevel::info;
    std::string_view message;
    /// "JOB", "PRINTER", "RECORD", with their values.
    std::vector<std::pair<std::string_view, std::string_view>> fields;
    std::string_view file; ///< in the sources, as far as known
    std::uint32_t line = 0;
    std::string_view function;
};

/// All on the log's own thread.
class LogTarget {
public:
    virtual ~LogTarget() = default;
    virtual void write(const LogLine& line) = 0;
};

/// What sd_journal_sendv() does: 0, or a negative errno.
using JournalSend = std::function<int(const iovec*, int)>;

/// To the journal: MESSAGE, PRIORITY, SYSLOG_IDENTIFIER, CODE_FILE, CODE_LINE, CODE_FUNC, LINEFEED_COMPONENT,
/// LINEFEED_JOB, LINEFEED_PRINTER, LINEFEED_RECORD. What it refuses goes to standard error.
[[nodiscard]] std::unique_ptr<LogTarget> journal_target(JournalSend send);
/// `TIME level component: message (job 12, printer line1)`, times in UTC.
[[nodiscard]] std::unique_ptr<LogTarget> standard_error_target();
/// What the settings want; standard error where there is no journal.
[[nodiscard]] std::unique_ptr<LogTarget> make_log_target(config::LogTarget wanted);

} // namespace linefeed::daemon
