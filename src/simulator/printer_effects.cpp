// How effects read in a trace, see printer_effects.hpp.
#include "simulator/printer_effects.hpp"

#include <ostream>
#include <string_view>

namespace linefeed::simulator {
namespace {

/// Milliseconds with three decimals are what a reader of a trace compares.
std::ostream& operator<<(std::ostream& out, Instant time) {
    return out << std::chrono::duration<double, std::milli>{time.time_since_epoch()}.count() << " ms";
}

void write_lead(std::ostream& out, const std::optional<Duration>& lead) {
    if (lead) {
        out << ", lead " << std::chrono::duration<double, std::milli>{*lead}.count() << " ms";
    }
}

std::string_view name_of(PrintSource source) {
    switch (source) {
    case PrintSource::record:
        return "";
    case PrintSource::last_record_again:
        return "again ";
    case PrintSource::extern_text:
        return "the extern text ";
    case PrintSource::job:
        return "the job ";
    }
    return "";
}

void write_visible(std::ostream& out, std::string_view bytes) {
    for (const char byte : bytes) {
        switch (byte) {
        case '\r':
            out << "<CR>";
            break;
        case '\n':
            out << "<LF>";
            break;
        case '\t':
            out << "<TAB>";
            break;
        default:
            out << byte;
            break;
        }
    }
}

} // namespace

std::ostream& operator<<(std::ostream& out, const Reply& effect) {
    out << "reply to " << effect.connection.value << ": ";
    write_visible(out, effect.bytes);
    return out;
}

std::ostream& operator<<(std::ostream& out, const Printed& effect) {
    out << effect.time << ": printed " << name_of(effect.source) << effect.number << " \"";
    write_visible(out, effect.text);
    out << '"';
    write_lead(out, effect.lead_time);
    return out;
}

std::ostream& operator<<(std::ostream& out, const PrintAborted& effect) {
    return out << effect.time << ": print of " << effect.number << " broken off";
}

std::ostream& operator<<(std::ostream& out, const Underrun& effect) {
    out << effect.time << ": no record for the PrintGo";
    write_lead(out, effect.lead_time);
    return out;
}

std::ostream& operator<<(std::ostream& out, const ErrorRaised& effect) {
    return out << effect.time << ": error " << effect.error.raw << " (" << effect.error.code() << ')';
}

std::ostream& operator<<(std::ostream& out, const StateChanged& effect) {
    return out << effect.time << ": " << protocol::to_string(effect.machine) << ", nozzle "
               << protocol::to_string(effect.nozzle) << ", cover " << (effect.cover_open ? "open" : "closed");
}

std::ostream& operator<<(std::ostream& out, const ConnectionsLost& effect) {
    return out << effect.time << ": connections lost";
}

} // namespace linefeed::simulator
