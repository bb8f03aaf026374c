// The tickets of jobs, and the queues that they make.
#include "spool/spool_state.hpp"

namespace linefeed::spool {

namespace {

constexpr std::string_view select_tickets =
    "SELECT job, name, printer, layout, created_by, autostart, begun, cancelled, place IS NOT NULL, place, message "
    "FROM tickets ";

Ticket ticket_from(const Statement& row) {
    Ticket ticket;
    ticket.job = JobId{row.number(0)};
    ticket.name = row.text(1);
    ticket.printer = row.text(2);
    ticket.layout = row.text(3);
    ticket.created_by = row.text(4);
    ticket.autostart = row.number(5) != 0;
    ticket.begun = row.number(6) != 0;
    ticket.cancelled = row.number(7) != 0;
    if (row.number(8) != 0) {
        ticket.place = row.number(9);
    }
    ticket.message = row.text(10);
    return ticket;
}

Result<std::vector<Ticket>> read_tickets(Statement& statement) {
    std::vector<Ticket> tickets;
    while (true) {
        const auto more = statement.step();
        if (!more) {
            return more.error();
        }
        if (!*more) {
            return tickets;
        }
        tickets.push_back(ticket_from(statement));
    }
}

} // namespace

Result<std::optional<Ticket>> Spool::ticket(JobId job) {
    static const std::string sql = std::string{select_tickets} + "WHERE job = ?1";
    auto statement = state_->database->prepare(sql.c_str());
    if (!statement) {
        return statement.error();
    }
    auto found = read_tickets(statement->bind(1, static_cast<std::int64_t>(job)));
    if (!found) {
        return found.error();
    }
    return found->empty() ? std::optional<Ticket>{} : std::optional{std::move(found->front())};
}

Result<std::vector<Ticket>> Spool::queue(const std::string& printer) {
    static const std::string sql =
        std::string{select_tickets} + "WHERE printer = ?1 AND place IS NOT NULL ORDER BY place, job";
    auto statement = state_->database->prepare(sql.c_str());
    if (!statement) {
        return statement.error();
    }
    return read_tickets(statement->bind(1, printer));
}

Result<std::optional<Ticket>> Spool::first_in_queue(const std::string& printer, JobId besides) {
    static const std::string sql = std::string{select_tickets} + "WHERE printer = ?1 AND place IS NOT NULL AND "
                                                                 "job <> ?2 ORDER BY place, job LIMIT 1";
    auto statement = state_->database->prepare(sql.c_str());
    if (!statement) {
        return statement.error();
    }
    auto found = read_tickets(statement->bind(1, printer).bind(2, static_cast<std::int64_t>(besides)));
    if (!found) {
        return found.error();
    }
    return found->empty() ? std::optional<Ticket>{} : std::optional{std::move(found->front())};
}

Result<bool> Spool::has_begun_job(const std::string& printer, JobId besides) {
    auto statement =
        state_->database->prepare("SELECT 1 FROM tickets WHERE printer = ?1 AND begun = 1 AND job <> ?2 LIMIT 1");
    if (!statement) {
        return statement.error();
    }
    return statement->bind(1, printer).bind(2, static_cast<std::int64_t>(besides)).step();
}

Result<std::vector<Ticket>> Spool::begun_jobs() {
    static const std::string sql = std::string{select_tickets} +
                                   "WHERE begun = 1 OR (place IS NOT NULL AND EXISTS (SELECT 1 FROM "
                                   "ledger_segments s WHERE s.job = tickets.job)) ORDER BY job";
    auto statement = state_->database->prepare(sql.c_str());
    if (!statement) {
        return statement.error();
    }
    return read_tickets(*statement);
}

Result<void> Spool::write_ticket(const Ticket& ticket) {
    if (auto writable = state_->check_writable(); !writable) {
        return writable;
    }
    auto statement = state_->database->prepare(
        "INSERT INTO tickets (job, name, printer, layout, created_by, autostart, begun, cancelled, place, message) "
        "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, iif(?9, ?10, NULL), ?11) "
        "ON CONFLICT (job) DO UPDATE SET name = ?2, printer = ?3, layout = ?4, created_by = ?5, autostart = ?6, "
        "begun = ?7, cancelled = ?8, place = iif(?9, ?10, NULL), message = ?11");
    if (!statement) {
        return statement.error();
    }
    statement->bind(1, static_cast<std::int64_t>(ticket.job))
        .bind(2, ticket.name)
        .bind(3, ticket.printer)
        .bind(4, ticket.layout)
        .bind(5, ticket.created_by)
        .bind(6, std::int64_t{ticket.autostart})
        .bind(7, std::int64_t{ticket.begun})
        .bind(8, std::int64_t{ticket.cancelled})
        .bind(9, std::int64_t{ticket.place.has_value()})
        .bind(10, ticket.place.value_or(0))
        .bind(11, ticket.message);
    if (auto done = statement->run(); !done) {
        return state_->failed_write(done.error());
    }
    return {};
}

namespace {

/// The place of one end of a queue, 0 if it is empty.
Result<std::int64_t> end_of_queue(Database& database, const char* sql, const std::string& printer) {
    auto statement = database.prepare(sql);
    if (!statement) {
        return statement.error();
    }
    const auto row = statement->bind(1, printer).step();
    if (!row) {
        return row.error();
    }
    return statement->number(0);
}

} // namespace

Result<std::int64_t> Spool::first_place(const std::string& printer) {
    return end_of_queue(*state_->database,
                        "SELECT ifnull(min(place), 1) - 1 FROM tickets WHERE printer = ?1 AND place IS NOT NULL",
                        printer);
}

Result<std::int64_t> Spool::last_place(const std::string& printer) {
    return end_of_queue(*state_->database,
                        "SELECT ifnull(max(place), 0) + 1 FROM tickets WHERE printer = ?1 AND place IS NOT NULL",
                        printer);
}

} // namespace linefeed::spool
