// How long a refill takes, beside a bare socket loop (bare_host.hpp): from the last byte of `=SM` readable to the last
// byte of the refill handed to the kernel. linefeed is the whole thing: JobRun with session, link and store thread.
//
// Both hosts are fed in turn by one printer on one absolute timer, so that noise hits both alike. `reaction` counts
// from the answer's write; `from_timer` from when it was due, so that a stall that holds up the printer as well does
// not hide what it did to the refills behind it (coordinated omission).
#include "bare_host.hpp"
#include "call_log.hpp"
#include "daemon/job_run.hpp"
#include "link/printer_address.hpp"
#include "print_job.hpp"
#include "scripted_printer.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iostream>
#include <poll.h>
#include <pthread.h>
#include <sys/prctl.h>
#include <thread>

namespace {

using namespace linefeed;
using namespace linefeed::benchmarks;

constexpr std::uint32_t depth = 256;
constexpr std::uint32_t block = depth / 16; ///< printed between two answers: a refill that no feeder puts off
constexpr std::uint32_t warm_up = 300;

struct Options {
    std::uint32_t samples = 20000;
    std::uint32_t period_us = 2000; ///< from one answer to the next; each host gets every second one
    std::optional<int> priority;
};

/// One answer and the refill it asks for.
struct Answer {
    Instant due;
    Instant sent;
    std::uint32_t sent_through = 0; ///< the last record of the refill
};

/// One host under test.
struct Contestant {
    explicit Contestant(std::uint32_t records)
        : log(std::size_t{records} * 4)
        , printer(depth, records) {
        log_connections_to(printer.port(), log);
    }
    CallLog log;
    ScriptedPrinter printer;
    std::vector<Answer> answers;
};

void wait_until(Instant due, std::array<Contestant*, 2> contestants) {
    constexpr Duration spin = std::chrono::microseconds{80}; // a sleep ends late by about that much
    while (true) {
        const Duration wait = due - spin - steady_now();
        if (wait <= Duration{0}) {
            break;
        }
        const timespec timeout{wait.count() / 1000000000, wait.count() % 1000000000};
        std::array<pollfd, 2> waiting{};
        for (std::size_t i = 0; i < waiting.size(); ++i) {
            waiting[i] = {contestants[i]->printer.descriptor(), POLLIN, 0};
        }
        ::ppoll(waiting.data(), waiting.size(), &timeout, nullptr);
        for (std::size_t i = 0; i < waiting.size(); ++i) {
            if (waiting[i].revents != 0) {
                contestants[i]->printer.take();
            }
        }
    }
    while (steady_now() < due) {
    }
}

void feed_in_turn(Contestant& linefeed, Contestant& bare, std::uint32_t samples, Duration answer_period) {
    const std::array contestants{&linefeed, &bare};
    while (!linefeed.printer.ready() || !bare.printer.ready()) {
        wait_until(steady_now() + answer_period, contestants);
    }
    const Instant begun = steady_now() + answer_period;
    for (std::uint32_t i = 0; i < 2 * (samples + warm_up); ++i) {
        Contestant& turn = *contestants[i % 2];
        const Instant due = begun + answer_period * i;
        wait_until(due, contestants);
        while (!turn.printer.ready()) {
            wait_until(steady_now() + std::chrono::microseconds{100}, contestants);
        }
        const Instant sent = turn.printer.report(block);
        turn.answers.push_back({due, sent, turn.printer.printed() + depth});
    }
    const auto all_here = [](const Contestant& one) {
        return one.printer.received() >= one.answers.back().sent_through;
    };
    while (!all_here(linefeed) || !all_here(bare)) {
        wait_until(steady_now() + answer_period, contestants);
    }
}

struct Measured {
    std::vector<double> reaction_us, from_timer_us, wake_up_us, read_us, inside_us, write_us;
    /// Refills that came with a later answer's, though their own had been read before.
    int passed_over = 0;
};

double in_us(Duration duration) {
    return std::chrono::duration<double, std::micro>(duration).count();
}

Measured measured_of(const Contestant& one) {
    Measured measured;
    std::size_t call = 0;
    std::uint64_t reads_before = 0; ///< the read of the answer before
    for (std::size_t i = 0; i < one.answers.size(); ++i) {
        const Answer& answer = one.answers[i];
        const std::uint64_t bytes = one.printer.bytes_behind(answer.sent_through);
        while (one.log[call].bytes_through < bytes) {
            ++call;
        }
        const WriteCall& write = one.log[call];
        if (i >= warm_up) {
            measured.passed_over += write.reads > reads_before + 1;
            measured.reaction_us.push_back(in_us(write.returned - answer.sent));
            measured.from_timer_us.push_back(in_us(write.returned - answer.due));
            measured.wake_up_us.push_back(in_us(write.woken - answer.sent));
            measured.read_us.push_back(in_us(write.received - write.woken));
            measured.inside_us.push_back(in_us(write.entered - write.received));
            measured.write_us.push_back(in_us(write.returned - write.entered));
        }
        reads_before = write.reads;
    }
    return measured;
}

nlohmann::json quantiles(std::vector<double> values) {
    std::ranges::sort(values);
    const auto at = [&values](double fraction) {
        return values[static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1))];
    };
    return {{"p50", at(0.5)}, {"p99", at(0.99)}, {"p99.9", at(0.999)}, {"max", values.back()}};
}

nlohmann::json to_json(const Measured& measured) {
    return {{"reaction_us", quantiles(measured.reaction_us)},
            {"from_timer_us", quantiles(measured.from_timer_us)},
            {"wake_up_us", quantiles(measured.wake_up_us)},
            {"read_us", quantiles(measured.read_us)},
            {"inside_us", quantiles(measured.inside_us)},
            {"write_us", quantiles(measured.write_us)},
            {"passed_over", measured.passed_over}};
}

/// The printer on the first processor, the hosts on another: where the scheduler puts them would decide the race.
std::optional<int> processor_of_hosts() {
    const auto processors = static_cast<int>(std::thread::hardware_concurrency());
    return processors > 1 ? std::optional{processors - 1} : std::nullopt;
}

void stay_on_first_processor() {
    cpu_set_t first;
    CPU_ZERO(&first);
    CPU_SET(0, &first);
    ::pthread_setaffinity_np(::pthread_self(), sizeof first, &first);
}

int run(const Options& options) {
    ::prctl(PR_SET_TIMERSLACK, 1UL);
    const std::uint32_t records = depth + block * (options.samples + warm_up + 1);
    const std::vector<RecordPage> pages = make_pages(records);
    PrintJob print_job{pages};
    Contestant linefeed{records};
    Contestant bare{records};

    const Duration answer_period = std::chrono::microseconds{options.period_us};
    const Duration poll_interval = answer_period / 2; // so that an inquiry is there when an answer is due
    daemon::JobRunSettings settings;
    settings.printer.place = link::TcpAddress{"127.0.0.1", linefeed.printer.port()};
    settings.endpoints = link::resolve(settings.printer).value();
    auto& pacing = settings.session.feeder.pacing;
    pacing.poll_least = std::min(pacing.poll_least, poll_interval);
    pacing.poll_min = std::min(pacing.poll_min, poll_interval);
    pacing.poll_max = poll_interval;
    pacing.burst_rate = block / std::chrono::duration<double>(2 * answer_period).count();
    daemon::RealTimeSettings real_time;
    real_time.priority = options.priority;
    real_time.processor = processor_of_hosts();
    daemon::FeedThread feed{real_time};
    store::StoreThread store{print_job.spool()};
    const std::string granted = feed.start();
    daemon::JobRun job_run{{feed, store},           print_job.spool(), print_job.job(),
                           print_job.job().records, std::nullopt,      settings};
    job_run.start();
    linefeed.printer.accept();
    {
        BareHost bare_host{bare.printer.port(), pages, depth, poll_interval, real_time};
        bare.printer.accept();
        stay_on_first_processor();
        feed_in_turn(linefeed, bare, options.samples, answer_period);
        bare.printer.close();
        linefeed.printer.close();
    }
    job_run.join();

    std::cout << nlohmann::json{{"samples", options.samples},
                                {"real_time", granted},
                                {"linefeed", to_json(measured_of(linefeed))},
                                {"bare", to_json(measured_of(bare))}}
                     .dump(2)
              << std::endl;
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app{"The time from =SM to the refill, beside a bare socket loop. JSON on stdout."};
    Options options;
    app.add_option("--samples", options.samples, "Refills of each host")->check(CLI::Range(100U, 1000000U));
    app.add_option("--period-us", options.period_us, "From one answer to the next; each host gets every second one")
        ->check(CLI::Range(200U, 1000000U));
    app.add_option("--priority", options.priority, "SCHED_FIFO priority of both hosts")->check(CLI::Range(1, 99));
    CLI11_PARSE(app, argc, argv);
    return run(options);
}
