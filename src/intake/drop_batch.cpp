// One claimed file: from processing/ to its end. Every step can be done again after a crash.
#include "base/assert.hpp"
#include "intake/drop_folder.hpp"
#include "spool/checksum.hpp"

#include <algorithm>
#include <vector>

namespace linefeed::intake {

namespace {

constexpr std::size_t hash_bytes = std::size_t{1} << 20U;
/// A hash that takes less than that many of them is not told of.
constexpr std::uint64_t silent_pieces = 16;

std::string what_it_is(FileKind kind) {
    switch (kind) {
    case FileKind::regular:
        return "this is a file";
    case FileKind::directory:
        return "this is a directory";
    case FileKind::symbolic_link:
        return "this is a symbolic link, which is not followed";
    case FileKind::other:
        return "this is a pipe, a socket or a device, not a file";
    }
    assertion_failed("FileKind", __FILE__, __LINE__);
}

/// Without the path in front: the report names the file, and it will be elsewhere then.
std::string without_path(const std::string& message, const std::filesystem::path& path) {
    const std::string prefix = path.string() + ": ";
    return message.starts_with(prefix) ? message.substr(prefix.size()) : message;
}

/// A failure that is about the file, not about the store or the operator.
bool is_about_the_file(const Failure& failure) {
    return failure.kind == FailureKind::input || failure.kind == FailureKind::usage;
}

void name_job(DropReport& report, const spool::Job& job) {
    report.job = job.id;
    report.records = job.records;
}

} // namespace

Result<bool> DropFolder::handle(Claimed& batch, Instant now) {
    const auto look = directory_.look_claimed(batch.kept);
    if (!look) {
        return look.error();
    }
    if (!*look) {
        events_.note(batch.name, "it has vanished from processing/");
        return true;
    }
    bool changed = false;
    auto report = read(batch, **look, changed);
    if (report && report->verdict == DropVerdict::failed && is_changed(batch, **look)) {
        changed = true; // what is wrong with half a file says nothing about the whole
    }
    if (changed) {
        if (!batch.told) {
            batch.told = true;
            events_.note(batch.name, "it was changed while it was read: it is read again when it is complete");
        }
        batch.not_before = now + settings_.settle.quiet;
        return false;
    }
    if (!report) {
        return report.error();
    }
    events_.reached(DropStep::imported);
    auto finished = finish(batch, *report);
    return finished ? Result<bool>{true} : finished.error();
}

bool DropFolder::is_changed(const Claimed& batch, const FileLook& before) const {
    const auto now = directory_.look_claimed(batch.kept);
    return !now || *now != before;
}

/// From the file to its report. `changed` is set if nothing is to be made of what was read.
Result<DropReport> DropFolder::read(Claimed& batch, const FileLook& look, bool& changed) {
    DropReport report;
    report.name = batch.name;
    report.size_bytes = look.size_bytes;
    const auto failed = [&report](std::string reason) {
        report.reason = std::move(reason);
        return report;
    };
    if (look.kind != FileKind::regular) {
        return failed(what_it_is(look.kind));
    }
    if (look.size_bytes > settings_.max_bytes) {
        return failed("it has " + std::to_string(look.size_bytes) + " bytes, more than the " +
                      std::to_string(settings_.max_bytes) + " that are allowed");
    }
    auto file = directory_.open_claimed(batch.kept);
    if (!file) {
        return is_about_the_file(file.error())
                   ? Result<DropReport>{failed(
                         without_path(file.error().message, directory_.path() / "processing" / batch.kept))}
                   : file.error();
    }
    auto sum = hash(batch, *file);
    if (!sum) {
        return is_about_the_file(sum.error()) ? Result<DropReport>{failed(sum.error().message)} : sum.error();
    }
    changed = is_changed(batch, look);
    if (changed) {
        return report;
    }
    events_.reached(DropStep::hashed);
    report.sha256 = *sum;
    // Where it will be, so that `linefeed print` finds the job by the file afterwards.
    spool::JobSpec spec;
    spec.source.path = (directory_.path() / "done" / batch.kept).string();
    spec.source.size_bytes = look.size_bytes;
    spec.source.modified_ns = look.modified_ns;
    spec.source.inode = look.inode;
    spec.layout = layout_json_;
    spec.base = RecordNumber{settings_.layout.base};
    spec.source_sha256 = report.sha256;
    const auto known = store_.find(spec);
    if (!known) {
        return known.error();
    }
    const bool images_may_differ = *known && (*known)->this_file && !batch.begun && reads_images(spec.layout);
    if (*known && !images_may_differ) {
        const spool::Job& job = (*known)->job;
        const bool own = batch.begun && (*known)->this_file;
        const bool same_way = job.spec.layout == spec.layout && job.spec.base == spec.base;
        report.verdict = own ? DropVerdict::imported : DropVerdict::duplicate;
        report.reason = own ? ""
                            : "its content was imported before, from " + job.spec.source.path +
                                  (same_way ? "" : ", and read with other options then");
        name_job(report, job);
        return report;
    }
    // Otherwise a power failure could undo the claim, but not the job, and the file would seem to be a second one.
    if (auto synced = directory_.sync_claims(); !synced) {
        return synced.error();
    }
    batch.begun = true;
    events_.importing(batch.name, batch.left_over);
    if (auto imported = import(batch, std::move(*file), look, spec, report, changed); !imported) {
        return imported.error();
    }
    return report;
}

Result<std::string> DropFolder::hash(const Claimed& batch, FileInput& file) {
    spool::Sha256 sum;
    std::vector<char> buffer(hash_bytes);
    std::uint64_t pieces = 0;
    for (std::uint64_t bytes = 0;;) {
        const auto got = file.read(buffer);
        if (!got) {
            return got.error();
        }
        if (*got == 0) {
            break;
        }
        sum.update({buffer.data(), *got});
        bytes += *got;
        const double fraction = static_cast<double>(bytes) / static_cast<double>(std::max(bytes, file.size()));
        if (++pieces > silent_pieces && !events_.progress(batch.name, 0, fraction)) {
            return Failure{FailureKind::stopped, "broken off: it will be imported at the next start"};
        }
    }
    if (auto back = file.rewind(); !back) {
        return back.error();
    }
    const spool::Sha256Digest digest = sum.finish();
    return spool::to_hex({reinterpret_cast<const char*>(digest.data()), digest.size()});
}

Result<void> DropFolder::import(const Claimed& batch, FileInput file, const FileLook& look, const spool::JobSpec& spec,
                                DropReport& report, bool& changed) {
    const std::filesystem::path path = file.path();
    auto opened = open_with_layout(std::move(file), settings_.layout);
    const auto failed = [&](const Failure& failure) -> Result<void> {
        if (!is_about_the_file(failure)) {
            return failure;
        }
        report.reason = without_path(failure.message, path);
        return {};
    };
    if (!opened) {
        return failed(opened.error());
    }
    opened->options.check_source = [&]() -> Result<void> {
        changed = is_changed(batch, look);
        return changed ? Failure{FailureKind::input, "it was changed while it was read"} : Result<void>{};
    };
    opened->options.refuse_grown = settings_.refuse_grown;
    opened->options.on_progress = [&](const ImportReport& so_far, double fraction) {
        return events_.progress(batch.name, so_far.rows, fraction);
    };
    auto imported = store_.import(*opened->rows, spec, opened->options);
    if (!imported) {
        return failed(imported.error());
    }
    report.import = std::move(imported->report);
    report.reason = describe_bad_rows(*report.import);
    if (imported->job) {
        report.verdict = DropVerdict::imported;
        name_job(report, *imported->job);
    } else if (imported->earlier) {
        report.verdict = DropVerdict::duplicate;
        report.reason = "its records were imported before, from " + imported->earlier->spec.source.path;
        name_job(report, *imported->earlier);
    }
    return {};
}

/// Report first: a file that lies in done/ or failed/ has one.
Result<void> DropFolder::finish(const Claimed& batch, DropReport& report) {
    const DropEnd end = report.end();
    const auto name = directory_.free_name(end, batch.kept);
    if (!name) {
        return name.error();
    }
    report.kept_as = std::string{to_string(end)} + '/' + *name;
    if (auto written = directory_.write_report(end, *name, to_json(report) + '\n'); !written) {
        return written.error();
    }
    events_.reached(DropStep::reported);
    events_.finished(report);
    const auto moved = directory_.finish(end, batch.kept, *name);
    if (!moved) {
        return moved.error();
    }
    if (!*moved) {
        events_.note(batch.name, "it has vanished from processing/");
    }
    events_.reached(DropStep::moved);
    return {};
}

} // namespace linefeed::intake
