#include "cli/job_selection.hpp"

#include "cli/earlier_jobs.hpp"

namespace linefeed::cli {

namespace {

Failure with_way_out(const Failure& failure) {
    return failure.kind == FailureKind::input
               ? Failure{failure.kind, failure.message + ": restore the file to go on, or print it as a new job with "
                                                         "--new-job"}
               : failure;
}

/// So many records that are left to print last longer than reading the file anew up to where it was broken off.
constexpr RecordCount comfortable_lead{100'000};

/// What has come of an import that is over, or the import that runs on.
Result<JobSelection> selection_of(spool::Spool& spool, std::unique_ptr<daemon::RunningImport> import) {
    const auto job = spool.job(import->job());
    if (!job || !*job) {
        return job ? Failure{FailureKind::internal, "the imported job is gone"} : job.error();
    }
    JobSelection selection{**job, {}, true, {}};
    if (!import->over()) {
        selection.running = std::move(import);
    } else {
        selection.report = import->report();
        selection.refused = import->refused();
    }
    return selection;
}

/// Goes on with a job whose import was broken off or stopped while it was printed.
Result<JobSelection> go_on(const PrintOptions& options, spool::Spool& spool, const spool::Job& job,
                           const spool::SourceFingerprint& source, const ImportProgress& on_progress) {
    auto import = go_on_with_import(options, spool, job, source);
    if (!import) {
        return import.error();
    }
    // A mended file is compared before anything is printed of it; and where few records are left to print, the import
    // has to catch up first, or the line would run dry.
    const auto state = spool.ledger_state(job.id);
    if (!state) {
        return state.error();
    }
    const RecordRange left = state->next_printable(job.records);
    const bool compares_first = source != job.spec.source || left.count() < comfortable_lead;
    const auto enough = [&] { return options.while_importing && !(compares_first && (*import)->compares()); };
    if (const auto done = import_on(**import, enough, on_progress); !done) {
        return with_way_out(done.error());
    }
    return selection_of(spool, std::move(*import));
}

/// The job of this file whose import is not finished; absent = there is none.
Result<std::optional<JobSelection>> continue_unfinished(const PrintOptions& options, spool::Spool& spool,
                                                        const spool::JobSpec& spec, const ImportProgress& on_progress) {
    const auto unfinished = spool.unfinished_jobs();
    if (!unfinished) {
        return unfinished.error();
    }
    for (const spool::Job& job : *unfinished) {
        const bool same_way = job.spec.layout == spec.layout && job.spec.base == spec.base;
        const bool same = same_way && job.spec.source == spec.source;
        const bool stopped = job.state == spool::ImportState::stopped;
        if (same && options.new_job) {
            return Failure{FailureKind::usage,
                           name_of(job) + " has the same records and is not finished: continue it without --new-job"};
        }
        if (job.spec.source.path != spec.source.path || options.new_job) {
            continue;
        }
        if (same && stopped) {
            return std::optional{JobSelection{job, {}, false, {}}};
        }
        // A mended file, or perhaps a copy that was put back: its records are compared.
        const bool comparable = same_way && (stopped || job.spec.source.size_bytes == spec.source.size_bytes);
        if (!same && !comparable) {
            const auto printed = printed_of(spool, job);
            if (!printed) {
                return printed.error();
            }
            return Failure{FailureKind::input,
                           spec.source.path + " or the way to read it has changed since " + name_of(job) +
                               " was begun, which was imported while it was printed and of which " +
                               std::to_string(printed->value()) +
                               " records are printed: restore the file and options to go on, or print it from its "
                               "first record as a new job with --new-job"};
        }
        auto selection = go_on(options, spool, job, spec.source, on_progress);
        return selection ? Result<std::optional<JobSelection>>{std::move(*selection)} : selection.error();
    }
    return std::optional<JobSelection>{};
}

/// Imports a file that may be printed meanwhile; to its end if it could be one that is known.
Result<JobSelection> begin_running(const PrintOptions& options, spool::Spool& spool, const spool::JobSpec& spec,
                                   const ImportProgress& on_progress) {
    auto import = start_import(options, spool, spec);
    if (!import) {
        return import.error();
    }
    const auto begun = [&] { return !(*import)->durable().empty(); };
    if (const auto done = import_on(**import, begun, on_progress); !done) {
        return done.error();
    }
    if (!(*import)->over()) {
        const auto known = may_be_known(spool, spec, (*import)->job(), options.new_job);
        if (!known) {
            return known.error();
        }
        const bool whole = *known || (*import)->refused(); // nothing is printed yet: a bad row refuses the file
        if (const auto done = whole ? import_on(
                                          **import, [] { return false; }, on_progress)
                                    : Result<void>{};
            !done) {
            return done.error();
        }
    }
    auto selection = selection_of(spool, std::move(*import));
    if (selection && selection->refused) {
        selection->job.reset(); // found before anything was printed: it goes
    }
    return selection;
}

Result<JobSelection> begin_whole(const PrintOptions& options, spool::Spool& spool, const spool::JobSpec& spec,
                                 const ImportProgress& on_progress) {
    auto outcome = import_whole(options, spool, spec, on_progress);
    if (!outcome) {
        return outcome.error();
    }
    return JobSelection{std::move(outcome->job), std::move(outcome->report), true, {}};
}

} // namespace

Result<JobSelection> select_job(const PrintOptions& options, spool::Spool& spool, const ImportProgress& on_progress) {
    const auto source = intake::fingerprint(options.file);
    if (!source) {
        return source.error();
    }
    const spool::JobSpec spec{*source, intake::canonical_json(options.layout), RecordNumber{options.layout.base}};
    const auto known = spool.find_by_source(spec);
    if (!known) {
        return known.error();
    }
    if (*known && !options.new_job) {
        return JobSelection{**known, {}, false, {}};
    }
    auto unfinished = continue_unfinished(options, spool, spec, on_progress);
    if (!unfinished) {
        return unfinished.error();
    }
    if (*unfinished) {
        return std::move(**unfinished);
    }
    auto selection = options.while_importing ? begin_running(options, spool, spec, on_progress)
                                             : begin_whole(options, spool, spec, on_progress);
    if (!selection || !selection->job || selection->running) {
        return selection;
    }
    const spool::Job job = *selection->job;
    const auto twin = twin_of(spool, job, options.new_job);
    auto checked = twin ? Result<void>{} : Result<void>{twin.error()};
    if (checked && !*twin && !options.new_job) {
        checked = check_earlier_jobs(spool, job);
        checked = checked ? check_unfinished(spool, job) : checked;
    }
    if (checked && !*twin) {
        return selection;
    }
    if (const auto removed = spool.remove_job(job.id); !removed) {
        return removed.error();
    }
    if (!checked) {
        return checked.error();
    }
    if (const auto updated = spool.update_source((*twin)->id, *source); !updated) {
        return updated.error();
    }
    return JobSelection{**twin, {}, false, {}};
}

} // namespace linefeed::cli
