// What the spool remembers of printers, see spool.hpp.
#include "spool/spool_state.hpp"

namespace linefeed::spool {

Result<void> Spool::hold_printer(const std::string& printer, bool held) {
    if (auto writable = state_->check_writable(); !writable) {
        return writable;
    }
    auto statement = state_->database->prepare(held ? "INSERT OR IGNORE INTO held_printers (printer) VALUES (?1)"
                                                    : "DELETE FROM held_printers WHERE printer = ?1");
    if (!statement) {
        return statement.error();
    }
    if (auto done = statement->bind(1, printer).run(); !done) {
        return state_->failed_write(done.error());
    }
    return {};
}

Result<bool> Spool::printer_held(const std::string& printer) {
    auto statement = state_->database->prepare("SELECT 1 FROM held_printers WHERE printer = ?1");
    if (!statement) {
        return statement.error();
    }
    return statement->bind(1, printer).step();
}

Result<std::string> Spool::serial_number(const std::string& printer) {
    auto statement = state_->database->prepare("SELECT serial_number FROM printers WHERE printer = ?1");
    if (!statement) {
        return statement.error();
    }
    const auto found = statement->bind(1, printer).step();
    if (!found) {
        return found.error();
    }
    return *found ? std::string{statement->text(0)} : std::string{};
}

Result<void> Spool::write_serial_number(const std::string& printer, const std::string& serial_number) {
    if (auto writable = state_->check_writable(); !writable) {
        return writable;
    }
    auto statement =
        state_->database->prepare("INSERT OR REPLACE INTO printers (printer, serial_number) VALUES (?1, ?2)");
    if (!statement) {
        return statement.error();
    }
    if (auto done = statement->bind(1, printer).bind(2, serial_number).run(); !done) {
        return state_->failed_write(done.error());
    }
    return {};
}

Result<std::string> Spool::learn_serial_number(const std::string& printer, const std::string& serial_number) {
    if (auto writable = state_->check_writable(); !writable) {
        return writable.error();
    }
    auto statement =
        state_->database->prepare("INSERT OR IGNORE INTO printers (printer, serial_number) VALUES (?1, ?2)");
    if (!statement) {
        return statement.error();
    }
    if (auto done = statement->bind(1, printer).bind(2, serial_number).run(); !done) {
        return state_->failed_write(done.error());
    }
    return this->serial_number(printer);
}

Result<std::vector<std::string>> Spool::printers_of_machine(const std::string& serial_number) {
    auto statement =
        state_->database->prepare("SELECT printer FROM printers WHERE serial_number = ?1 ORDER BY printer");
    if (!statement) {
        return statement.error();
    }
    statement->bind(1, serial_number);
    std::vector<std::string> printers;
    while (true) {
        const auto more = statement->step();
        if (!more) {
            return more.error();
        }
        if (!*more) {
            return printers;
        }
        printers.emplace_back(statement->text(0));
    }
}

Result<std::optional<PrinterMemory>> Spool::printer_memory(const std::string& printer) {
    auto statement = state_->database->prepare(
        "SELECT serial_number, type, firmware, probe, probed_ns FROM printer_memory WHERE printer = ?1");
    if (!statement) {
        return statement.error();
    }
    const auto found = statement->bind(1, printer).step();
    if (!found) {
        return found.error();
    }
    if (!*found) {
        return std::optional<PrinterMemory>{};
    }
    return std::optional{PrinterMemory{std::string{statement->text(0)}, std::string{statement->text(1)},
                                       std::string{statement->text(2)}, std::string{statement->text(3)},
                                       statement->number(4)}};
}

Result<void> Spool::write_printer_memory(const std::string& printer, const PrinterMemory& memory) {
    if (auto writable = state_->check_writable(); !writable) {
        return writable;
    }
    auto statement = state_->database->prepare(
        "INSERT OR REPLACE INTO printer_memory (printer, serial_number, type, firmware, probe, probed_ns) "
        "VALUES (?1, ?2, ?3, ?4, ?5, ?6)");
    if (!statement) {
        return statement.error();
    }
    statement->bind(1, printer).bind(2, memory.serial_number).bind(3, memory.type).bind(4, memory.firmware);
    if (auto done = statement->bind(5, memory.probe).bind(6, memory.probed_ns).run(); !done) {
        return state_->failed_write(done.error());
    }
    return {};
}

} // namespace linefeed::spool
