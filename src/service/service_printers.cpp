// What is asked of a printer besides printing.
#include "service/service.hpp"

namespace linefeed::service {

Result<std::vector<daemon::Finding>> Service::preflight(std::string_view printer) {
    const auto line = known_line(printer);
    return line ? Failure{FailureKind::internal, "not built yet"} : line.error();
}

Result<std::vector<daemon::FrameView>> Service::frames(std::string_view printer, bool error) {
    const auto line = known_line(printer);
    if (!line) {
        return line.error();
    }
    return error ? (*line)->frames().kept() : (*line)->frames().frames();
}

Result<void> Service::acknowledge(const daemon::Caller&, std::string_view printer, std::uint32_t) {
    const auto line = known_line(printer);
    return line ? Failure{FailureKind::internal, "not built yet"} : line.error();
}

Result<void> Service::suspend_panel(const daemon::Caller&, std::string_view printer, bool, Duration) {
    const auto line = known_line(printer);
    return line ? Failure{FailureKind::internal, "not built yet"} : line.error();
}

} // namespace linefeed::service
