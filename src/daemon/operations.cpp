#include "daemon/operations.hpp"

#include "base/assert.hpp"

namespace linefeed::daemon {

std::string_view to_string(JobPhase phase) {
    switch (phase) {
    case JobPhase::importing:
        return "importing";
    case JobPhase::ready:
        return "ready";
    case JobPhase::queued:
        return "queued";
    case JobPhase::arming:
        return "arming";
    case JobPhase::printing:
        return "printing";
    case JobPhase::stopping:
        return "stopping";
    case JobPhase::stopped:
        return "stopped";
    case JobPhase::in_doubt:
        return "in_doubt";
    case JobPhase::finished:
        return "finished";
    case JobPhase::cancelled:
        return "cancelled";
    case JobPhase::failed:
        return "failed";
    }
    assertion_failed("JobPhase", __FILE__, __LINE__);
}

std::string_view to_string(LinkState state) {
    switch (state) {
    case LinkState::down:
        return "down";
    case LinkState::connecting:
        return "connecting";
    case LinkState::up:
        return "up";
    }
    assertion_failed("LinkState", __FILE__, __LINE__);
}

std::string_view to_string(PrinterPhase phase) {
    switch (phase) {
    case PrinterPhase::idle:
        return "idle";
    case PrinterPhase::checking:
        return "checking";
    case PrinterPhase::arming:
        return "arming";
    case PrinterPhase::printing:
        return "printing";
    case PrinterPhase::stopping:
        return "stopping";
    }
    assertion_failed("PrinterPhase", __FILE__, __LINE__);
}

std::string_view to_string(Severity severity) {
    switch (severity) {
    case Severity::ok:
        return "ok";
    case Severity::warning:
        return "warning";
    case Severity::problem:
        return "problem";
    }
    assertion_failed("Severity", __FILE__, __LINE__);
}

} // namespace linefeed::daemon
