#include "short_run.hpp"

#include "intake/import.hpp"
#include "world.hpp"

#include <algorithm>
#include <fstream>
#include <utility>

namespace linefeed::test {

using store::StoreReply;
using store::StoreWork;

ShortRun::ShortRun(std::filesystem::path directory, spool::SpoolOptions options)
    : directory_(std::move(directory))
    , options_(std::move(options)) {
    std::ofstream source{directory_ / "names.csv"};
    source << "name\n";
    for (std::uint32_t number = 1; number <= records; ++number) {
        source << "Customer " << number << '\n';
    }
}

void ShortRun::reset() {
    claims_ = {};
    tape_ = {};
    misprint_.clear();
    failure_.reset();
}

void ShortRun::start() {
    failure_.reset();
    storage_failed_ = 0;
    claims_.settled = claims_.ended = false;
    auto spool = spool::Spool::open(spool_path(), options_);
    if (!spool) {
        failure_ = spool.error();
        return;
    }
    const auto job = job_of(*spool);
    if (!job) {
        failure_ = job.error();
        return;
    }
    print(*spool, *job);
}

Result<spool::Job> ShortRun::job_of(spool::Spool& spool) {
    spool::JobSpec spec;
    const auto source_fingerprint = intake::fingerprint(directory_ / "names.csv");
    if (!source_fingerprint) {
        return source_fingerprint.error();
    }
    spec.source = *source_fingerprint;
    const auto found = spool.find_by_source(spec);
    if (!found) {
        return found.error();
    }
    if (*found) {
        claims_.job = **found;
        return **found;
    }
    auto source = intake::open_source(directory_ / "names.csv", {});
    if (!source) {
        return source.error();
    }
    const auto imported = intake::import_source(**source, spool, spec, {});
    if (!imported) {
        return imported.error();
    }
    claims_.job = imported->job;
    return *imported->job;
}

void ShortRun::print(spool::Spool& spool, const spool::Job& job) {
    auto open = store::find_open_issue(spool, job.id);
    if (!open) {
        failure_ = open.error();
        return;
    }
    granted_ = {};
    durable_through_ = reported_through_ = {};
    pages_.clear();
    const std::optional<store::OpenIssue> earlier = *open;
    StoreWork work{spool, store::LedgerKeeper{spool, job.id, job.records, "tcp://10.0.0.5:3000", std::move(*open)}};
    if (earlier) {
        settle_earlier(work, *earlier);
    }
    feeder::BeginRun begin;
    begin.printer.total_prints = 5000 + tape_.value();
    work.take(begin);
    pump(work);
    print_granted(work);
    feeder::End end;
    end.outcome.code = storage_failed_ > 0 ? feeder::OutcomeCode::storage_failed : feeder::OutcomeCode::finished;
    work.take(end);
    pump(work);
    claims_.ended = work.failure().empty() && !granted_.empty();
    if (!work.failure().empty()) {
        failure_ = Failure{FailureKind::storage, work.failure()};
    }
}

void ShortRun::settle_earlier(StoreWork& work, const store::OpenIssue& open) {
    feeder::Settle settle;
    settle.earlier_run = true;
    const RecordRange issued = open.jobs.front().records;
    if (tape_ > issued.last()) {
        misprint_ = "record " + std::to_string(tape_.value()) + " was printed without an intent";
        return;
    }
    settle.verdict.printed = RecordRange::closed(issued.first(), tape_);
    settle.verdict.unused = RecordRange::closed(std::max(issued.first(), tape_.next()), issued.last());
    settle.verdict.basis = feeder::Basis::mail_status_and_counter;
    work.take(settle);
    pump(work);
    if (work.failure().empty()) { // durable at return: there is no reply
        claims_.printed_through = std::max(claims_.printed_through, tape_);
    }
}

void ShortRun::print_granted(StoreWork& work) {
    if (granted_.empty()) {
        return;
    }
    if (granted_.first() != tape_.next()) {
        misprint_ = "the grant begins with " + std::to_string(granted_.first().value()) + " and the tape ends with " +
                    std::to_string(tape_.value());
        return;
    }
    for (int round = 0; storage_failed_ == 0 && tape_ < granted_.last(); ++round) {
        move_products(190);
        reported_through_ = tape_;
        work.take(feeder::ConfirmPrinted{tape_, {256, 10, tape_, {}, true, {}}});
        if (durable_through_ < granted_.last()) {
            const std::uint32_t asked = std::min(durable_through_.value() + 150, granted_.last().value());
            work.take(feeder::AskIntent{RecordNumber{asked}});
        }
        give_back_pages(work);
        pump(work);
        if (round % 2 == 1) {
            work.checkpoint();
            pump(work);
        }
    }
    // Whether the storage has failed or not, the printer prints what it has been given.
    move_products(60);
    feeder::Settle settle;
    settle.verdict.printed = RecordRange::closed(reported_through_.next(), tape_);
    settle.verdict.unused = RecordRange::closed(tape_.next(), durable_through_);
    settle.verdict.basis = feeder::Basis::mail_status;
    work.take(settle);
    pump(work);
}

void ShortRun::move_products(std::uint32_t most) {
    tape_ = std::max(tape_, RecordNumber{std::min(tape_.value() + most, durable_through_.value())});
}

void ShortRun::pump(StoreWork& work) {
    while (true) {
        for (const StoreReply& reply : work.take_replies()) {
            take(work, reply);
        }
        if (work.wants_commit()) {
            work.commit();
            if (work.failure().empty()) {
                claims_.printed_through = std::max(claims_.printed_through, reported_through_);
            }
        } else if (work.wants_read_ahead()) {
            work.read_ahead();
        } else if (const auto replies = work.take_replies(); replies.empty()) {
            return;
        } else {
            for (const StoreReply& reply : replies) {
                take(work, reply);
            }
        }
    }
}

void ShortRun::take(StoreWork& /*work*/, const StoreReply& reply) {
    if (const auto* granted = std::get_if<store::Granted>(&reply)) {
        granted_ = granted->range;
        durable_through_ = granted->durable_through;
        reported_through_ = granted_.first().previous();
    } else if (const auto* durable = std::get_if<store::Durable>(&reply)) {
        durable_through_ = durable->through;
    } else if (std::holds_alternative<store::Settled>(reply)) {
        claims_.settled = true;
        claims_.printed_through = std::max(claims_.printed_through, tape_);
    } else if (const auto* page = std::get_if<store::PageReady>(&reply)) {
        pages_.push_back(page->page);
    } else if (const auto* refused = std::get_if<store::Refused>(&reply)) {
        if (refused->why == feeder::OutcomeCode::nothing_to_print) { // because all is printed
            claims_.printed_through = RecordNumber{records};
        }
    } else if (std::holds_alternative<store::StorageFailed>(reply)) {
        ++storage_failed_;
    }
    claims_.intents_through = std::max(claims_.intents_through, durable_through_);
}

void ShortRun::give_back_pages(StoreWork& work) {
    while (!pages_.empty() && pages_.front()->range().last() <= tape_) {
        work.take(store::PageReturned{pages_.front()});
        pages_.erase(pages_.begin());
    }
}

std::string ShortRun::missing() {
    auto spool = spool::Spool::open(spool_path(), options_);
    if (!spool) {
        return "it does not open again: " + spool.error().message;
    }
    const auto world = observe(*spool);
    if (!world) {
        return world.error().message;
    }
    if (!claims_.job) {
        return {};
    }
    const auto found = world->jobs.find(claims_.job->id);
    if (found == world->jobs.end() || found->second != known(*claims_.job)) {
        return "the imported job is not there";
    }
    const spool::LedgerState state = spool->ledger_state(claims_.job->id).value();
    for (std::uint32_t number = 1; number <= claims_.intents_through.value(); ++number) {
        const spool::RecordState is = state.state_of(RecordNumber{number});
        if (is == spool::RecordState::fresh) {
            return "the intent of record " + std::to_string(number) + " is lost";
        }
        if (number <= claims_.printed_through.value() && is != spool::RecordState::printed) {
            return "the confirmation of record " + std::to_string(number) + " is lost";
        }
    }
    if (claims_.settled && state.count(spool::RecordState::open) > RecordCount{0}) {
        return "the verdict is lost";
    }
    const auto last_run = spool->last_run(claims_.job->id).value();
    if (claims_.ended && (!last_run || !last_run->ended)) {
        return "the end of the run is lost";
    }
    return {};
}

} // namespace linefeed::test
