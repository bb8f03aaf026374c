#include "cli/source_import.hpp"

namespace linefeed::cli {

namespace {

std::unique_ptr<daemon::RunningImport> start(spool::JobImport job, intake::OpenedSource opened,
                                             const spool::JobSpec& spec) {
    auto import = std::make_unique<daemon::RunningImport>(std::move(job), std::move(opened.rows), spec,
                                                          std::move(opened.options));
    import->start();
    return import;
}

} // namespace

Result<intake::ImportOutcome> import_whole(const PrintOptions& options, spool::Spool& spool, const spool::JobSpec& spec,
                                           const ImportProgress& on_progress) {
    auto opened = intake::open_with_layout(options.file, options.layout);
    if (!opened) {
        return opened.error();
    }
    opened->options.on_progress = [&](const intake::ImportReport& report, double fraction) {
        return on_progress(report.rows, fraction);
    };
    return intake::import_source(*opened->rows, spool, spec, opened->options);
}

Result<std::unique_ptr<daemon::RunningImport>> start_import(const PrintOptions& options, spool::Spool& spool,
                                                            const spool::JobSpec& spec) {
    auto opened = intake::open_with_layout(options.file, options.layout);
    if (!opened) {
        return opened.error();
    }
    auto job = spool.begin_import(spec, intake::to_json(intake::empty_report(*opened->rows, opened->options)));
    if (!job) {
        return job.error();
    }
    return start(std::move(*job), std::move(*opened), spec);
}

Result<std::unique_ptr<daemon::RunningImport>> go_on_with_import(const PrintOptions& options, spool::Spool& spool,
                                                                 const spool::Job& job,
                                                                 const spool::SourceFingerprint& source) {
    auto opened = intake::open_with_layout(options.file, options.layout);
    if (!opened) {
        return opened.error();
    }
    auto import = spool.resume_import(job, source);
    if (!import) {
        return import.error();
    }
    return start(std::move(*import), std::move(*opened), {source, job.spec.layout, job.spec.base});
}

Result<void> import_on(daemon::RunningImport& import, const std::function<bool()>& enough,
                       const ImportProgress& on_progress) {
    constexpr int wait_ms = 50;
    while (!enough() && !import.over()) {
        if (import.wants_step()) {
            import.step();
        } else {
            import.wait(wait_ms);
        }
        if (!on_progress(import.rows(), import.fraction())) {
            return Failure{FailureKind::stopped, "the import was cancelled"};
        }
    }
    return import.failure() ? Result<void>{*import.failure()} : Result<void>{};
}

} // namespace linefeed::cli
