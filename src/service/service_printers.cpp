// What is asked of a printer besides printing.
#include "daemon/job_run.hpp"
#include "printer/file_transfer.hpp"
#include "printer/local_file.hpp"
#include "printer/printer_path.hpp"
#include "printer/tasks.hpp"
#include "service/service.hpp"
#include "store/ledger_keeper.hpp"

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

Result<std::string> Service::read_file(std::string_view printer, std::string_view path) {
    const auto line = known_line(printer);
    if (!line) {
        return line.error();
    }
    std::string bytes;
    const auto read = (*line)->talk(false, [&](printer::PrinterClient& client) -> Result<void> {
        const auto file = printer::printer_file(path, client.settings().profile.escapes);
        auto got = file ? printer::download(client, *file) : file.error();
        if (!got) {
            return got.error();
        }
        bytes = *std::move(got);
        return {};
    });
    return read ? Result<std::string>{std::move(bytes)} : read.error();
}

Result<void> Service::write_file(const daemon::Caller& caller, std::string_view printer,
                                 const daemon::PrinterFile& file) {
    const auto bytes = printer::read_file(file.content, printer::max_file_bytes);
    if (!bytes) {
        return bytes.error();
    }
    const Act act{"write file", "printer " + std::string{printer},
                  spool::JsonObject{}.add("path", file.path).add("sha256", printer::sha256_hex(*bytes))};
    return audited(caller, act, [&]() -> Result<void> {
        const auto line = known_line(printer);
        if (!line) {
            return line.error();
        }
        return (*line)->talk(file.replace, [&](printer::PrinterClient& client) -> Result<void> {
            const auto path = printer::printer_file(file.path, client.settings().profile.escapes);
            return path ? printer::put_file(client, *path, *bytes, file.replace) : path.error();
        });
    });
}

Result<std::string> Service::inspect(std::string_view printer, std::string_view what, std::string_view arguments) {
    const auto line = known_line(printer);
    if (!line) {
        return line.error();
    }
    const auto task = printer::known_task(what, printer::Task::Kind::look);
    return task ? (*line)->carry_out(**task, arguments, [] { return Result<void>{}; }) : task.error();
}

Result<std::string> Service::command(const daemon::Caller& caller, std::string_view printer, std::string_view what,
                                     std::string_view arguments) {
    const Act act{"command", "printer " + std::string{printer},
                  spool::JsonObject{}.add("what", what).add("arguments", arguments)};
    return audited(caller, act, [&]() -> Result<std::string> {
        const auto line = known_line(printer);
        if (!line) {
            return line.error();
        }
        const auto task = printer::known_task(what, printer::Task::Kind::change);
        if (!task) {
            return task.error();
        }
        return (*line)->carry_out(**task, arguments, [&] { return check_fifo_known((*line)->printer()); });
    });
}

Result<void> Service::check_fifo_known(const std::string& printer) {
    const config::PrinterSettings* const own = settings()->printer(printer);
    const std::string address = own == nullptr ? std::string{} : link::to_string(own->address);
    return access_.write([&](spool::Spool& spool) -> Result<void> {
        const auto open_jobs = spool.jobs_with_open_records();
        if (!open_jobs) {
            return open_jobs.error();
        }
        for (const spool::JobId id : *open_jobs) {
            const auto open = store::find_open_issue(spool, id);
            const auto facts = daemon::read_facts(spool, id);
            if (!open || !facts) {
                return open ? facts.error() : open.error();
            }
            if (facts->printer() == printer || (*open && (*open)->printer == address)) {
                return Failure{FailureKind::stopped,
                               "nobody knows yet which records of " + name_of(id) +
                                   " the printer has printed, and what "
                                   "it knows would be lost: start or resume that job first, which asks it"};
            }
        }
        return {};
    });
}

} // namespace linefeed::service
