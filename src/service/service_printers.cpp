// What is asked of a printer besides printing.
#include "service/service.hpp"

#include <chrono>

namespace linefeed::service {

Result<std::vector<daemon::Finding>> Service::preflight(std::string_view printer) {
    const auto line = known_line(printer);
    return line ? (*line)->preflight() : line.error();
}

Result<std::vector<daemon::FrameView>> Service::frames(std::string_view printer, bool error) {
    const auto line = known_line(printer);
    if (!line) {
        return line.error();
    }
    return error ? (*line)->frames().kept() : (*line)->frames().frames();
}

Result<void> Service::acknowledge(const daemon::Caller& caller, std::string_view printer, std::uint32_t error) {
    const Act act{"acknowledge", "printer " + std::string{printer}, spool::JsonObject{}.add("error", error)};
    return audited(caller, act, [&]() -> Result<void> {
        const auto line = known_line(printer);
        return line ? (*line)->acknowledge(error) : line.error();
    });
}

Result<void> Service::accept_printer(const daemon::Caller& caller, std::string_view printer,
                                     const std::string& serial_number) {
    const Act act{"accept", "printer " + std::string{printer}, spool::JsonObject{}.add("serial_number", serial_number)};
    return audited(caller, act, [&]() -> Result<void> {
        const auto line = known_line(printer);
        return line ? (*line)->accept(serial_number) : line.error();
    });
}

Result<void> Service::suspend_panel(const daemon::Caller& caller, std::string_view printer, bool suspend,
                                    Duration hold) {
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(hold).count();
    const Act act{suspend ? "suspend panel" : "release panel", "printer " + std::string{printer},
                  spool::JsonObject{}.add("hold_s", seconds)};
    return audited(caller, act, [&]() -> Result<void> {
        const auto line = known_line(printer);
        if (!line) {
            return line.error();
        }
        return (*line)->hold_panel(suspend ? std::optional{hold} : std::nullopt);
    });
}

} // namespace linefeed::service
