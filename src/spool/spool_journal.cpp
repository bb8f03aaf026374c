// What the service writes down for those who watch it: events, of which the newest are kept, the audit log, which is
// only ever appended to, and the answers to requests that may come twice.
#include "spool/spool_state.hpp"

namespace linefeed::spool {

namespace {

/// Old events are removed so many at a time: otherwise each event would remove one.
constexpr std::int64_t pruned_at_once = 1000;

Result<void> write_event(Database& database, const Event& event) {
    auto statement = database.prepare("INSERT INTO events (time_ns, kind, printer, job, record, message) VALUES "
                                      "(?1, ?2, ?3, iif(?4, ?5, NULL), iif(?6, ?7, NULL), ?8)");
    if (!statement) {
        return statement.error();
    }
    return statement->bind(1, event.time_ns)
        .bind(2, event.kind)
        .bind(3, event.printer)
        .bind(4, std::int64_t{event.job.has_value()})
        .bind(5, static_cast<std::int64_t>(event.job.value_or(JobId{})))
        .bind(6, std::int64_t{event.record.has_value()})
        .bind(7, std::int64_t{event.record.value_or(RecordNumber{}).value()})
        .bind(8, event.message)
        .run();
}

Result<void> prune_events(Database& database) {
    auto statement = database.prepare("DELETE FROM events WHERE id <= (SELECT max(id) FROM events) - ?1 AND "
                                      "(SELECT max(id) FROM events) - (SELECT min(id) FROM events) >= ?1 + ?2");
    if (!statement) {
        return statement.error();
    }
    return statement->bind(1, static_cast<std::int64_t>(Spool::max_events)).bind(2, pruned_at_once).run();
}

Result<void> write_events(Database& database, std::span<const Event> events) {
    auto transaction = Transaction::begin(database);
    if (!transaction) {
        return transaction.error();
    }
    for (const Event& event : events) {
        if (auto done = write_event(database, event); !done) {
            return done;
        }
    }
    if (auto done = prune_events(database); !done) {
        return done;
    }
    return transaction->commit();
}

std::int64_t bounded(std::size_t limit) {
    constexpr std::size_t most = 1'000'000;
    return static_cast<std::int64_t>(limit < most ? limit : most);
}

} // namespace

Result<void> Spool::add_events(std::span<const Event> events) {
    if (auto writable = state_->check_writable(); !writable) {
        return writable;
    }
    if (auto done = write_events(*state_->database, events); !done) {
        return state_->failed_write(done.error());
    }
    return {};
}

Result<std::vector<Event>> Spool::events(std::uint64_t after, std::size_t limit) {
    auto statement = state_->database->prepare(
        "SELECT id, time_ns, kind, printer, job IS NOT NULL, job, record IS NOT NULL, record, message FROM events "
        "WHERE id > ?1 ORDER BY id LIMIT ?2");
    if (!statement) {
        return statement.error();
    }
    statement->bind(1, static_cast<std::int64_t>(after)).bind(2, bounded(limit));
    std::vector<Event> events;
    while (true) {
        const auto more = statement->step();
        if (!more) {
            return more.error();
        }
        if (!*more) {
            return events;
        }
        Event event;
        event.id = static_cast<std::uint64_t>(statement->number(0));
        event.time_ns = statement->number(1);
        event.kind = statement->text(2);
        event.printer = statement->text(3);
        if (statement->number(4) != 0) {
            event.job = JobId{statement->number(5)};
        }
        if (statement->number(6) != 0) {
            event.record = RecordNumber{static_cast<std::uint32_t>(statement->number(7))};
        }
        event.message = statement->text(8);
        events.push_back(std::move(event));
    }
}

namespace {

/// As a number that a statement gives, 0 for nothing.
Result<std::uint64_t> newest(Database& database, const char* sql) {
    auto statement = database.prepare(sql);
    if (!statement) {
        return statement.error();
    }
    const auto row = statement->step();
    return row ? Result<std::uint64_t>{static_cast<std::uint64_t>(statement->number(0))} : row.error();
}

} // namespace

Result<std::uint64_t> Spool::last_event() {
    return newest(*state_->database, "SELECT ifnull(max(id), 0) FROM events");
}

Result<std::uint64_t> Spool::last_audit() {
    return newest(*state_->database, "SELECT ifnull(max(id), 0) FROM audit");
}

Result<void> Spool::add_audit(const AuditEntry& entry) {
    if (auto writable = state_->check_writable(); !writable) {
        return writable;
    }
    auto statement = state_->database->prepare(
        "INSERT INTO audit (time_ns, who, what, object, detail, done) VALUES (?1, ?2, ?3, ?4, ?5, ?6)");
    if (!statement) {
        return statement.error();
    }
    statement->bind(1, entry.time_ns)
        .bind(2, entry.who)
        .bind(3, entry.what)
        .bind(4, entry.object)
        .bind(5, entry.detail)
        .bind(6, std::int64_t{entry.done});
    if (auto done = statement->run(); !done) {
        return state_->failed_write(done.error());
    }
    return {};
}

Result<std::vector<AuditEntry>> Spool::audit(std::uint64_t after, std::size_t limit) {
    auto statement = state_->database->prepare(
        "SELECT id, time_ns, who, what, object, detail, done FROM audit WHERE id > ?1 ORDER BY id LIMIT ?2");
    if (!statement) {
        return statement.error();
    }
    statement->bind(1, static_cast<std::int64_t>(after)).bind(2, bounded(limit));
    std::vector<AuditEntry> entries;
    while (true) {
        const auto more = statement->step();
        if (!more) {
            return more.error();
        }
        if (!*more) {
            return entries;
        }
        entries.push_back({static_cast<std::uint64_t>(statement->number(0)), statement->number(1),
                           std::string{statement->text(2)}, std::string{statement->text(3)},
                           std::string{statement->text(4)}, std::string{statement->text(5)},
                           statement->number(6) != 0});
    }
}

Result<std::optional<Answer>> Spool::answer(const std::string& caller, const std::string& key,
                                            std::int64_t not_before_ns) {
    auto statement = state_->database->prepare(
        "SELECT request_hash, status, body FROM answers WHERE caller = ?1 AND key = ?2 AND time_ns >= ?3");
    if (!statement) {
        return statement.error();
    }
    const auto found = statement->bind(1, caller).bind(2, key).bind(3, not_before_ns).step();
    if (!found) {
        return found.error();
    }
    if (!*found) {
        return std::optional<Answer>{};
    }
    return std::optional{Answer{std::string{statement->text(0)}, static_cast<int>(statement->number(1)),
                                std::string{statement->text(2)}}};
}

Result<void> Spool::keep_answer(const std::string& caller, const std::string& key, const Answer& answer,
                                std::int64_t time_ns, std::int64_t not_before_ns) {
    if (auto writable = state_->check_writable(); !writable) {
        return writable;
    }
    auto forget = state_->database->prepare("DELETE FROM answers WHERE time_ns < ?1");
    auto keep = state_->database->prepare("INSERT OR REPLACE INTO answers (caller, key, time_ns, request_hash, status, "
                                          "body) VALUES (?1, ?2, ?3, ?4, ?5, ?6)");
    if (!forget || !keep) {
        return !forget ? forget.error() : keep.error();
    }
    if (auto done = forget->bind(1, not_before_ns).run(); !done) {
        return state_->failed_write(done.error());
    }
    keep->bind(1, caller)
        .bind(2, key)
        .bind(3, time_ns)
        .bind(4, answer.request_hash)
        .bind(5, std::int64_t{answer.status})
        .bind(6, answer.body);
    if (auto done = keep->run(); !done) {
        return state_->failed_write(done.error());
    }
    return {};
}

} // namespace linefeed::spool
