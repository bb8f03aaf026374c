// Watches every processor for stalls of the platform while a benchmark runs. Started with the scheduling class of the
// simulator, so that it sees what even a process with precedence could not have avoided. On SIGTERM it tells the stalls
// as JSON, on the clock of the simulator's report.
#include "simulator/hiccup_watch.hpp"

#include <nlohmann/json.hpp>

#include <csignal>
#include <iostream>
#include <memory>
#include <pthread.h>
#include <sched.h>
#include <unistd.h>
#include <vector>

int main() {
    using linefeed::simulator::HiccupWatch;
    sigset_t ends;
    sigemptyset(&ends);
    sigaddset(&ends, SIGTERM);
    sigaddset(&ends, SIGINT);
    pthread_sigmask(SIG_BLOCK, &ends, nullptr);
    std::vector<std::unique_ptr<HiccupWatch>> watches;
    for (long processor = 0; processor < ::sysconf(_SC_NPROCESSORS_ONLN); ++processor) {
        cpu_set_t one;
        CPU_ZERO(&one);
        CPU_SET(static_cast<unsigned>(processor), &one);
        if (::sched_setaffinity(0, sizeof(one), &one) == 0) { // the thread that starts now inherits it
            watches.push_back(std::make_unique<HiccupWatch>());
            watches.back()->start();
        }
    }
    int signal = 0;
    sigwait(&ends, &signal);
    nlohmann::json stalls = nlohmann::json::array();
    for (const auto& watch : watches) {
        watch->stop();
        for (const auto& stall : watch->stalls()) {
            stalls.push_back({stall.from.time_since_epoch().count(), stall.to.time_since_epoch().count()});
        }
    }
    std::cout << stalls.dump() << std::endl;
}
