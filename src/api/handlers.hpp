// What the routes do: from a request to a call of daemon::Operations, and from its result to JSON. The table of routes
// (route.hpp) says which belongs where.
#pragma once

#include "api/exchange.hpp"

namespace linefeed::api::handlers {

// The service itself: service_handlers.cpp
[[nodiscard]] Outcome live(const Request& request, Services& services);
[[nodiscard]] Outcome ready(const Request& request, Services& services);
[[nodiscard]] Outcome version(const Request& request, Services& services);
[[nodiscard]] Outcome metrics(const Request& request, Services& services);
[[nodiscard]] Outcome openapi(const Request& request, Services& services);
[[nodiscard]] Outcome status(const Request& request, Services& services);
[[nodiscard]] Outcome doctor(const Request& request, Services& services);
[[nodiscard]] Outcome reload(const Request& request, Services& services);
[[nodiscard]] Outcome audit(const Request& request, Services& services);
[[nodiscard]] Outcome folders(const Request& request, Services& services);
[[nodiscard]] Outcome events(const Request& request, Services& services);
[[nodiscard]] Outcome verify_ledger(const Request& request, Services& services);

// printer_handlers.cpp
[[nodiscard]] Outcome printers(const Request& request, Services& services);
[[nodiscard]] Outcome printer(const Request& request, Services& services);
[[nodiscard]] Outcome frames(const Request& request, Services& services);
[[nodiscard]] Outcome preflight(const Request& request, Services& services);
[[nodiscard]] Outcome start_printer(const Request& request, Services& services);
[[nodiscard]] Outcome stop_printer(const Request& request, Services& services);
[[nodiscard]] Outcome acknowledge(const Request& request, Services& services);
[[nodiscard]] Outcome accept_printer(const Request& request, Services& services);
[[nodiscard]] Outcome inspect(const Request& request, Services& services);
[[nodiscard]] Outcome command(const Request& request, Services& services);
[[nodiscard]] Outcome read_file(const Request& request, Services& services);
[[nodiscard]] Outcome write_file(const Request& request, Services& services);
[[nodiscard]] Outcome suspend(const Request& request, Services& services);

// job_handlers.cpp, job_read_handlers.cpp
[[nodiscard]] Outcome jobs(const Request& request, Services& services);
[[nodiscard]] Outcome job(const Request& request, Services& services);
[[nodiscard]] Outcome doubt(const Request& request, Services& services);
[[nodiscard]] Outcome records(const Request& request, Services& services);
[[nodiscard]] Outcome history(const Request& request, Services& services);
[[nodiscard]] Outcome ledger_rows(const Request& request, Services& services);
[[nodiscard]] Outcome import(const Request& request, Services& services);
[[nodiscard]] Outcome queue_job(const Request& request, Services& services);
[[nodiscard]] Outcome start_job(const Request& request, Services& services);
[[nodiscard]] Outcome cancel_job(const Request& request, Services& services);
[[nodiscard]] Outcome reprint_job(const Request& request, Services& services);
[[nodiscard]] Outcome settle_job(const Request& request, Services& services);

} // namespace linefeed::api::handlers
