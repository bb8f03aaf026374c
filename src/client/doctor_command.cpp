#include "client/doctor_command.hpp"

#include "client/doctor_checks.hpp"
#include "client/printer_text.hpp"

#include <algorithm>

namespace linefeed::client {

namespace {

constexpr const char* package_config = "/etc/linefeed/linefeed.yaml";

/// What the service says; nothing but the failure if it is not there.
struct ServiceWords {
    Json findings = Json::array();
    std::string real_time;
    bool reached = false;
};

ServiceWords ask_service(const ServicePlace& place, const std::string& version) {
    Service service{place};
    ServiceWords words;
    const auto there = service.get("/version");
    if (!there) {
        words.findings.push_back(problem("service", there.error().message, ""));
        return words;
    }
    words.reached = true;
    words.findings.push_back(check_version(version, text(*there, "version")));
    if (const auto status = service.get("/api/v1/status")) {
        words.real_time = text(*status, "real_time");
    } else {
        words.findings.push_back(problem("service", status.error().message, ""));
    }
    const auto doctor = service.get("/api/v1/doctor");
    if (!doctor) {
        words.findings.push_back(problem("service", doctor.error().message, ""));
        return words;
    }
    for (const Json& finding : items(*doctor)) {
        words.findings.push_back(finding);
    }
    return words;
}

Json all_findings(const ServicePlace& place, const DoctorOptions& options, bool& reached) {
    Json findings = Json::array();
    bool reachable = true;
    if (!place.address.socket.empty()) {
        findings.push_back(check_socket(place.address.socket));
        reachable = text(findings.front(), "severity") == "ok";
    }
    const ServiceWords service = reachable ? ask_service(place, options.version) : ServiceWords{};
    reached = service.reached;
    const bool named = !options.config.empty();
    // A service on another machine has its surroundings there.
    if (!place.address.socket.empty() || named) {
        const ConfigurationCheck configuration = check_configuration(
            named ? options.config : std::filesystem::path{package_config}, named, place.address.socket);
        findings.push_back(configuration.finding);
        const auto spool = configuration.settings.value_or(config::Settings{}).spool;
        findings.push_back(check_disk(spool, disk_facts(spool.parent_path())));
        findings.push_back(check_clock(clock_facts()));
        if (service.reached) {
            findings.push_back(check_real_time(service.real_time, real_time_runtime_us()));
        }
    }
    for (const Json& finding : service.findings) {
        findings.push_back(finding);
    }
    return findings;
}

Result<ExitCode> doctor(const DoctorOptions& options) {
    const auto place = find_service(options.common.service);
    if (!place) {
        return place.error();
    }
    bool reached = false;
    const Json findings = all_findings(*place, options, reached);
    const bool well = std::none_of(findings.begin(), findings.end(), [](const Json& finding) {
        return text(finding, "severity") != "ok" && text(finding, "severity") != "warning";
    });
    if (options.common.json) {
        show_json({{"ok", well}, {"items", findings}});
    } else {
        show(findings_text(findings, stdout_screen()));
    }
    return !reached ? ExitCode::unreachable : well ? ExitCode::done : ExitCode::other;
}

} // namespace

ExitCode run_doctor(const DoctorOptions& options) {
    return run_command(options.common.json, [&] { return doctor(options); });
}

} // namespace linefeed::client
