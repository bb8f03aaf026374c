// linefeed_simulation: many years of production in an afternoon. Runs seeds and prints what came of them; exit code 1
// on a violation.
//
// clang-format off
//   linefeed_simulation --seed N --trace      one seed with everything that happens
//   linefeed_simulation --from A --count N    N seeds
//   linefeed_simulation --hours H             seeds until the line has printed for H hours
//   linefeed_simulation --regressions FILE    the seeds of a list (first word of a line, and perhaps a profile behind it;
//                                             # begins a comment)
//   linefeed_simulation … --twice             each seed twice; the traces must agree
//   linefeed_simulation --profile line        the speed at 1 000 prints/s without faults
//
// The long suite: one such program per core, with ranges that do not overlap, e.g.
//   for core in 1 2; do linefeed_simulation --from ${core}000000000 --hours 1000 & done; wait
// clang-format on
#include "world.hpp"

#include <CLI/CLI.hpp>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <malloc.h>
#include <sstream>
#include <string>
#include <string_view>

namespace linefeed::simulation {
namespace {

struct Options {
    std::optional<std::uint64_t> seed;
    std::uint64_t from = 1;
    std::uint64_t count = 0;
    double hours = 0;
    std::string regressions;
    std::string profile = "mixed";
    bool trace = false;
    bool twice = false;
    bool stop_at_first = false;
};

std::uint64_t seed_under_way = 0;

/// An assertion of the product has failed: the seed must not be lost.
void on_abort(int) {
    std::printf("VIOLATION seed %llu: an assertion of the program failed\n",
                static_cast<unsigned long long>(seed_under_way));
    std::fflush(stdout);
}

Profile profile_of(std::string_view word) {
    return word == "line"      ? Profile::line
           : word == "counted" ? Profile::counted
           : word == "secured" ? Profile::secured
           : word == "chained" ? Profile::chained
                               : Profile::mixed;
}

class Program {
public:
    explicit Program(const Options& options)
        : options_(options)
        , profile_(profile_of(options.profile)) {}

    int run() {
        const auto begin = std::chrono::steady_clock::now();
        if (options_.seed) {
            run_one(*options_.seed);
        } else if (!options_.regressions.empty()) {
            run_list();
        } else {
            const Duration wanted =
                std::chrono::duration_cast<Duration>(std::chrono::duration<double, std::ratio<3600>>{options_.hours});
            const std::uint64_t count = options_.count == 0 && options_.hours == 0 ? 100 : options_.count;
            for (std::uint64_t i = 0;
                 (i < count || counts_.printing < wanted) && !(options_.stop_at_first && violations_ > 0); ++i) {
                run_one(options_.from + i);
            }
        }
        report(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
        return violations_ == 0 ? 0 : 1;
    }

private:
    void run_one(std::uint64_t seed) {
        seed_under_way = seed;
        const Scenario scenario = draw_scenario(seed, profile_);
        const RunResult result = run_seed(scenario, options_.trace);
        ++seeds_;
        counts_.add(result.counts);
        if (options_.trace) {
            std::printf("trace hash %016llx\n", static_cast<unsigned long long>(result.trace_hash));
        }
        if (result.violation) {
            violated(seed, *result.violation);
        } else if (options_.twice && run_seed(scenario, false).trace_hash != result.trace_hash) {
            violated(seed, "a second run took another course");
        }
    }

    void violated(std::uint64_t seed, const std::string& what) {
        ++violations_;
        std::printf("VIOLATION seed %llu: %s\n", static_cast<unsigned long long>(seed), what.c_str());
        std::fflush(stdout);
    }

    void run_list() {
        std::ifstream list{options_.regressions};
        std::string line;
        while (std::getline(list, line)) {
            std::istringstream words{line.substr(0, line.find('#'))};
            std::uint64_t seed = 0;
            std::string word;
            if (words >> seed) {
                words >> word;
                profile_ = profile_of(word);
                run_one(seed);
            }
        }
        if (seeds_ == 0) {
            ++violations_;
            std::printf("%s holds no seeds\n", options_.regressions.c_str());
        }
    }

    void report(double wall_s) const {
        const double simulated_s = std::chrono::duration<double>(counts_.simulated).count();
        const double printing_s = std::chrono::duration<double>(counts_.printing).count();
        std::printf(
            "%llu seeds, %.1f h simulated (%.1f h printing), %llu prints (%llu of others), %llu starts, %llu runs\n",
            static_cast<unsigned long long>(seeds_), simulated_s / 3600, printing_s / 3600,
            static_cast<unsigned long long>(counts_.prints), static_cast<unsigned long long>(counts_.other_prints),
            static_cast<unsigned long long>(counts_.starts), static_cast<unsigned long long>(counts_.runs));
        std::printf("%llu jobs followed without a stop\n", static_cast<unsigned long long>(counts_.followers));
        std::printf("%llu records named in doubt, %llu underruns with a reason\nfaults: byte lost or damaged %llu,",
                    static_cast<unsigned long long>(counts_.in_doubt),
                    static_cast<unsigned long long>(counts_.underruns),
                    static_cast<unsigned long long>(counts_.bytes_damaged));
        for (std::size_t i = 0; i < fault_kinds; ++i) {
            if (counts_.faults[i] > 0) {
                std::printf(" %s %llu,", std::string{to_string(static_cast<Fault>(i))}.c_str(),
                            static_cast<unsigned long long>(counts_.faults[i]));
            }
        }
        std::printf("\n%.1f s on the clock: %.0f x real time, %.2f million prints/s\nviolations: %llu\n", wall_s,
                    simulated_s / wall_s, static_cast<double>(counts_.prints) / wall_s / 1e6,
                    static_cast<unsigned long long>(violations_));
    }

    const Options& options_;
    Profile profile_;
    Counts counts_;
    std::uint64_t seeds_ = 0;
    std::uint64_t violations_ = 0;
};

} // namespace
} // namespace linefeed::simulation

int main(int argc, char** argv) {
    linefeed::simulation::Options options;
    CLI::App app{"Simulates linefeed, printer, line, network, disk and operator from seeds"};
    app.add_option("--seed", options.seed, "Run this seed only");
    app.add_option("--from", options.from, "First seed");
    app.add_option("--count", options.count, "How many seeds");
    app.add_option("--hours", options.hours, "Go on until the line has printed for so many hours");
    app.add_option("--regressions", options.regressions, "Run the seeds of this file")->check(CLI::ExistingFile);
    app.add_option("--profile", options.profile, "mixed, counted, secured, chained or line")
        ->check(CLI::IsMember({"mixed", "counted", "secured", "chained", "line"}));
    app.add_flag("--trace", options.trace, "Print everything that happens");
    app.add_flag("--twice", options.twice, "Run each seed twice and compare");
    app.add_flag("--stop-at-first", options.stop_at_first, "End at the first violation");
    CLI11_PARSE(app, argc, argv);
    // The RAM disk's files come and go with every seed: their memory is kept, since fresh pages cost more than their
    // use.
    constexpr int large = 1 << 30;
    mallopt(M_MMAP_THRESHOLD, large);
    mallopt(M_TRIM_THRESHOLD, large);
    std::signal(SIGABRT, linefeed::simulation::on_abort);
    return linefeed::simulation::Program{options}.run();
}
