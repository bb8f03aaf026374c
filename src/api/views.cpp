#include "api/views.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace linefeed::api {

namespace {

using daemon::JobPhase;

constexpr std::array job_phases{JobPhase::importing, JobPhase::ready,     JobPhase::queued,  JobPhase::arming,
                                JobPhase::printing,  JobPhase::stopping,  JobPhase::stopped, JobPhase::in_doubt,
                                JobPhase::finished,  JobPhase::cancelled, JobPhase::failed};

Json text_or_null(std::string_view text) {
    return text.empty() ? Json(nullptr) : Json(visible(text));
}

template <typename T>
Json value_or_null(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}

/// JSON has neither infinity nor NaN.
Json seconds_or_null(const std::optional<double>& seconds) {
    return seconds && std::isfinite(*seconds) ? Json(*seconds) : Json(nullptr);
}

Json number(spool::JobId id) {
    return static_cast<std::int64_t>(id);
}

Json number_or_null(const std::optional<spool::JobId>& id) {
    return id ? number(*id) : Json(nullptr);
}

Json number_or_null(const std::optional<RecordNumber>& record) {
    return record ? Json(record->value()) : Json(nullptr);
}

Json range_or_null(const RecordRange& range) {
    return range.empty() ? Json(nullptr)
                         : Json{{"first", range.first().value()},
                                {"last", range.last().value()},
                                {"count", range.count().value()}};
}

Json error_or_null(const daemon::PrinterView& printer) {
    if (printer.error.none()) {
        return nullptr;
    }
    return {{"code", printer.error.code()},
            {"raw", printer.error.raw},
            {"words", describe(printer.error)},
            {"meaning", visible(printer.error_meaning)},
            {"advice", visible(printer.error_advice)}};
}

Json figures_json(const daemon::PrinterFigures& figures) {
    return {{"fifo_depth", figures.fifo_depth},
            {"fifo_entries", figures.fifo_entries},
            {"credit", figures.credit},
            {"rate_per_s", seconds_or_null(figures.rate_per_s)},
            {"lead_time_s", seconds_or_null(figures.lead_time_s)},
            {"time_to_empty_s", seconds_or_null(figures.time_to_empty_s)},
            {"data_left_s", seconds_or_null(figures.data_left_s)}};
}

std::string lower_case_hex(std::string_view bytes) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string hex;
    for (const char byte : bytes) {
        const auto value = static_cast<unsigned char>(byte);
        hex += digits[value >> 4U];
        hex += digits[value & 0xFU];
    }
    return hex;
}

} // namespace

Json to_json(const daemon::Finding& finding) {
    return {{"check", visible(finding.check)},
            {"severity", to_string(finding.severity)},
            {"words", visible(finding.words)},
            {"advice", visible(finding.advice)}};
}

Json to_json(const daemon::ServiceStatus& status) {
    return {{"version", visible(status.version)},  {"started", rfc3339(status.started_ns)},
            {"started_ns", status.started_ns},     {"ready", status.ready},
            {"checks", items_json(status.checks)}, {"real_time", visible(status.real_time)}};
}

Json to_json(const daemon::PrinterView& printer) {
    Json queue = Json::array();
    for (const spool::JobId id : printer.queue) {
        queue.push_back(number(id));
    }
    Json warnings = Json::array();
    for (const std::string& warning : printer.warnings) {
        warnings.push_back(visible(warning));
    }
    const bool heard = printer.heard_ns != 0;
    return {{"name", visible(printer.name)},
            {"address", visible(printer.address)},
            {"profile", visible(printer.profile)},
            {"link", to_string(printer.link)},
            {"watched", printer.watched},
            {"phase", to_string(printer.phase)},
            {"machine", text_or_null(printer.machine)},
            {"nozzle", text_or_null(printer.nozzle)},
            {"cover_open", value_or_null(printer.cover_open)},
            {"serial_number", text_or_null(printer.serial_number)},
            {"known_serial_number", text_or_null(printer.known_serial_number)},
            {"firmware", text_or_null(printer.firmware)},
            {"probe", printer.probe.empty() ? Json(nullptr) : Json::parse(printer.probe, nullptr, false)},
            {"probed", printer.probe.empty() ? Json(nullptr) : Json(rfc3339(printer.probed_ns))},
            {"probed_ns", printer.probe.empty() ? Json(nullptr) : Json(printer.probed_ns)},
            {"total_prints", value_or_null(printer.total_prints)},
            {"error", error_or_null(printer)},
            {"panel_suspended", printer.panel_suspended},
            {"job", number_or_null(printer.job)},
            {"queue", std::move(queue)},
            {"autostart", printer.autostart},
            {"held", printer.held},
            {"figures", figures_json(printer.figures)},
            {"warnings", std::move(warnings)},
            {"heard", heard ? Json(rfc3339(printer.heard_ns)) : Json(nullptr)},
            {"heard_ns", heard ? Json(printer.heard_ns) : Json(nullptr)}};
}

Json to_json(const daemon::FrameView& frame) {
    return {{"id", frame.id},
            {"time", rfc3339(frame.time_ns)},
            {"time_ns", frame.time_ns},
            {"direction", frame.sent ? "sent" : "received"},
            {"text", visible_ascii(frame.bytes)},
            {"hex", lower_case_hex(frame.bytes)},
            {"size", frame.size},
            {"records", range_or_null(frame.records)}};
}

Json to_json(const daemon::JobView& job) {
    return {{"id", number(job.id)},
            {"name", visible(job.name)},
            {"source", visible(job.source)},
            {"printer", text_or_null(job.printer)},
            {"layout", text_or_null(job.layout)},
            {"phase", to_string(job.phase)},
            {"message", visible(job.message)},
            {"autostart", job.autostart},
            {"place", value_or_null(job.place)},
            {"records", range_or_null(job.records)},
            {"printed", job.printed.value()},
            {"in_doubt", job.in_doubt.value()},
            {"open", job.open.value()},
            {"skipped", job.skipped.value()},
            {"last_printed", number_or_null(job.last_printed)},
            {"next", range_or_null(job.next)},
            {"created", rfc3339(job.created_ns)},
            {"created_ns", job.created_ns},
            {"created_by", visible(job.created_by)}};
}

Json to_json(const daemon::DoubtView::Record& record) {
    Json fields = Json::array();
    for (const std::string& field : record.fields) {
        fields.push_back(visible(field));
    }
    return {{"number", record.number.value()}, {"fields", std::move(fields)}};
}

Json to_json(const daemon::DoubtView& doubt) {
    return {{"count", doubt.count.value()},
            {"records", items_json(doubt.records)},
            {"hole", text_or_null(doubt.hole)},
            {"as_of", doubt.as_of}};
}

Json to_json(const daemon::ImportAnswer& answer) {
    return {
        {"job", number_or_null(answer.job)}, {"duplicate", answer.duplicate}, {"report", parsed_object(answer.report)}};
}

Json to_json(const daemon::FolderView& folder) {
    Json staying = Json::array();
    for (const auto& file : folder.staying) {
        staying.push_back({{"name", visible(file.name)}, {"why", visible(file.why)}});
    }
    return {{"name", visible(folder.name)},
            {"path", visible(folder.path.native())},
            {"printer", visible(folder.printer)},
            {"layout", visible(folder.layout)},
            {"works", folder.works},
            {"message", visible(folder.message)},
            {"staying", std::move(staying)},
            {"imported", folder.imported},
            {"duplicates", folder.duplicates},
            {"failed", folder.failed}};
}

Json to_json(const daemon::EventView& event) {
    return {{"id", event.id},
            {"time", rfc3339(event.time_ns)},
            {"time_ns", event.time_ns},
            {"kind", visible(event.kind)},
            {"printer", text_or_null(event.printer)},
            {"job", number_or_null(event.job)},
            {"record", number_or_null(event.record)},
            {"message", visible(event.message)}};
}

Json to_json(const daemon::AuditView& entry) {
    return {{"id", entry.id},
            {"time", rfc3339(entry.time_ns)},
            {"time_ns", entry.time_ns},
            {"who", visible(entry.who)},
            {"what", visible(entry.what)},
            {"object", visible(entry.object)},
            {"detail", parsed_object(entry.detail)},
            {"done", entry.done}};
}

Json to_json(const spool::HistoryStretch& stretch) {
    return {{"first", stretch.range.first().value()},
            {"last", stretch.range.last().value()},
            {"count", stretch.range.count().value()},
            {"state", to_string(stretch.state)},
            {"run", static_cast<std::int64_t>(stretch.run)},
            {"not_before", rfc3339(stretch.from_ns)},
            {"not_before_ns", stretch.from_ns},
            {"not_after", rfc3339(stretch.to_ns)},
            {"not_after_ns", stretch.to_ns},
            {"evidence", parsed_object(stretch.evidence)}};
}

Json to_json(const spool::LedgerRow& row) {
    return {{"sequence", row.sequence},
            {"job", number(row.job)},
            {"kind", to_string(row.entry.kind)},
            {"run", static_cast<std::int64_t>(row.entry.run)},
            {"records", range_or_null(row.entry.range)},
            {"evidence", visible(row.entry.evidence)},
            {"time", rfc3339(row.time_ns)},
            {"time_ns", row.time_ns},
            {"previous_hash", row.previous_hash},
            {"hash", row.hash}};
}

Json findings_json(const std::vector<daemon::Finding>& findings) {
    const bool ok = std::none_of(findings.begin(), findings.end(), [](const daemon::Finding& finding) {
        return finding.severity == daemon::Severity::problem;
    });
    return {{"ok", ok}, {"items", items_json(findings)}};
}

std::optional<JobPhase> job_phase(std::string_view name) {
    const auto* const found =
        std::find_if(job_phases.begin(), job_phases.end(), [&](JobPhase phase) { return to_string(phase) == name; });
    return found == job_phases.end() ? std::nullopt : std::optional{*found};
}

std::string job_phase_names() {
    std::string names;
    for (const JobPhase phase : job_phases) {
        names += (names.empty() ? "" : ", ") + std::string{to_string(phase)};
    }
    return names;
}

} // namespace linefeed::api
