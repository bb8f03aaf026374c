// Events as lines of the log.
#pragma once

#include "daemon/log.hpp"
#include "spool/ticket.hpp"

namespace linefeed::service {

/// One line, with the event's fields; what went wrong as warning or error.
void log_event(daemon::Log& log, const spool::Event& event);

} // namespace linefeed::service
