#include "intake/batch_store.hpp"

#include "intake/grown_batch.hpp"
#include "intake/layout.hpp"

#include <algorithm>
#include <filesystem>

namespace linefeed::intake {

namespace {

bool is_same_folder(const spool::JobSpec& one, const spool::JobSpec& other) {
    return std::filesystem::path{one.source.path}.parent_path() ==
           std::filesystem::path{other.source.path}.parent_path();
}

} // namespace

Result<FoundBatch> find_batch(spool::Spool& spool, const spool::JobSpec& spec) {
    const auto jobs = spool.find_by_source_bytes(spec.source_sha256);
    if (!jobs) {
        return jobs.error();
    }
    for (const spool::Job& job : *jobs) {
        if (job.spec.source != spec.source) {
            continue;
        }
        // Perhaps the last that import() did before a crash, so that it could not compare the records any more.
        auto earlier = earlier_job(spool, job);
        if (!earlier) {
            return earlier.error();
        }
        return *earlier ? FoundBatch{KnownBatch{std::move(**earlier), false}, job.id}
                        : FoundBatch{KnownBatch{job, true}, {}};
    }
    if (reads_images(spec.layout)) {
        return FoundBatch{}; // its images may be others now: the records tell
    }
    for (const spool::Job& job : *jobs) {
        if ((job.spec.layout == spec.layout && job.spec.base == spec.base) || is_same_folder(job.spec, spec)) {
            return FoundBatch{KnownBatch{job, false}, {}};
        }
    }
    return FoundBatch{};
}

Result<std::optional<spool::Job>> earlier_job(spool::Spool& spool, const spool::Job& job) {
    auto same = spool.find_by_content(job.content_sha256);
    if (!same) {
        return same.error();
    }
    // Whichever was begun first: imports may overlap, and this one has become ready last.
    const auto other = std::ranges::find_if(*same, [&](const spool::Job& one) {
        return one.id != job.id &&
               (is_same_way(one.spec.layout, job.spec.layout) || is_same_folder(one.spec, job.spec));
    });
    if (other == same->end()) {
        return std::optional<spool::Job>{};
    }
    const auto state = spool.ledger_state(job.id);
    if (!state) {
        return state.error();
    }
    if (!state->segments().empty()) {
        return std::optional<spool::Job>{}; // somebody wants it printed again
    }
    return std::optional{std::move(*other)};
}

Result<std::optional<KnownBatch>> SpoolBatches::find(const spool::JobSpec& spec) {
    auto found = find_batch(spool_, spec);
    if (!found) {
        return found.error();
    }
    if (found->gives_way) {
        if (auto removed = spool_.remove_job(*found->gives_way); !removed) {
            return removed.error();
        }
    }
    return std::move(found->known);
}

Result<BatchImport> SpoolBatches::import(RowSource& source, const spool::JobSpec& spec, const ImportOptions& options) {
    GrownCheck grown{spec, [this](const auto& what) { return what(spool_); }};
    auto outcome = import_source(source, spool_, spec, options.refuse_grown ? grown.in(options) : options);
    if (!outcome) {
        return outcome.error();
    }
    BatchImport batch{std::move(outcome->report), std::move(outcome->job), {}};
    if (!batch.job) {
        return batch;
    }
    auto earlier = earlier_job(spool_, *batch.job);
    if (!earlier) {
        return earlier.error();
    }
    if (*earlier) {
        if (auto removed = spool_.remove_job(batch.job->id); !removed) {
            return removed.error();
        }
        batch.earlier = std::move(*earlier);
        batch.job.reset();
    }
    return batch;
}

} // namespace linefeed::intake
