// From files to settings. Everything is checked, and every problem is found, before anything is used.
//
// Flow of the service: load(path, read_environment(environ)); on SIGHUP load() again, diff() and blocking() of
// config/reload.hpp, then swap or keep the old ones.
#pragma once

#include "config/environment.hpp"
#include "config/settings.hpp"

#include <filesystem>
#include <string_view>

namespace linefeed::config {

/// The settings in `text`. `file` is the name in problems; relative paths are relative to its directory. The table of
/// error numbers is not read: Settings::errors lists none. No I/O.
[[nodiscard]] Checked<Settings> parse_settings(std::string_view text, const std::filesystem::path& file,
                                               const Environment& environment);

/// The table of error numbers in `text`. No I/O.
[[nodiscard]] Checked<ErrorTable> parse_error_table(std::string_view text, const std::filesystem::path& file);

/// Reads the configuration, and the table of error numbers that it names.
[[nodiscard]] Checked<Settings> load(const std::filesystem::path& file, const Environment& environment);

} // namespace linefeed::config
