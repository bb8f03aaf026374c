// A printer with which nothing is done, watched: what is worth a word about one look at it after the other. An error
// that comes while nobody prints should be known before the next start, not at it.
#pragma once

#include "config/settings.hpp"
#include "daemon/operations.hpp"
#include "printer/look.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::daemon {

/// Flow: take() after each look. One thread.
class PrinterWatch {
public:
    struct News {
        std::string_view kind; ///< of events.hpp
        std::string words;
        friend bool operator==(const News&, const News&) = default;
    };
    /// What was known before the look, by whatever way, and what words there are for it.
    struct Known {
        const config::Settings& settings;
        const config::PrinterSettings& printer;
        std::optional<protocol::MachineStatus> machine{};
        std::string serial_number{}; ///< of the machine that stands behind the printer's name; empty = not known yet
    };
    /// What is new, in words with what to do.
    [[nodiscard]] std::vector<News> take(const printer::Look& look, const Known& known);
    /// By the looks so far: connecting = the last one failed, and it may be chance.
    [[nodiscard]] LinkState link() const;

private:
    void take_failure(const printer::Look& look, std::vector<News>& news);
    void take_machine(const protocol::MachineStatus& now, const Known& known, std::vector<News>& news) const;
    void take_identity(const printer::Look& look, const Known& known, std::vector<News>& news);

    /// Another program may hold the printer's only connection for a moment: one look that fails means nothing.
    static constexpr int failures_until_down = 2;
    int failures_ = 0;          ///< in a row, at most failures_until_down
    std::string other_machine_; ///< its serial number was told
};

} // namespace linefeed::daemon
