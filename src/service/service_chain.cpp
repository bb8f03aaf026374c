// Which job of a queue may follow the one at work without a stop of the line. The same rules as for what starts by
// itself; and it must suit the conversation that is under way.
#include "service/service.hpp"

namespace linefeed::service {

using daemon::Caller;

/// The first of the queue, if it may; absent also while anything else of that printer stands, or the job at work does
/// not end with its run.
Result<std::optional<JobFacts>> Service::next_to_follow(const std::string& printer, const FollowerWanted& wanted) {
    return access_.write([&](spool::Spool& spool) -> Result<std::optional<JobFacts>> {
        const std::optional<JobFacts> none;
        const auto stands = spool.has_begun_job(printer, wanted.behind);
        const auto first = spool.first_in_queue(printer, wanted.behind);
        if (!stands || !first) {
            return stands ? first.error() : stands.error();
        }
        if (*stands || !*first) {
            return none;
        }
        const auto at_work = read_facts(spool, wanted.behind);
        auto next = read_facts(spool, (*first)->job);
        const auto granted = spool.last_ledger_row((*first)->job); // perhaps a run that was granted nothing
        if (!at_work || !next || !granted) {
            return !at_work ? at_work.error() : !next ? next.error() : granted.error();
        }
        const bool may = at_work->printer() == printer && ends_with(*at_work, wanted.run) && *granted == 0 &&
                         fits_behind(*next, wanted);
        return may ? std::optional{std::move(*next)} : none;
    });
}

std::optional<JobFacts> Service::claim_follower(const std::string& printer, const FollowerWanted& wanted) {
    const std::unique_lock lock{orders_, std::try_to_lock}; // whoever has it may be waiting for this line
    if (!lock || closing_) {
        return std::nullopt;
    }
    const SharedSettings now = settings();
    const config::PrinterSettings* const own = now->printer(printer);
    const LinePtr at = line(printer);
    if (own == nullptr || !own->queue.autostart || own->queue.chain != config::Chain::seamless || !at || at->held()) {
        return std::nullopt;
    }
    auto next = next_to_follow(printer, wanted);
    if (!next || !*next || !check_fits(**next, printer)) {
        return std::nullopt;
    }
    const spool::JobId id = (*next)->job.id;
    if (!wanted.has_escapes && wanted.format.escapes == protocol::EscapeMode::backslash) {
        const auto escapes = access_.read([id](spool::Spool& spool) { return spool.has_escapes(id); });
        if (!escapes || *escapes) {
            return std::nullopt;
        }
    }
    const auto write_down = [&] {
        return access_.write([&](spool::Spool& spool) {
            spool::Ticket ticket = (*next)->ticket_or_new();
            ticket.begun = true;
            ticket.message = interrupted_words;
            return spool.write_ticket(ticket);
        });
    };
    const auto claimed =
        audited(Caller{"linefeedd"}, {"start", name_of(id), spool::JsonObject{}.add("behind", name_of(wanted.behind))},
                [&] { return at->take_follower((*next)->job, wanted.behind, write_down); });
    return claimed ? std::move(*next) : std::nullopt;
}

} // namespace linefeed::service
