// What a session wants done, carried out in the order of link::PrinterLink and daemon::JobRun; the process may die
// between any two effects.
#include "host_run.hpp"

#include <sstream>
#include <utility>

namespace linefeed::simulation {

namespace {
constexpr std::size_t request_ring = 256; ///< store::Store::ring_capacity
} // namespace

void Host::carry_out() {
    std::uint64_t steps = 0;
    while (!effects_.empty()) {
        bool write = false;
        bool closing = false;
        for (std::size_t i = 0; i < effects_.size(); ++i) {
            if (steps_to_live_ && ++steps >= *steps_to_live_) {
                die();
                return;
            }
            if (std::holds_alternative<session::Write>(effects_[i])) {
                write = true;
            } else if (std::holds_alternative<session::CloseLink>(effects_[i])) {
                closing = true;
            } else {
                on_effect(effects_[i]);
            }
        }
        effects_.clear();
        if (write && run_->open) {
            begin_write();
            if (continue_write()) {
                run_->session.on_written(context_.now, effects_);
            }
        }
        if (closing && run_->open) {
            run_->open = false;
            wire_.host_closes(run_->connection);
        }
    }
    if (steps_to_live_) {
        *steps_to_live_ -= steps;
    }
    if (run_->finished && run_->store.ended()) {
        run_over();
    }
}

void Host::on_effect(const session::Effect& effect) {
    Run& run = *run_;
    if (const auto* confirm = std::get_if<feeder::ConfirmPrinted>(&effect)) {
        run.confirm = *confirm;
        push_cumulative();
    } else if (const auto* intent = std::get_if<feeder::AskIntent>(&effect)) {
        run.intent = *intent;
        push_cumulative();
    } else if (const auto* settle = std::get_if<feeder::Settle>(&effect)) {
        if (context_.trace.verbose()) {
            std::ostringstream text;
            text << settle->verdict;
            context_.trace.say(context_.now, settle->earlier_run ? "settles earlier run" : "settles", text.str());
        }
        push_cumulative();
        run.store.push(*settle);
    } else if (const auto* begin = std::get_if<feeder::BeginRun>(&effect)) {
        push_cumulative();
        run.store.push(*begin);
    } else if (const auto* adopt = std::get_if<feeder::AdoptRun>(&effect)) {
        context_.trace.note(context_.now, "takes over", adopt->printed_through.value(), adopt->sent_through.value());
        run.taken_over = context_.now;
        run.store.push(*adopt);
    } else if (const auto* release = std::get_if<session::ReleasePage>(&effect)) {
        run.store.push(store::PageReturned{release->page});
    } else if (const auto* notice = std::get_if<feeder::Notice>(&effect)) {
        context_.trace.note(context_.now, "notice", static_cast<std::uint64_t>(notice->code));
        if (notice->code == feeder::NoticeCode::follower_printing) {
            ++context_.counts.followers;
            at_work_ = *std::exchange(offered_, std::nullopt);
            offer_follower();
        }
    } else if (const auto* end = std::get_if<feeder::End>(&effect)) {
        run.outcome = end->outcome;
        push_cumulative();
        run.finished = true;
        run.store.push(*end);
    }
}

void Host::push_cumulative() {
    Run& run = *run_;
    const bool last_chance = run.session.feeder().phase() == feeder::Phase::ended;
    const std::size_t room = last_chance ? 2 : request_ring / 2;
    if (run.intent && run.store.waiting() + room < request_ring) {
        run.store.push(*std::exchange(run.intent, std::nullopt));
    }
    if (run.confirm && run.store.waiting() + room < request_ring) {
        run.store.push(*std::exchange(run.confirm, std::nullopt));
    }
}

void Host::begin_write() {
    Run& run = *run_;
    run.unwritten.clear();
    run.written = 0;
    for (const std::string_view piece : run.session.pieces()) {
        run.unwritten += piece;
    }
    context_.trace.say(context_.now, "writes", run.unwritten);
}

void Host::write_step(std::uint64_t generation) {
    const bool under_way = is_current(generation) && run_->open && !paused() && run_->written < run_->unwritten.size();
    if (under_way && continue_write()) {
        call([](session::Session& session, Instant now, session::Effects& effects) {
            session.on_written(now, effects);
        });
    }
}

/// The kernel takes all, or a part and the rest later. True when all is written.
bool Host::continue_write() {
    Run& run = *run_;
    const std::size_t left = run.unwritten.size() - run.written;
    const bool partly = context_.scenario.slow_write > 0 && left > 1 && random_.chance(context_.scenario.slow_write);
    const std::size_t size = partly ? random_.between(1, left - 1) : left;
    wire_.to_printer(run.connection, std::string_view{run.unwritten}.substr(run.written, size));
    run.written += size;
    if (partly) {
        context_.after(wire_.latency(), EventKind::write_step, run.generation);
    }
    return !partly;
}

} // namespace linefeed::simulation
