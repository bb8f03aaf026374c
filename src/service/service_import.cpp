// A file becomes a job because somebody asks for it: read on the thread of whoever asks, stored as the drop folders do.
#include "daemon/events.hpp"
#include "intake/row_source.hpp"
#include "service/layouts.hpp"
#include "service/service.hpp"
#include "spool/checksum.hpp"

#include <vector>

namespace linefeed::service {

namespace event_kind = daemon::event_kind;
using daemon::ImportAnswer;

namespace {

/// SHA-256 of the bytes of the file. Empty for a database whose newest content lies beside it.
Result<std::string> hash_of(const std::filesystem::path& path, const spool::SourceFingerprint& source) {
    constexpr std::size_t buffer_bytes = std::size_t{1} << 20U;
    if (!source.companion.empty()) {
        return std::string{};
    }
    auto file = intake::FileInput::open(path);
    if (!file) {
        return file.error();
    }
    spool::Sha256 sum;
    std::vector<char> buffer(buffer_bytes);
    while (true) {
        const auto got = file->read(buffer);
        if (!got) {
            return got.error();
        }
        if (*got == 0) {
            const spool::Sha256Digest digest = sum.finish();
            return spool::to_hex({reinterpret_cast<const char*>(digest.data()), digest.size()});
        }
        sum.update({buffer.data(), *got});
    }
}

Result<spool::JobSpec> spec_of(const std::filesystem::path& file, const intake::Layout& layout) {
    auto source = intake::fingerprint(file);
    if (!source) {
        return source.error();
    }
    auto hash = hash_of(file, *source);
    if (!hash) {
        return hash.error();
    }
    return spool::JobSpec{std::move(*source), intake::canonical_json(layout), RecordNumber{layout.base},
                          std::move(*hash)};
}

/// How a request wants its file to be read. FailureKind::usage if it names what is not configured.
Result<intake::Layout> layout_for(const daemon::ImportRequest& request, const config::Settings& settings,
                                  const std::shared_ptr<Line>& line) {
    const config::LayoutSettings* const layout = settings.layout(request.layout);
    const config::PrinterSettings* const printer = settings.printer(request.printer);
    if (!request.file.is_absolute()) {
        return Failure{FailureKind::usage, request.file.string() + ": give the whole path of the file"};
    }
    if (!request.layout.empty() && layout == nullptr) {
        return Failure{FailureKind::usage, "there is no layout \"" + request.layout + '"'};
    }
    if (!request.printer.empty() && printer == nullptr) {
        return Failure{FailureKind::usage, "there is no printer \"" + request.printer + '"'};
    }
    intake::Layout made = layout_of(layout == nullptr ? config::LayoutSettings{} : *layout,
                                    line == nullptr ? protocol::profiles.front() : line->profile());
    if (request.sent && !made.graphics_folder) {
        made.graphics_folder.emplace(); // nowhere
    }
    return made;
}

spool::Ticket ticket_for(const daemon::Caller& caller, const daemon::ImportRequest& request) {
    spool::Ticket ticket;
    ticket.name = request.name;
    ticket.printer = request.printer;
    ticket.layout = request.layout;
    ticket.created_by = caller.name;
    ticket.autostart = request.autostart;
    return ticket;
}

Result<ImportAnswer> import_file(const std::filesystem::path& file, const intake::Layout& layout, Batches& batches,
                                 const std::atomic<bool>& ending) {
    auto opened = intake::open_with_layout(file, layout);
    if (!opened) {
        return opened.error();
    }
    opened->options.on_progress = [&ending](const intake::ImportReport&, double) { return !ending; };
    const auto spec = spec_of(file, layout);
    if (!spec) {
        return spec.error();
    }
    const auto known =
        spec->source_sha256.empty() ? Result<std::optional<intake::KnownBatch>>{std::nullopt} : batches.find(*spec);
    if (!known) {
        return known.error();
    }
    const bool images_may_differ = *known && intake::reads_images(spec->layout);
    if (*known && !images_may_differ) {
        const auto adopted = batches.adopt((*known)->job);
        return adopted ? Result<ImportAnswer>{ImportAnswer{(*known)->job.id, true, (*known)->job.import_report}}
                       : adopted.error();
    }
    auto imported = batches.import(*opened->rows, *spec, opened->options);
    if (!imported) {
        return imported.error();
    }
    ImportAnswer answer;
    answer.report = intake::to_json(imported->report);
    answer.duplicate = imported->earlier.has_value();
    if (imported->job) {
        answer.job = imported->job->id;
    } else if (imported->earlier) {
        answer.job = imported->earlier->id;
    }
    return answer;
}

} // namespace

Result<ImportAnswer> Service::import(const daemon::Caller& caller, const daemon::ImportRequest& request) {
    const Act act{"import", request.name.empty() ? request.file.string() : request.name,
                  spool::JsonObject{}
                      .add("file", request.file.string())
                      .add("layout", request.layout)
                      .add("printer", request.printer)
                      .add_json("autostart", request.autostart ? "true" : "false")
                      .add_json("again", request.again ? "true" : "false")};
    auto answer = audited(caller, act, [&]() -> Result<ImportAnswer> {
        if (ending_) {
            return Failure{FailureKind::stopped, "the service is ending"};
        }
        const auto layout = layout_for(request, *settings(), line(request.printer));
        if (!layout) {
            return layout.error();
        }
        Batches batches{access_, ticket_for(caller, request), !request.printer.empty(), counts_.records};
        if (request.again) {
            batches.allow_again();
        }
        return import_file(request.file, *layout, batches, ending_);
    });
    if (!answer) {
        ++counts_.failed;
        return answer;
    }
    if (answer->job && !answer->duplicate) {
        ++counts_.imported;
        event(event_kind::job_imported, request.printer, answer->job, "imported by " + caller.name);
        if (!request.printer.empty()) {
            event(event_kind::job_queued, request.printer, answer->job, "waits at printer " + request.printer);
        }
    } else {
        ++(answer->duplicate ? counts_.duplicates : counts_.failed);
    }
    if (!request.printer.empty()) {
        look_for_work(request.printer);
    }
    return answer;
}

} // namespace linefeed::service
