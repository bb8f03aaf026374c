// Starting, asking and reporting, see fleet.hpp.
#include "simulator/fleet.hpp"

#include <nlohmann/json.hpp>

#include <charconv>
#include <csignal>
#include <fstream>
#include <iostream>
#include <utility>

namespace linefeed::simulator {
namespace {

using nlohmann::json;

json in_ns(std::optional<Duration> duration) {
    return duration ? json(duration->count()) : json();
}

json in_ns(std::optional<Instant> instant) {
    return instant ? in_ns(instant->time_since_epoch()) : json();
}

json report_of(LeadTimeLog& log, const RunStatistics& run) {
    json misses = json::array();
    for (const Miss& miss : log.listed_misses()) {
        misses.push_back({in_ns(miss.at), miss.late.count(), in_ns(miss.lead)});
    }
    json late = json::array();
    for (const LatePrintGo& print_go : log.listed_late()) {
        late.push_back({in_ns(print_go.due), in_ns(print_go.at)});
    }
    return {
        {"prints", log.prints()},
        {"first_print_ns", in_ns(log.first_print())},
        {"last_print_ns", in_ns(log.last_print())},
        {"lead_ns",
         {{"min", in_ns(log.quantile(0))},
          {"p0.001", in_ns(log.quantile(0.00001))},
          {"p0.1", in_ns(log.quantile(0.001))},
          {"p50", in_ns(log.quantile(0.5))}}},
        {"misses", log.misses()},
        {"miss_at_late_lead_ns", misses},
        {"late_print_gos", log.late_print_gos()},
        {"late_due_at_ns", late},
        {"highest_fill", run.highest_fill},
        {"lowest_fill", run.lowest_fill == UINT32_MAX ? json() : json(run.lowest_fill)},
        {"doubles", run.numbers.doubles()},
        {"missing_numbers", run.numbers.missing()},
        {"errors", run.errors.size()},
    };
}

/// The same printer, `place` further on.
SimulatorSettings settings_of(SimulatorSettings settings, unsigned place) {
    unsigned port = 0;
    std::from_chars(settings.port.data(), settings.port.data() + settings.port.size(), port);
    if (place > 0) {
        settings.printer.serial_number += "-" + std::to_string(place + 1);
        settings.conveyor.seed += place;
        settings.port = std::to_string(port == 0 ? 0 : port + place);
    }
    return settings;
}

} // namespace

Fleet::Fleet(const SimulatorSettings& settings, FleetSettings fleet)
    : settings_(std::move(fleet)) {
    for (unsigned place = 0; place < settings_.printers; ++place) {
        simulators_.push_back(std::make_unique<Simulator>(settings_of(settings, place), io_));
    }
}

Result<std::vector<std::string>> Fleet::open() {
    std::vector<std::string> addresses;
    for (const auto& simulator : simulators_) {
        auto address = simulator->open();
        if (!address) {
            return address.error();
        }
        addresses.push_back(*std::move(address));
    }
    if (settings_.report) {
        questions_.add(SIGUSR1);
        wait_for_question();
    }
    return addresses;
}

Result<void> Fleet::run() {
    if (settings_.report) {
        hiccups_.start();
    }
    for (const auto& simulator : simulators_) {
        simulator->start();
    }
    io_.run();
    hiccups_.stop();
    Result<void> ended;
    for (const auto& simulator : simulators_) {
        if (auto finished = simulator->finish(); !finished) {
            ended = finished;
        }
    }
    return ended;
}

void Fleet::wait_for_question() {
    questions_.async_wait([this](const boost::system::error_code& error, int) {
        if (error) {
            return;
        }
        std::uint64_t prints = 0;
        std::uint64_t misses = 0;
        for (const auto& simulator : simulators_) {
            prints += simulator->lead_times()->prints();
            misses += simulator->lead_times()->misses();
        }
        std::cout << json{{"prints", prints}, {"misses", misses}}.dump() << std::endl;
        wait_for_question();
    });
}

std::vector<const RunStatistics*> Fleet::statistics() const {
    std::vector<const RunStatistics*> all;
    for (const auto& simulator : simulators_) {
        all.push_back(&simulator->statistics());
    }
    return all;
}

Result<void> Fleet::write_report() {
    if (!settings_.report) {
        return {};
    }
    json printers = json::array();
    for (const auto& simulator : simulators_) {
        printers.push_back(report_of(*simulator->lead_times(), simulator->statistics()));
    }
    json stalls = json::array();
    for (const Stall& stall : hiccups_.stalls()) {
        stalls.push_back({in_ns(stall.from), in_ns(stall.to)});
    }
    std::ofstream file{*settings_.report};
    file << json{{"printers", printers}, {"stalls_ns", stalls}}.dump() << '\n';
    if (!file.flush()) {
        return Failure{FailureKind::internal, "cannot write the report " + *settings_.report};
    }
    return {};
}

} // namespace linefeed::simulator
