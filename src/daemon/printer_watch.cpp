#include "daemon/printer_watch.hpp"

#include "daemon/events.hpp"

#include <utility>

namespace linefeed::daemon {

using protocol::MachineState;
using protocol::PrinterError;

namespace {

std::string words_of(const PrinterError& error, const config::Settings& settings) {
    std::string words = describe(error);
    if (const config::ErrorEntry* const entry = settings.errors.find(error)) {
        words += ": " + entry->meaning + ". " + entry->advice;
    }
    return words;
}

} // namespace

std::vector<PrinterWatch::News> PrinterWatch::take(const printer::Look& look, const Known& known) {
    std::vector<News> news;
    if (!look.machine && !look.silent) {
        take_failure(look, news);
        return news;
    }
    if (std::exchange(failures_, 0) == failures_until_down) {
        news.push_back({event_kind::printer_up, "the printer is there again"});
    }
    if (!look.machine) {
        take_silence(news);
        return news;
    }
    silent_ = false;
    take_identity(look, known, news);
    take_machine(*look.machine, known, news);
    return news;
}

LinkState PrinterWatch::link() const {
    if (failures_ == 0) {
        return LinkState::up;
    }
    return failures_ < failures_until_down ? LinkState::connecting : LinkState::down;
}

void PrinterWatch::take_failure(const printer::Look& look, std::vector<News>& news) {
    if (failures_ == failures_until_down) {
        return; // said before
    }
    if (++failures_ == failures_until_down) {
        news.push_back({event_kind::printer_down, look.unreachable + ". Look whether the printer is switched on, and "
                                                                     "at its network"});
    }
}

/// A printer in standby need not answer: that is as it should be.
void PrinterWatch::take_silence(std::vector<News>& news) {
    if (!std::exchange(silent_, true)) {
        news.push_back({event_kind::printer_notice, "it takes the connection, but does not answer: it may be in "
                                                    "standby, or another program may hold it"});
    }
}

void PrinterWatch::take_machine(const protocol::MachineStatus& now, const Known& known, std::vector<News>& news) {
    const auto last = std::exchange(told_, now);
    const PrinterError before = last ? last->error : PrinterError{};
    if (now.error != before && now.error.none()) {
        news.push_back({event_kind::printer_notice, "the error is gone: " + describe(before)});
    } else if (now.error != before) {
        const bool stops = now.error.display() == protocol::ErrorDisplay::error ||
                           known.settings.policy(known.printer, now.error) == config::ErrorPolicy::stop;
        news.push_back(
            {stops ? event_kind::printer_error : event_kind::printer_warning, words_of(now.error, known.settings)});
    }
    if (now.cover_open && (!last || !last->cover_open)) {
        news.push_back({event_kind::printer_warning, "the head cover is open. Close it before the next start"});
    } else if (!now.cover_open && last && last->cover_open) {
        news.push_back({event_kind::printer_notice, "the head cover is closed"});
    }
    const bool printed = last && last->machine == MachineState::printing;
    if (now.machine == MachineState::printing && !printed) {
        news.push_back({event_kind::printer_warning,
                        "it is printing, and linefeed has not started it or no longer looks after it. Stop it at the "
                        "printer unless that is wanted"});
    }
}

void PrinterWatch::take_identity(const printer::Look& look, const Known& known, std::vector<News>& news) {
    const std::string here = look.version ? look.version->serial_number : "";
    if (here.empty() || known.serial_number.empty()) {
        return;
    }
    if (here == known.serial_number) {
        other_machine_.clear();
    } else if (std::exchange(other_machine_, here) != here) {
        news.push_back({event_kind::printer_warning, "another machine: serial number " + here + ", and it was " +
                                                         known.serial_number +
                                                         ". No job starts there before an operator has accepted it"});
    }
}

} // namespace linefeed::daemon
