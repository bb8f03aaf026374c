// What the facts of a preflight mean, see preflight.hpp. One function for each check.
#include "daemon/preflight.hpp"

#include "base/assert.hpp"
#include "daemon/line_use.hpp"
#include "feeder/mailing_error.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace linefeed::daemon {

using protocol::MachineState;
using protocol::NozzleState;

namespace {

Finding ok(const char* check, std::string words) {
    return {check, Severity::ok, std::move(words), {}};
}
Finding warning(const char* check, std::string words, std::string advice) {
    return {check, Severity::warning, std::move(words), std::move(advice)};
}
Finding problem(const char* check, std::string words, std::string advice) {
    return {check, Severity::problem, std::move(words), std::move(advice)};
}

Finding reachable(const PreflightFacts& facts) {
    constexpr const char* check = "reachable";
    if (!facts.unreachable.empty()) {
        return problem(check, facts.unreachable,
                       "Look whether the printer is switched on and its cable plugged in, and whether address and port "
                       "(3000 unless changed at the printer) are right.");
    }
    if (facts.broke_off) {
        return problem(check, "the printer closed the connection in the middle",
                       "Look whether another program is connected to it, and whether its interface protocol is JET3.");
    }
    if (!facts.machine && facts.oddities.unsecured) {
        return problem(check, "the printer answers, but without CRC32",
                       "Its firmware knows no =NR: take crc=on out of its address.");
    }
    if (!facts.machine && !facts.oddities.unreadable.empty()) {
        return problem(check, "the printer's answer cannot be read: " + facts.oddities.unreadable,
                       "Its firmware may need another version of linefeed; a noisy serial line needs crc=on.");
    }
    if (!facts.machine && facts.oddities.damaged_bytes > 0) {
        return problem(check, "something answers, but not in the printer's language",
                       "Look whether the address is the printer's, and whether its interface protocol is JET3.");
    }
    if (!facts.machine) {
        return problem(check, "it takes the connection, but does not answer",
                       "The printer may be in standby, or another program may hold its only connection: switch it on, "
                       "and close other programs.");
    }
    return ok(check, "the printer answers");
}

Finding properties_unknown(const protocol::Profile& profile) {
    return problem("profile",
                   to_string(profile) +
                       ", which knows no properties of records; those of the job are mirrored or turned",
                   "Mirror or turn the objects of the printer's job instead, and import the file again without that.");
}

/// Of an automatic profile.
Finding told_profile(const protocol::VersionInfo& version, const PreflightRules& rules) {
    constexpr const char* check = "profile";
    const protocol::Profile& chosen = rules.printer.profile;
    const auto told = protocol::profile_for(version.type, version.firmware);
    const protocol::Profile valid = told ? with_own_properties(*told, chosen.own) : chosen;
    if (!valid.record_properties && rules.records.have_properties) {
        return properties_unknown(valid);
    }
    if (valid.escapes != protocol::EscapeMode::backslash && rules.records.have_escapes &&
        rules.records.have_escapes()) {
        return told ? problem(check,
                              "auto: " + to_string(valid) + ", which knows no escapes; the job was imported for " +
                                  "firmware that does, and ^ and \\ would come out wrong",
                              "Import its file again for this printer.")
                    : problem(check,
                              "auto, but the printer does not say a type and a firmware that are known; the job has "
                              "records with ^ or \\, which come out wrong where the firmware knows no escapes",
                              "Look up the printer's firmware, name its profile in the settings (jet3up, jet3, jet2neo "
                              "or jet2neo-v71), and start again.");
    }
    return told ? ok(check,
                     "auto: " + to_string(valid) + ", since it is a " + version.type + ", firmware " + version.firmware)
                : warning(check, "auto, but the printer does not say a type and a firmware that are known",
                          "Name its profile in the settings: until then records with ^ or \\ are refused.");
}

Finding profile(const protocol::VersionInfo& version, const PreflightRules& rules) {
    constexpr const char* check = "profile";
    if (protocol::is_automatic(rules.printer.profile)) {
        return told_profile(version, rules);
    }
    if (!rules.printer.profile.record_properties && rules.records.have_properties) {
        return properties_unknown(rules.printer.profile);
    }
    const std::string chosen = to_string(rules.printer.profile);
    const auto told = protocol::profile_for(version.type, version.firmware);
    const bool says_neo = version.type.find("2neo") != std::string::npos;
    const bool chosen_neo = chosen.starts_with("jet2neo");
    if (version.type.empty()) {
        return ok(check, chosen + ", as configured; the printer does not say its type");
    }
    if (told && says_neo == chosen_neo &&
        with_own_properties(*told, rules.printer.profile.own).escapes != rules.printer.profile.escapes) {
        return warning(
            check,
            "the printer says that it is a " + version.type + ", firmware " + version.firmware + ": that is " +
                std::string{told->name} + ", and its profile is " + chosen,
            "Set the printer's profile to what it is, or to auto: with a wrong one, ^ and \\ come out wrong.");
    }
    if (says_neo != chosen_neo) {
        return warning(check, "the printer says that it is a " + version.type + ", and its profile is " + chosen,
                       "Set the printer's profile to what it is: with a wrong one, ^ and \\ may come out wrong.");
    }
    return ok(check, chosen + " fits " + version.type);
}

Finding ready(const protocol::MachineStatus& machine, const PreflightRules& rules) {
    constexpr const char* check = "ready";
    const std::string state{to_string(machine.machine)};
    switch (machine.machine) {
    case MachineState::unknown:
        return problem(check, "the printer is in a state that linefeed does not know",
                       "Look at the printer; its firmware may need another version of linefeed.");
    case MachineState::standby:
        return problem(check, "the printer is in standby", "Switch it on.");
    case MachineState::initialising:
        return problem(check, "the printer is " + state, "Wait until it is ready.");
    case MachineState::service:
        return problem(check, "the printer is in its " + state, "Leave the panel.");
    case MachineState::ready:
        return rules.printer.open_nozzle
                   ? ok(check, state + "; the start opens the nozzle, which takes 30 to 60 s")
                   : problem(check, "the nozzle is not open: " + state,
                             "Open the nozzle at the printer, or set open_nozzle for this printer.");
    case MachineState::ready_to_print:
        return ok(check, state);
    case MachineState::printing:
        return rules.may_be_printing ? ok(check, "it is printing; whether that is this job is found out at the start")
                                     : problem(check, "it is printing something that linefeed did not start",
                                               "Stop it at the printer, or at the program that prints.");
    }
    assertion_failed("MachineState", __FILE__, __LINE__);
}

Finding nozzle(const protocol::MachineStatus& machine) {
    constexpr const char* check = "nozzle";
    const std::string words = "the nozzle: " + std::string{to_string(machine.nozzle)};
    switch (machine.nozzle) {
    case NozzleState::open:
    case NozzleState::closed: // `ready` says whether that will do
        return ok(check, words);
    case NozzleState::opens:
    case NozzleState::closes:
    case NozzleState::in_between:
    case NozzleState::invalid:
        return warning(check, words, "Wait until it has come to rest; if it does not, look at the printer.");
    }
    assertion_failed("NozzleState", __FILE__, __LINE__);
}

Finding cover(const protocol::MachineStatus& machine) {
    return machine.cover_open ? problem("cover", "the head cover is open", "Close it.")
                              : ok("cover", "the head cover is closed");
}

Finding errors(const protocol::PrinterError& error, const PreflightRules& rules) {
    constexpr const char* check = "errors";
    if (error.none()) {
        return ok(check, "no error is pending");
    }
    const config::ErrorEntry* const entry = rules.settings.errors.find(error);
    std::string words = "pending: " + describe(error);
    if (entry != nullptr && !entry->meaning.empty()) {
        words += ": " + entry->meaning;
    }
    const std::string advice =
        entry != nullptr && !entry->advice.empty() ? entry->advice : "Look it up in the printer's manual.";
    const config::ErrorPolicy policy = rules.settings.policy(rules.printer, error);
    if (policy == config::ErrorPolicy::acknowledge || feeder::is_mailing_error(error)) {
        return warning(check, words + "; the start acknowledges it", advice);
    }
    if (error.display() == protocol::ErrorDisplay::error || policy == config::ErrorPolicy::stop) {
        return problem(check, words, advice + " Then acknowledge it, at the printer or with linefeed.");
    }
    return warning(check, words, advice);
}

Finding job_file(const std::optional<protocol::JobName>& job, const PreflightRules& rules) {
    constexpr const char* check = "job_file";
    const auto& wanted = rules.printer.job_file;
    if (!job) {
        const std::string words = "the printer does not say which job file is loaded";
        return wanted ? warning(check, words, "Look at its panel whether " + *wanted + " is loaded.")
                      : ok(check, words);
    }
    const std::string loaded = job->path.empty() ? "no job file is loaded" : job->path + " is loaded";
    if (wanted && !same_job_file(job->path, *wanted)) {
        return problem(check, loaded + ", and it has to be " + *wanted, "Load " + *wanted + " at the printer.");
    }
    if (job->path.empty()) {
        return warning(check, loaded, "Load the job whose text object takes mail records (EXTTXT, field 1 or higher).");
    }
    return ok(check, loaded);
}

Finding fifo(const std::optional<protocol::MailStatus>& mail, const PreflightRules& rules) {
    constexpr const char* check = "fifo";
    if (!mail) {
        return problem(check, "the printer does not answer ?SM",
                       "Look whether its firmware has mailing operation, and whether the profile is right.");
    }
    if (mail->depth == 0) {
        return problem(check, "the printer has no mailing FIFO",
                       "Switch \"activate database\" off at the printer, and load a job with a text object EXTTXT.");
    }
    const std::string room = std::to_string(mail->depth) + " records fit";
    if (mail->entries > 0 && !rules.may_be_printing) {
        return warning(check, room + "; " + std::to_string(mail->entries) + " of somebody lie there",
                       "Nothing to do if they are not wanted: the start empties the FIFO.");
    }
    return ok(check, room + "; the start fills it and reads back whether the printer took them");
}

Finding stop_point(const protocol::MailStatus& mail, const PreflightRules& rules) {
    if (!rules.keeps_stop_at.value_or(true)) {
        return warning("stop_point", "by the last probe its firmware does not keep a stop point",
                       "linefeed ends the job with a blank record instead: the product after the last may come out "
                       "blank.");
    }
    const std::string stands =
        mail.stop_at == RecordNumber{} ? "none is set" : "it stands at " + std::to_string(mail.stop_at.value());
    return ok("stop_point", stands + "; the start sets it and reads it back");
}

std::optional<Finding> counter(const std::optional<protocol::Counters>& counters) {
    constexpr const char* check = "counter";
    if (!counters) {
        return std::nullopt;
    }
    if (counters->stop_after.value_or(0) > 0) {
        return warning(check,
                       "the printer stops by itself after " + std::to_string(*counters->stop_after) +
                           " products (now " + std::to_string(counters->product.value_or(0)) + ")",
                       "Set its product counter's stop to 0, unless that is wanted.");
    }
    if (!counters->total) {
        return warning(check, "the printer does not report its total print counter",
                       "Nothing to do; but after a loss of its memory or of the link more records may be in doubt.");
    }
    return ok(check, std::to_string(*counters->total) + " prints in its life");
}

Finding modes(const printer::ConversationOddities& oddities) {
    constexpr const char* check = "modes";
    std::string left_on;
    const auto add = [&left_on](bool on, const char* what) {
        if (on) {
            left_on += (left_on.empty() ? "" : ", ") + std::string{what};
        }
    };
    add(oddities.lengths, "lengths (!LN)");
    add(oddities.echoes, "echo (!EM)");
    add(oddities.filled, "filled blocks (=FL)");
    if (!left_on.empty()) {
        return warning(check, "another program has left on: " + left_on,
                       "linefeed copes with it. It costs time on the line; it ends when the printer is switched off.");
    }
    if (oddities.damaged_bytes > 0) {
        return warning(check, std::to_string(oddities.damaged_bytes) + " bytes were no frames",
                       "Look at the cable, and on a serial line at baud rate and handshake.");
    }
    return ok(check, "nothing unusual is switched on");
}

/// What a serial line carries; absent for any other.
std::optional<Finding> line(const PreflightRules& rules) {
    constexpr const char* check = "line";
    const link::PrinterAddress& printer = rules.printer.address;
    const std::size_t bytes = rules.records.bytes > 0 ? rules.records.bytes : record_bytes({});
    if (rules.printer.expected_rate) {
        if (auto too_little = shortfall(printer, bytes, *rules.printer.expected_rate)) {
            return warning(check, std::move(too_little->words), std::move(too_little->advice));
        }
    }
    const std::string carries = line_words(printer, bytes);
    return carries.empty() ? std::nullopt : std::optional{ok(check, carries)};
}

Finding connections(bool second_is_answered) {
    constexpr const char* check = "connections";
    return second_is_answered
               ? ok(check, "the printer serves two connections at once")
               : warning(check, "the printer does not serve two connections at once",
                         "While it prints its panel cannot be suspended, nor an error be acknowledged, and another "
                         "program that is connected keeps linefeed out.");
}

} // namespace

Finding judge_identity(const protocol::VersionInfo& version, const PreflightRules& rules) {
    constexpr const char* check = "identity";
    const std::string& known = rules.known_serial_number;
    if (!known.empty() && version.serial_number.empty()) {
        return warning(check, "the printer does not say its serial number; it was " + known,
                       "Look whether it is the right machine.");
    }
    const std::string name = (version.type.empty() ? "a printer" : version.type) + ", firmware " +
                             (version.firmware.empty() ? "unknown" : version.firmware) + ", serial number " +
                             (version.serial_number.empty() ? "unknown" : version.serial_number);
    if (!known.empty() && known != version.serial_number) {
        return problem(check, name + "; the serial number here was " + known,
                       "If the printer was exchanged, accept it: linefeed printer " + rules.printer.name + " accept " +
                           version.serial_number + ". Otherwise the address is that of another printer.");
    }
    if (!rules.same_machine.empty()) {
        return warning(
            check, name + "; printer " + rules.same_machine.front() + " is the same machine",
            "Look at the addresses of both: what one of them starts loses what the other has in the printer.");
    }
    return ok(check, name);
}

bool same_job_file(std::string_view reported, std::string_view configured) {
    const auto plain = [](std::string_view path) {
        std::string text;
        for (const char byte : path) {
            const char one = byte == '/' ? '\\' : static_cast<char>(std::toupper(static_cast<unsigned char>(byte)));
            if (one != '\\' || (!text.empty() && text.back() != '\\')) {
                text += one;
            }
        }
        return text;
    };
    const std::string one = plain(reported);
    const std::string other = plain(configured);
    if (other.find('\\') == std::string::npos) {
        return one.substr(one.rfind('\\') + 1) == other;
    }
    return one == other;
}

std::vector<Finding> judge(const PreflightFacts& facts, const PreflightRules& rules) {
    std::vector<Finding> findings{reachable(facts)};
    if (!facts.machine) {
        return findings;
    }
    if (facts.version || !rules.known_serial_number.empty()) {
        findings.push_back(judge_identity(facts.version.value_or(protocol::VersionInfo{}), rules));
    }
    const bool in_standby = facts.machine->machine == MachineState::standby; // where it tells nothing
    if (facts.version || (protocol::is_automatic(rules.printer.profile) && !in_standby)) {
        findings.push_back(profile(facts.version.value_or(protocol::VersionInfo{}), rules));
    }
    findings.push_back(ready(*facts.machine, rules));
    if (in_standby || facts.broke_off) {
        return findings; // nothing else is valid
    }
    findings.push_back(nozzle(*facts.machine));
    findings.push_back(cover(*facts.machine));
    findings.push_back(errors(facts.machine->error, rules));
    findings.push_back(job_file(facts.job, rules));
    findings.push_back(fifo(facts.mail, rules));
    if (facts.mail) {
        findings.push_back(stop_point(*facts.mail, rules));
    }
    if (auto found = counter(facts.counters)) {
        findings.push_back(*std::move(found));
    }
    findings.push_back(modes(facts.oddities));
    if (auto found = line(rules)) {
        findings.push_back(*std::move(found));
    }
    if (facts.second_connection) {
        findings.push_back(connections(*facts.second_connection));
    }
    return findings;
}

bool may_start(const std::vector<Finding>& findings) {
    return std::ranges::none_of(findings, [](const Finding& finding) { return finding.severity == Severity::problem; });
}

} // namespace linefeed::daemon
