// What a changed configuration means for a service that runs: SIGHUP reads it whole, and it is taken over whole or not
// at all.
#pragma once

#include "config/settings.hpp"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::config {

/// When a change takes effect.
enum class Applies {
    at_once,      ///< at once, or with the next start, connection or file
    printer_idle, ///< not while the printer concerned prints: the reload is refused then
    restart,      ///< with the next start of the service: until then the old value stays
};

/// One key that is not as it was.
struct Change {
    std::string key;    ///< e.g. "printers.line1.address", "error_table.errors.5043.policy"; a whole element if it is
                        ///< new or gone: "printers.line2"
    std::string before; ///< as the effective settings show it, in one line; empty = was not there
    std::string after;  ///< empty = is gone
    Applies applies = Applies::at_once;
    std::string printer; ///< which printer must not print; empty unless printer_idle

    friend bool operator==(const Change&, const Change&) = default;
};

/// Every key that differs, in the order of the configuration, the error table last.
[[nodiscard]] std::vector<Change> diff(const Settings& before, const Settings& after);

/// Those of `changes` that stand against taking the new settings over now: of printers that print.
[[nodiscard]] std::vector<Change> blocking(const std::vector<Change>& changes,
                                           const std::function<bool(std::string_view printer)>& prints);

/// `KEY: "a" -> "b"`, and when it takes effect unless at once. One line.
[[nodiscard]] std::string to_string(const Change& change);

/// The settings to run with after a reload: `after`, but with the values of `before` where only a restart changes them.
[[nodiscard]] Settings without_restart(const Settings& before, Settings after);

} // namespace linefeed::config
