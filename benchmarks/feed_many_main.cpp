// Many printers fed by one process, as the service will do it: one feed thread and one store thread for all, a job for
// each printer in one spool. For run.py; the printers start one after the other, as lines do.
//
// usage: bench_feed_many --spool FILE --records N [--realtime-priority N] [--lock-memory] HOST:PORT…
// Says "printing" when the last of them prints, then one line for each that has ended; ends when all have.
#include "daemon/job_run.hpp"
#include "protocol/mail_record.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace {

using namespace linefeed;

struct Options {
    std::string spool;
    std::uint32_t records = 0;
    daemon::RealTimeSettings real_time;
    std::vector<std::string> printers;
};

std::int64_t wall_clock_ns() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch())
        .count();
}

spool::Job import_job(spool::Spool& spool, const std::string& name, std::uint32_t records) {
    constexpr std::uint32_t records_of_page = 512;
    const protocol::MailRecordEncoder encoder{{protocol::Charset::latin1}, protocol::EscapeMode::backslash};
    spool::JobSpec spec;
    spec.source.path = name;
    auto import = spool.begin_import(spec).value();
    for (std::uint32_t first = 1; first <= records; first += records_of_page) {
        RecordPage page{RecordNumber{first}, {}, {}};
        for (std::uint32_t number = first; number < std::min(records + 1, first + records_of_page); ++number) {
            std::array<char, 64> text{};
            std::snprintf(text.data(), text.size(), "SN-%010u-ABCDEFGHIJKLMNOP", number);
            encoder.append(page.frames, RecordNumber{number}, std::array{std::string_view{text.data()}}).value();
            page.ends.push_back(static_cast<std::uint32_t>(page.frames.size()));
        }
        import.add(page).value();
    }
    return import.commit({}).value();
}

void print_all(const Options& options) {
    constexpr auto between_starts = std::chrono::milliseconds{150};
    auto spool = spool::Spool::open(options.spool, {wall_clock_ns, {}}).value();
    std::vector<spool::Job> jobs;
    for (const std::string& printer : options.printers) {
        jobs.push_back(import_job(spool, printer, options.records));
    }
    daemon::FeedThread feed{options.real_time};
    store::StoreThread store{spool};
    std::cerr << feed.start() << '\n';
    std::vector<std::unique_ptr<daemon::JobRun>> runs;
    for (std::size_t place = 0; place < jobs.size(); ++place) {
        daemon::JobRunSettings settings;
        settings.printer = link::parse_printer_address("tcp://" + options.printers[place]).value();
        settings.endpoints = link::resolve(settings.printer).value();
        runs.push_back(std::make_unique<daemon::JobRun>(daemon::RunThreads{feed, store}, spool, jobs[place],
                                                        jobs[place].records, std::nullopt, settings));
        runs.back()->start();
        std::this_thread::sleep_for(between_starts);
    }
    while (!runs.back()->finished() && !runs.back()->progress().printing) {
        runs.back()->wait(10);
    }
    std::cout << "printing" << std::endl;
    for (std::size_t place = 0; place < runs.size(); ++place) {
        runs[place]->join();
        std::cout << options.printers[place] << ' ' << feeder::describe(runs[place]->outcome()) << ' '
                  << runs[place]->detail() << std::endl;
    }
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app{"Feeds many printers from one process.", "bench_feed_many"};
    Options options;
    app.add_option("--spool", options.spool)->required();
    app.add_option("--records", options.records)->required();
    app.add_option("--realtime-priority", options.real_time.priority);
    app.add_flag("--lock-memory", options.real_time.lock_memory);
    app.add_option("printers", options.printers)->required();
    CLI11_PARSE(app, argc, argv);
    try {
        print_all(options);
    } catch (const std::exception& error) {
        std::cerr << "bench_feed_many: " << error.what() << '\n';
        return 1;
    }
}
