// The service's log, with spdlog's queue behind it: whoever writes never waits for the journal, and when lines come
// faster than they can be written the oldest go, counted. What is logged becomes one line of printable text with
// fields.
#pragma once

#include "base/record_number.hpp"
#include "config/settings.hpp"
#include "daemon/log_target.hpp"
#include "spool/job.hpp"

#include <boost/assert/source_location.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

namespace spdlog {
class async_logger;
namespace details {
class thread_pool;
} // namespace details
} // namespace spdlog

namespace linefeed::daemon {

/// What a line is about, besides its words.
struct LogFields {
    std::optional<spool::JobId> job{};
    std::string_view printer{}; ///< empty = none
    std::optional<RecordNumber> record{};
};

/// Any thread but the feed thread: that one neither locks nor allocates, and says what it has to through rings.
class Log {
public:
    /// `target` is written to by a thread of the log's own.
    Log(const config::LoggingSettings& settings, std::unique_ptr<LogTarget> target,
        std::size_t lines_waiting = default_lines_waiting);
    /// Writes what waits.
    ~Log();
    Log(const Log&) = delete;
    Log& operator=(const Log&) = delete;

    /// The line may hold anything: it is made printable.
    void write(config::LogComponent component, config::LogLevel level, std::string_view message,
               const LogFields& fields = {}, const boost::source_location& place = BOOST_CURRENT_LOCATION);
    /// Whether such a line would be written: for those that are expensive to make.
    [[nodiscard]] bool wants(config::LogComponent component, config::LogLevel level) const;
    /// At a reload; the target stays.
    void set_levels(const config::LoggingSettings& settings);
    /// Lines that have been lost since the start. The log says so itself, too.
    [[nodiscard]] std::uint64_t dropped() const;

    static constexpr std::size_t default_lines_waiting = 4096;

private:
    [[nodiscard]] spdlog::async_logger& logger(config::LogComponent component) const;

    std::shared_ptr<spdlog::details::thread_pool> queue_;
    std::array<std::shared_ptr<spdlog::async_logger>, config::log_components> loggers_;
};

} // namespace linefeed::daemon
