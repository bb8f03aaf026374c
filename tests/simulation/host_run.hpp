// One run of the program on the printer: what daemon::JobRun and link::PrinterLink hold.
#pragma once

#include "host.hpp"

namespace linefeed::simulation {

struct Host::Run {
    Run(const session::SessionSettings& settings, const feeder::FeederPlan& plan, VirtualStore store_,
        std::uint64_t generation_)
        : session(settings, plan)
        , store(std::move(store_))
        , generation(generation_) {}

    session::Session session;
    VirtualStore store;
    std::uint64_t generation;
    std::uint64_t connection = 0; ///< 0 = none
    bool open = false;
    bool finished = false;             ///< End is on its way to the store
    std::optional<Instant> taken_over; ///< an earlier run: when
    feeder::Outcome outcome;
    std::optional<feeder::ConfirmPrinted> confirm;
    std::optional<feeder::AskIntent> intent;
    // A write that the kernel takes in parts
    std::string unwritten;
    std::size_t written = 0;
    // What waits for a paused process
    std::string inbox;
    bool peer_closed = false;
    std::vector<store::StoreReply> replies;
};

template <typename Fact>
void Host::call(Fact&& fact) {
    fact(run_->session, context_.now, effects_);
    carry_out();
}

} // namespace linefeed::simulation
