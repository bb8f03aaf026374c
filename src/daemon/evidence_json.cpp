#include "daemon/evidence_json.hpp"

#include <nlohmann/json.hpp>

namespace linefeed::daemon {

namespace {

using Json = nlohmann::ordered_json;

Json mail_array(const protocol::MailStatus& mail) {
    return Json::array(
        {mail.depth, mail.entries, mail.last_printed.value(), mail.stop_at.value(), mail.last_print_finished ? 1 : 0});
}

/// The printer's strings may hold any bytes.
std::string dump(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

} // namespace

std::string run_start_json(const std::string& printer, const feeder::BeginRun& begin) {
    Json json{{"printer", printer}};
    if (begin.printer.version) {
        json["serial_number"] = begin.printer.version->serial_number;
        json["type"] = begin.printer.version->type;
        json["firmware"] = begin.printer.version->firmware;
    }
    if (begin.printer.total_prints) {
        json["total_before"] = *begin.printer.total_prints;
    }
    if (begin.printer.job_name) {
        json["job"] = *begin.printer.job_name;
    }
    json["last_printed_before"] = begin.last_printed_before.value();
    return dump(json);
}

std::optional<RunStart> parse_run_start(const std::string& text) {
    const Json json = Json::parse(text, nullptr, false);
    if (!json.is_object() || !json.contains("printer") || !json["printer"].is_string()) {
        return std::nullopt;
    }
    RunStart start;
    start.printer = json["printer"].get<std::string>();
    if (json.contains("serial_number") && json["serial_number"].is_string()) {
        start.serial_number = json["serial_number"].get<std::string>();
    }
    if (json.contains("total_before") && json["total_before"].is_number_unsigned()) {
        start.total_before = json["total_before"].get<std::uint32_t>();
    }
    if (json.contains("last_printed_before") && json["last_printed_before"].is_number_unsigned()) {
        start.last_printed_before = RecordNumber{json["last_printed_before"].get<std::uint32_t>()};
    }
    return start;
}

std::string mail_json(const protocol::MailStatus& mail) {
    return dump(Json{{"sm", mail_array(mail)}});
}

std::string settle_json(const feeder::Settle& settle) {
    Json json{{"basis", to_string(settle.verdict.basis)}, {"sm", mail_array(settle.evidence.mail)}};
    if (settle.evidence.printer.total_prints) {
        json["total"] = *settle.evidence.printer.total_prints;
    }
    if (settle.evidence.printer.version) {
        json["serial_number"] = settle.evidence.printer.version->serial_number;
    }
    return dump(json);
}

std::string outcome_json(const feeder::Outcome& outcome) {
    Json json{{"outcome", to_string(outcome.code)}, {"machine", to_string(outcome.machine)}};
    if (!outcome.error.none()) {
        json["error"] = outcome.error.raw;
    }
    return dump(json);
}

} // namespace linefeed::daemon
