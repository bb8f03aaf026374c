// One picture of `linefeed watch`: all printers, what they print, and what has happened last.
#pragma once

#include "client/json_fields.hpp"
#include "client/terminal.hpp"

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

namespace linefeed::client {

struct WatchPicture {
    std::string service;               ///< where it is
    std::int64_t now_ns = 0;           ///< wall time
    std::string trouble;               ///< why the rest is old; empty = it is not
    std::vector<Json> printers;        ///< Printer objects
    std::map<std::int64_t, Json> jobs; ///< Job objects of those that are printed
    std::deque<Json> events;           ///< the newest last
};

/// For a terminal: as many lines as it has rows at most, none longer than it is wide.
[[nodiscard]] std::string watch_text(const WatchPicture& picture, const Screen& screen);

/// A line for each printer, safe to show, in the order of the picture.
[[nodiscard]] std::vector<std::string> watch_lines(const WatchPicture& picture);

/// One object, for programs.
[[nodiscard]] Json watch_json(const WatchPicture& picture);

} // namespace linefeed::client
