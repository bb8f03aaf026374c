// What is wrong with a configuration, and where. A plant mends its file in one go: all problems are found, not only the
// first.
#pragma once

#include <boost/system/result.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace linefeed::config {

/// Where a value was written.
struct Place {
    std::uint32_t line = 0;   ///< from 1; 0 = concerns the whole file
    std::uint32_t column = 0; ///< from 1, in characters
    /// The environment variable that gave the value; empty = the file.
    std::string variable{};

    friend bool operator==(const Place&, const Place&) = default;
};

/// One refusal.
struct Problem {
    std::string file;
    Place place;
    std::string key; ///< e.g. "printers.line1.address"; empty = none in particular
    std::string message;

    friend bool operator==(const Problem&, const Problem&) = default;
};

/// `FILE:LINE:COLUMN: KEY: MESSAGE`, or `LINEFEED_HTTP_PORT: KEY: MESSAGE`. One line, safe to show: what came from the
/// file is escaped.
[[nodiscard]] std::string to_string(const Problem& problem);

/// All problems of a configuration, in the order of files and lines.
class Problems {
public:
    /// So many are kept; the rest is counted.
    static constexpr std::size_t max_kept = 100;

    void add(Problem problem);
    /// Takes over those of another file.
    void append(const Problems& others);
    /// Orders them by place; those of environment variables come last. Stable.
    void sort();

    [[nodiscard]] bool empty() const { return kept_.empty(); }
    [[nodiscard]] const std::vector<Problem>& kept() const { return kept_; }
    /// How many there are besides those that are kept.
    [[nodiscard]] std::size_t more() const { return more_; }

private:
    std::vector<Problem> kept_;
    std::size_t more_ = 0;
};

/// Called by result::value() on an error: throws std::runtime_error with the first problem.
[[noreturn]] void throw_exception_from_error(const Problems& problems, const boost::source_location& place);

/// Of a result whose error is a list of problems.
template <typename T>
using Checked = boost::system::result<T, Problems>;

/// `text` in double quotes, control characters and bytes that are not UTF-8 as \xNN, cut after 60 characters.
[[nodiscard]] std::string in_quotes(std::string_view text);

} // namespace linefeed::config
