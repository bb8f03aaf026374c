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

/// Flow: take() after each look, heard() whenever something else has been told meanwhile. One thread.
class PrinterWatch {
public:
    struct News {
        std::string_view kind; ///< of events.hpp
        std::string words;
        friend bool operator==(const News&, const News&) = default;
    };
    /// What there are words for, and which machine is meant.
    struct Known {
        const config::Settings& settings;
        const config::PrinterSettings& printer;
        std::string serial_number{}; ///< of the machine that stands behind the printer's name; empty = not known yet
    };
    /// What is new, in words with what to do.
    [[nodiscard]] std::vector<News> take(const printer::Look& look, const Known& known);
    /// A start or a run has told what there is to tell of this state: it is no news.
    void heard(const protocol::MachineStatus& machine) { told_ = machine; }
    /// By the looks so far: connecting = the last one failed, and it may be chance.
    [[nodiscard]] LinkState link() const;

private:
    void take_failure(const printer::Look& look, std::vector<News>& news);
    void take_silence(std::vector<News>& news);
    void take_machine(const protocol::MachineStatus& now, const Known& known, std::vector<News>& news);
    void take_identity(const printer::Look& look, const Known& known, std::vector<News>& news);

    /// Another program may hold the printer's only connection for a moment: one look that fails means nothing.
    static constexpr int failures_until_down = 2;
    int failures_ = 0;                            ///< in a row, at most failures_until_down
    bool silent_ = false;                         ///< by the last look
    std::optional<protocol::MachineStatus> told_; ///< the state of which everything is told
    std::string other_machine_;                   ///< its serial number was told
};

} // namespace linefeed::daemon
