// What an operator says about records: which of those in doubt are printed, and which are to be printed once more. Both
// become rows of the ledger with his name; nothing that stands there is taken away.
#include "daemon/events.hpp"
#include "daemon/operator_word.hpp"
#include "daemon/record_ranges.hpp"
#include "service/service.hpp"
#include "store/evidence_json.hpp"

#include <algorithm>

namespace linefeed::service {

namespace event_kind = daemon::event_kind;
using daemon::Caller;
using daemon::JobPhase;
using spool::RecordState;

namespace {

Failure wrong(const std::string& message) {
    return {FailureKind::usage, message};
}

/// What an operator has seen may not be what his word would settle now.
Failure overtaken(spool::JobId id) {
    return {FailureKind::stopped,
            "what is known of " + name_of(id) + " has changed meanwhile: look again at its records in doubt"};
}

Result<daemon::OperatorWord> word_of(const daemon::SettleRequest& request) {
    const int given =
        int{request.policy.has_value()} + int{request.last_printed.has_value()} + int{request.printed.has_value()};
    if (given != 1) {
        return wrong("say one thing about the records in doubt: the record on the last product, which of them are "
                     "printed, or that they are to be skipped or printed again");
    }
    daemon::OperatorWord word;
    word.last_printed = request.last_printed.value_or("");
    word.printed = request.printed;
    if (request.policy) {
        word.policy = *request.policy == daemon::SettleRequest::Policy::skip ? daemon::InDoubtPolicy::skip
                                                                             : daemon::InDoubtPolicy::reprint;
    }
    if (!word.given()) {
        return wrong("which record is on the last product? Say its number or text");
    }
    return word;
}

/// A row for each stretch of `records`, naming the run that has printed it. All of them must be printed or skipped.
Result<std::vector<spool::LedgerEntry>> reprint_rows(const JobFacts& facts, const std::vector<RecordRange>& records,
                                                     const std::string& evidence) {
    std::vector<spool::LedgerEntry> rows;
    for (const RecordRange& range : records) {
        RecordCount covered;
        for (const spool::LedgerSegment& segment : facts.ledger.segments()) {
            const bool over = segment.state == RecordState::printed || segment.state == RecordState::skipped;
            if (!over || segment.range.last() < range.first() || range.last() < segment.range.first()) {
                continue;
            }
            const RecordRange part = RecordRange::closed(std::max(segment.range.first(), range.first()),
                                                         std::min(segment.range.last(), range.last()));
            covered += part.count();
            rows.push_back({spool::LedgerKind::reprint, segment.run, part, evidence});
        }
        if (covered != range.count()) {
            return wrong("of the records " + daemon::to_text(range) + " only " + std::to_string(covered.value()) +
                         " are printed or skipped: only those can be printed again");
        }
    }
    return rows;
}

/// The printer on which the job was last printed, among those that are configured; empty = none of them.
Result<std::string> last_printer(spool::Spool& spool, spool::JobId job, const config::Settings& settings) {
    const auto run = spool.last_run(job);
    if (!run) {
        return run.error();
    }
    const auto start = *run ? store::parse_run_start((*run)->started.entry.evidence) : std::nullopt;
    for (const config::PrinterSettings& printer : settings.printers) {
        if (start && link::to_string(printer.address) == start->printer) {
            return printer.name;
        }
    }
    return std::string{};
}

} // namespace

Result<void> Service::reprint(const Caller& caller, spool::JobId id, const daemon::ReprintRequest& request) {
    const Act act{"reprint", name_of(id),
                  spool::JsonObject{}.add("records", request.records).add("reason", request.reason)};
    return audited(caller, act, [&]() -> Result<void> {
        const auto records = daemon::parse_record_ranges(request.records);
        if (!records) {
            return wrong("records: " + records.error().message);
        }
        if (records->empty()) {
            return wrong("which records are to be printed again? N-M,N");
        }
        if (request.reason.empty()) {
            return wrong("say why the records are to be printed again");
        }
        const std::lock_guard lock{orders_};
        const auto facts = facts_of_idle(id);
        if (!facts) {
            return facts.error();
        }
        if (facts->in(RecordState::open) > RecordCount{0}) {
            return Failure{FailureKind::stopped, "nobody has asked yet how far " + name_of(id) +
                                                     " came: resume it, and stop it again if need be"};
        }
        if (facts->in(RecordState::in_doubt) > RecordCount{0}) {
            return Failure{FailureKind::in_doubt, name_of(id) + " has records in doubt: settle those first"};
        }
        const std::string evidence =
            spool::JsonObject{}.add("operator", caller.name).add("reason", request.reason).text();
        const auto rows = reprint_rows(*facts, *records, evidence);
        if (!rows) {
            return rows.error();
        }
        const std::string words = "records " + daemon::to_text(*records) +
                                  " are to be printed again: " + request.reason + " (" + caller.name +
                                  "); start it to do so";
        const SharedSettings now = settings();
        std::string printer;
        auto written = access_.write([&](spool::Spool& spool) -> Result<void> {
            spool::Ticket ticket = facts->ticket_or_new();
            if (ticket.printer.empty()) {
                auto last = last_printer(spool, id, *now);
                if (!last) {
                    return last.error();
                }
                ticket.printer = std::move(*last);
            }
            printer = ticket.printer;
            ticket.begun = true; // its ticket first: a row without it would not hold the queue back
            ticket.cancelled = false;
            ticket.message = words;
            if (!ticket.printer.empty()) {
                const auto place = spool.first_place(ticket.printer);
                if (!place) {
                    return place.error();
                }
                ticket.place = *place;
            }
            auto done = spool.write_ticket(ticket);
            return done ? spool.append(id, *rows) : done;
        });
        if (written) {
            event(event_kind::job_reprint, printer, id, words);
        }
        return written;
    });
}

/// Looks at the records without holding up the lines: there may be many.
Result<Service::Said> Service::said_by(const spool::Job& job, const daemon::OperatorWord& word, const Caller& caller) {
    return access_.read([&](spool::Spool& spool) -> Result<Said> {
        const auto newest = spool.last_ledger_row(job.id);
        if (!newest) {
            return newest.error();
        }
        auto rows = daemon::rows_by_operator(spool, job, word, caller.name);
        return rows ? Result<Said>{Said{std::move(*rows), *newest}} : rows.error();
    });
}

Result<void> Service::settle(const Caller& caller, spool::JobId id, const daemon::SettleRequest& request) {
    spool::JsonObject detail;
    if (request.policy) {
        detail.add("policy", request.policy == daemon::SettleRequest::Policy::skip ? "skip" : "reprint");
    }
    if (request.last_printed) {
        detail.add("last_printed", *request.last_printed);
    }
    if (request.printed) {
        detail.add("printed", *request.printed);
    }
    if (request.as_of) {
        detail.add("as_of", *request.as_of);
    }
    std::string printer;
    auto done = audited(caller, {"settle", name_of(id), detail}, [&]() -> Result<void> {
        const auto word = word_of(request);
        if (!word) {
            return word.error();
        }
        const std::lock_guard lock{orders_};
        const auto facts = facts_of_idle(id);
        if (!facts) {
            return facts.error();
        }
        if (facts->in(RecordState::in_doubt) == RecordCount{0}) {
            return wrong("no record of " + name_of(id) + " is in doubt");
        }
        const auto said = said_by(facts->job, *word, caller);
        if (!said) {
            return said.error();
        }
        if (request.as_of && *request.as_of != said->as_of) {
            return overtaken(id);
        }
        printer = facts->printer();
        bool finished = false;
        auto settled = access_.write([&](spool::Spool& spool) -> Result<void> {
            const auto newest = spool.last_ledger_row(id);
            if (!newest || *newest != said->as_of) {
                return newest ? overtaken(id) : newest.error();
            }
            if (auto appended = spool.append(id, said->rows); !appended) {
                return appended;
            }
            const auto after = read_facts(spool, id);
            if (!after) {
                return after.error();
            }
            finished = phase_of(*after, {}) == JobPhase::finished;
            spool::Ticket ticket = after->ticket_or_new();
            ticket.begun = !finished && !ticket.cancelled;
            ticket.message = finished ? "" : "the doubt is settled by " + caller.name + ": resume it to go on";
            if (finished) {
                ticket.place.reset();
            }
            return spool.write_ticket(ticket);
        });
        if (settled) {
            event(event_kind::job_settled, printer, id, "the records in doubt are settled by " + caller.name);
            if (finished) {
                event(event_kind::job_finished, printer, id, "every record is printed or left out");
            }
        }
        return settled;
    });
    if (done) {
        look_for_work(printer);
    }
    return done;
}

} // namespace linefeed::service
