#include "life.hpp"

#include "spool/checksum.hpp"

#include <utility>

namespace linefeed::test {

using spool::JobId;
using spool::LedgerEntry;
using spool::LedgerKind;
using spool::RecordState;

Life::Life(std::filesystem::path path, std::string vfs, std::uint64_t seed)
    : path_(std::move(path))
    , vfs_(std::move(vfs))
    , chance_(seed) {}

Result<void> Life::run() {
    if (auto done = open(); !done) {
        return done;
    }
    const auto first = import(1 + chance_.below(4), 12);
    if (!first) {
        return first.error();
    }
    const auto step = [&](Result<void> done, auto&& next) { return done ? next() : done; };
    auto done = print(*first, false);
    done = step(done, [&] { return abandon_import(); });
    done = step(done, [&] { return settle(*first); });
    done = step(done, [&] { return chance_.below(2) == 0 ? open() : Result<void>{}; });
    if (!done) {
        return done;
    }
    const auto second = import(1 + chance_.below(2), 40);
    if (!second) {
        return second.error();
    }
    done = update_source(*second);
    done = step(done, [&] { return decide(*first); });
    done = step(done, [&] { return print(*first, true); });
    done = step(done, [&] { return chance_.below(2) == 0 ? remove(*second) : print(*second, true); });
    done = step(done, [&] { return open(); });
    spool_.reset();
    return done;
}

Result<void> Life::run_large_import() {
    if (auto done = open(); !done) {
        return done;
    }
    constexpr std::uint64_t pages = 36; // of 400 KB each: 14 MB, more than one transaction of 8 MB
    const auto job = import(pages, 4000);
    spool_.reset();
    return job ? Result<void>{} : job.error();
}

Result<void> Life::open() {
    spool_.reset();
    auto opened = spool::Spool::open(path_, {[this] { return clock_ns_ += 1'000'000; }, vfs_});
    if (!opened) {
        return opened.error();
    }
    spool_.emplace(std::move(*opened));
    return {};
}

spool::JobSpec Life::next_spec() {
    spool::JobSpec spec;
    spec.source.path = "/data/source-" + std::to_string(++sources_) + ".csv";
    spec.source.size_bytes = 100 + chance_.below(1000);
    spec.layout = R"({"columns":["name"]})";
    spec.base = RecordNumber{static_cast<std::uint32_t>(chance_.below(3) * 1000)};
    return spec;
}

RecordPage Life::page(RecordNumber first, std::uint64_t records, std::uint64_t bytes_per_record) {
    RecordPage page{first, {}, {}};
    for (std::uint64_t k = 0; k < records; ++k) {
        page.frames += "^0=MR" + std::to_string(first.value() + k) + '\t';
        page.frames.append(bytes_per_record, static_cast<char>('a' + chance_.below(26)));
        page.frames += '\r';
        page.ends.push_back(static_cast<std::uint32_t>(page.frames.size()));
    }
    return page;
}

Result<JobId> Life::import(std::uint64_t pages, std::uint64_t bytes_per_record) {
    auto import = spool_->begin_import(next_spec());
    if (!import) {
        return import.error();
    }
    const auto created = spool_->job(import->id());
    if (!created || !*created) {
        return created ? Failure{FailureKind::internal, "the import is not there"} : created.error();
    }
    RecordNumber next = (*created)->spec.base.next();
    spool::Sha256 content;
    std::uint64_t records = 0;
    for (std::uint64_t i = 0; i < pages; ++i) {
        const RecordPage added = page(next, 100, bytes_per_record);
        if (auto done = import->add(added); !done) {
            return done.error();
        }
        content.update(added.frames);
        records += added.ends.size();
        next = added.range().last().next();
    }
    const spool::Sha256Digest digest = content.finish();
    after_.jobs[import->id()] = {(*created)->spec.source,
                                 RecordRange{(*created)->spec.base.next(), RecordCount{records}},
                                 spool::to_hex({reinterpret_cast<const char*>(digest.data()), digest.size()})};
    const auto job = import->commit(R"({"rows":1})");
    if (!job) {
        return job.error();
    }
    acknowledged();
    return job->id;
}

Result<void> Life::abandon_import() {
    auto import = spool_->begin_import(next_spec());
    if (!import) {
        return import.error();
    }
    const auto job = spool_->job(import->id());
    return job && *job ? import->add(page((*job)->spec.base.next(), 50, 20)) : Result<void>{};
}

std::string Life::evidence() {
    // Most is short; some does not fit on a database page with its row.
    const std::uint64_t bytes = chance_.below(20) == 0 ? 5000 : chance_.below(120);
    return R"({"sm":")" + std::string(bytes, 'e') + "\"}";
}

RecordNumber Life::some_number(RecordNumber first, RecordNumber last) {
    return first + RecordCount{chance_.below((last - first).value() + 1)};
}

Result<void> Life::append(JobId job, const std::vector<LedgerEntry>& entries) {
    for (const LedgerEntry& entry : entries) {
        after_.rows.push_back({job, entry});
    }
    if (auto done = spool_->append(job, entries); !done) {
        return done;
    }
    acknowledged();
    return {};
}

Result<void> Life::sometimes_checkpoint() {
    return chance_.below(4) == 0 ? spool_->checkpoint() : Result<void>{};
}

Result<void> Life::print(JobId job, bool to_the_end) {
    const auto state = spool_->ledger_state(job);
    if (!state) {
        return state.error();
    }
    const RecordRange range = state->next_printable(after_.jobs.at(job).records);
    if (range.empty()) {
        return {};
    }
    run_ = spool::RunId{static_cast<std::int64_t>(after_.rows.size()) + 1};
    const std::string printer = evidence();
    after_.rows.push_back({job, {LedgerKind::run_started, run_, range, printer}});
    if (const auto begun = spool_->begin_run(job, range, printer); !begun) {
        return begun.error();
    }
    acknowledged();
    RecordNumber intended = range.first().previous();
    RecordNumber printed = intended;
    while (printed < range.last()) {
        std::vector<LedgerEntry> entries;
        const bool intends = intended < range.last() && (intended == printed || chance_.below(2) == 0);
        if (intends) {
            const RecordNumber through = some_number(intended.next(), range.last());
            entries.push_back({LedgerKind::intent, run_, RecordRange::closed(intended.next(), through), ""});
            intended = through;
        }
        if (printed < intended && (!intends || chance_.below(3) == 0)) {
            const RecordNumber through = some_number(printed.next(), intended);
            entries.push_back({LedgerKind::printed, run_, RecordRange::closed(printed.next(), through), evidence()});
            printed = through;
        }
        if (auto done = append(job, entries); !done) {
            return done;
        }
        if (auto done = sometimes_checkpoint(); !done) {
            return done;
        }
        if (!to_the_end && intended > printed && chance_.below(6) == 0) {
            return {};
        }
    }
    return to_the_end ? append(job, {{LedgerKind::run_ended, run_, {}, R"({"code":"finished"})"}}) : Result<void>{};
}

Result<void> Life::settle(JobId job) {
    const auto state = spool_->ledger_state(job);
    if (!state) {
        return state.error();
    }
    std::vector<LedgerEntry> entries;
    for (const RecordRange& open : state->ranges(RecordState::open)) {
        const RecordNumber printed = some_number(open.first().previous(), open.last());
        const RecordNumber doubtful = some_number(printed, open.last());
        const auto add = [&](LedgerKind kind, RecordRange range) {
            if (!range.empty()) {
                entries.push_back({kind, run_, range, evidence()});
            }
        };
        add(LedgerKind::printed, RecordRange::closed(open.first(), printed));
        add(LedgerKind::in_doubt, RecordRange::closed(printed.next(), doubtful));
        add(LedgerKind::unused, RecordRange::closed(doubtful.next(), open.last()));
    }
    entries.push_back({LedgerKind::run_ended, run_, {}, R"({"code":"link_lost"})"});
    return append(job, entries);
}

Result<void> Life::decide(JobId job) {
    const auto state = spool_->ledger_state(job);
    if (!state) {
        return state.error();
    }
    for (const RecordRange& doubtful : state->ranges(RecordState::in_doubt)) {
        const LedgerKind word = chance_.below(2) == 0 ? LedgerKind::skipped : LedgerKind::released;
        if (auto done = append(job, {{word, run_, doubtful, R"({"who":"operator"})"}}); !done) {
            return done;
        }
    }
    return {};
}

Result<void> Life::update_source(JobId job) {
    spool::SourceFingerprint& source = after_.jobs.at(job).source;
    source.path = "/data/moved/source.csv";
    source.inode = chance_.next();
    if (auto done = spool_->update_source(job, source); !done) {
        return done;
    }
    acknowledged();
    return {};
}

Result<void> Life::remove(JobId job) {
    after_.jobs.erase(job);
    if (auto done = spool_->remove_job(job); !done) {
        return done;
    }
    acknowledged();
    return {};
}

} // namespace linefeed::test
