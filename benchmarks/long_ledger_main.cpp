// A long life of a spool in seconds, for run.py: runs that print the newest job record by record, each with an intent
// and a confirmation of its own, as the slowest of lines would leave them.
//
// usage: bench_long_ledger --spool FILE --records N
#include "spool/spool.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

namespace {

using namespace linefeed;
using spool::LedgerKind;

void print_run(spool::Spool& spool, spool::JobId job, RecordRange range) {
    const spool::RunId run = spool.begin_run(job, range, "{}").value();
    std::vector<spool::LedgerEntry> entries;
    for (std::uint64_t k = 0; k < range.count().value(); ++k) {
        const RecordNumber number = range.first() + RecordCount{k};
        const RecordRange record = RecordRange::closed(number, number);
        entries.push_back({LedgerKind::intent, run, record, {}});
        entries.push_back({LedgerKind::printed, run, record, "{}"});
    }
    entries.push_back({LedgerKind::run_ended, run, {}, "{}"});
    spool.append(job, entries).value();
}

void fill(const std::string& path, std::uint32_t records) {
    constexpr std::uint32_t records_of_run = 5000;
    auto spool = spool::Spool::open(path, {}).value();
    const spool::Job job = spool.jobs().value().back();
    for (std::uint32_t first = 1; first <= records; first += records_of_run) {
        const std::uint32_t last = std::min(records, first + records_of_run - 1);
        print_run(spool, job.id, RecordRange::closed(RecordNumber{first}, RecordNumber{last}));
        spool.checkpoint().value();
    }
}

} // namespace

int main(int argc, char** argv) {
    std::string path;
    std::uint32_t records = 0;
    CLI::App app{"Makes the ledger of a spool long"};
    app.add_option("--spool", path)->required();
    app.add_option("--records", records)->required();
    CLI11_PARSE(app, argc, argv);
    try {
        fill(path, records);
        return 0;
    } catch (const std::exception& error) {
        std::cerr << "bench_long_ledger: " << error.what() << '\n';
        return 1;
    }
}
