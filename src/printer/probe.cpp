// `printer P probe`: what this printer's firmware is and does, found out by asking. Nothing of it can print, stop,
// flush or change a running line: it is refused unless the machine stands still and its FIFO is empty, and the one
// thing that is set (`=CM`) is put back.
#include "printer/exchange.hpp"
#include "printer/json.hpp"
#include "printer/look.hpp"
#include "printer/tasks.hpp"
#include "protocol/printable.hpp"
#include "protocol/profile.hpp"

#include <array>

namespace linefeed::printer {

using protocol::Group;
using protocol::MachineState;
using protocol::Parameter;

namespace {

Failure not_now(const PrinterClient& printer, const std::string& why) {
    return {FailureKind::stopped, printer.settings().address + ": " + why};
}

/// The machine stands still, awake.
Result<protocol::MachineStatus> ask_still(PrinterClient& printer) {
    auto machine = asked<protocol::MachineStatus>(printer, Parameter::RS);
    if (!machine) {
        return machine;
    }
    switch (machine->machine) {
    case MachineState::unknown:
    case MachineState::standby:
    case MachineState::initialising:
        return not_now(printer, "it is in " + std::string{to_string(machine->machine)} +
                                    " and answers little: switch it on, then probe it");
    case MachineState::printing:
        return not_now(printer, "it is ready to print or prints: stop it first, then probe it");
    case MachineState::service:
    case MachineState::ready:
    case MachineState::ready_to_print:
        break;
    }
    return machine;
}

/// The second of two answers is surely current (protocol, section 5).
Result<protocol::MailStatus> ask_mailing(PrinterClient& printer) {
    static_cast<void>(printer.ask<protocol::MailStatus>(Parameter::SM));
    return asked<protocol::MailStatus>(printer, Parameter::SM);
}

/// Whether `=CM` stays. The printer is told what stood there before, unless what stands there now is somebody else's:
/// a line that was started meanwhile must not be given another end.
Result<bool> keeps_stop_at(PrinterClient& printer, RecordNumber before) {
    const RecordNumber other{before == RecordNumber{1} ? 2U : 1U};
    if (auto still = ask_still(printer); !still) { // directly before: somebody may have started it meanwhile
        return still.error();
    }
    const auto left_behind = [&](const std::string& why) {
        return Failure{FailureKind::unreachable, why + "; its stop-at was " + std::to_string(before.value()) +
                                                     " before, and may be " + std::to_string(other.value()) +
                                                     " now: look with mailing, and set it with mailing stop-at"};
    };
    static_cast<void>(printer.send(protocol::StopAt{other}));
    const auto during = ask_mailing(printer);
    const auto is_ours = [&](const protocol::MailStatus& mailing) {
        return mailing.stop_at == other || mailing.stop_at == before;
    };
    if (during && !is_ours(*during)) {
        return not_now(printer, "somebody has set its stop-at meanwhile: probe it when nobody else uses it");
    }
    Result<protocol::MailStatus> after = no_answer(printer, Parameter::SM);
    for (int attempt = 0; attempt < 2 && (!after || after->stop_at == other); ++attempt) {
        const auto machine = ask_status(printer);
        if (!machine || machine->machine == MachineState::printing) {
            return left_behind(machine ? printer.settings().address + ": somebody has started it meanwhile"
                                       : no_answer(printer, Parameter::RS).message);
        }
        static_cast<void>(printer.send(protocol::StopAt{before}));
        after = ask_mailing(printer);
    }
    if (!during || !after) {
        return left_behind(no_answer(printer, Parameter::SM).message);
    }
    if (after->stop_at == other) {
        return left_behind(printer.settings().address + ": the printer does not take its stop-at back");
    }
    return during->stop_at == other;
}

/// `?JL` as it comes: whether backslashes of paths are doubled. Absent: there is none in it.
std::optional<bool> doubles_backslashes(PrinterClient& printer) {
    std::optional<bool> doubled;
    static_cast<void>(printer.converse(printer.frame_of(protocol::InquiryMessage{Parameter::JL, {}}),
                                       [&doubled](const protocol::Message& message, std::string_view raw) {
                                           if (!std::holds_alternative<protocol::JobName>(message)) {
                                               return PrinterClient::Heard::ignored;
                                           }
                                           if (raw.find('\\') != std::string_view::npos) {
                                               doubled = raw.find("\\\\") != std::string_view::npos;
                                           }
                                           return PrinterClient::Heard::done;
                                       }));
    return doubled;
}

Json yes_or_no(const std::optional<bool>& value) {
    return value ? Json(*value) : Json{};
}

/// With what the printer's owner has said.
Json firmware_json(const std::optional<protocol::VersionInfo>& version, const protocol::OwnProperties& own) {
    if (!version) {
        return {{"profile", nullptr},
                {"note", "the printer does not answer ?VS: name its profile in the settings, or with --profile"}};
    }
    Json json{{"type", protocol::printable(version->type)},
              {"firmware", protocol::printable(version->firmware)},
              {"serial_number", protocol::printable(version->serial_number)}};
    const auto told = protocol::profile_for(version->type, version->firmware);
    if (!told) {
        json["profile"] = nullptr;
        json["note"] = "no profile is known for this type and firmware: name one in the settings, or with --profile";
        return json;
    }
    const protocol::Profile profile = protocol::with_own_properties(*told, own);
    json["profile"] = to_string(profile);
    json["escapes"] = profile.escapes == protocol::EscapeMode::backslash;
    json["speed_unit"] = profile.speed_in_metres ? "m/min" : "dm/min";
    json["record_properties"] = profile.record_properties;
    json["output_control"] = profile.output_control;
    json["counter_limits"] = profile.counter_parameters;
    json["graphic_height"] = profile.graphic_height;
    json["inputs"] = profile.configured_inputs();
    json["outputs"] = profile.outputs();
    return json;
}

Result<Json> probe(PrinterClient& printer, const Order& /*order*/) {
    const auto machine = ask_still(printer);
    if (!machine) {
        return machine.error();
    }
    const auto mailing = ask_mailing(printer);
    if (!mailing) {
        return mailing.error();
    }
    if (mailing->entries > 0) {
        return not_now(printer, "records lie in its FIFO: print or flush them first, then probe it");
    }
    Json json = firmware_json(printer.ask<protocol::VersionInfo>(Parameter::VS), printer.settings().profile.own);
    const auto keeps = keeps_stop_at(printer, mailing->stop_at);
    if (!keeps) {
        return keeps.error();
    }
    json["keeps_stop_at"] = *keeps;
    json["mailing_counts_print_gos"] = mailing->print_go_count.has_value();
    json["status_tells_job_changes"] = machine->job_changed.has_value();
    const auto counters = printer.ask<protocol::Counters>(Parameter::CC);
    json["total_counter"] = yes_or_no(counters ? std::optional{counters->total.has_value()} : std::nullopt);
    json["tank_levels"] = printer.ask<protocol::TankLevels>(Parameter::SL).has_value();
    json["doubled_backslashes"] = yes_or_no(doubles_backslashes(printer));
    const ConversationOddities& oddities = printer.oddities();
    json["lengths_on"] = oddities.lengths;
    json["echo_on"] = oddities.echoes;
    json["filled_blocks_on"] = oddities.filled;
    return json_result(std::move(json));
}

constexpr std::array uses{CommandId{Group::inquiry, "RS"}, CommandId{Group::inquiry, "SM"},
                          CommandId{Group::inquiry, "VS"}, CommandId{Group::inquiry, "CC"},
                          CommandId{Group::inquiry, "SL"}, CommandId{Group::parameter, "SL"},
                          CommandId{Group::inquiry, "JL"}, CommandId{Group::parameter, "CM"}};

constexpr std::array list{
    Task{"probe",
         Task::Kind::change,
         "What its firmware is and does; only while it stands still with an empty FIFO",
         uses,
         {},
         probe,
         nullptr,
         false,
         true},
};

} // namespace

std::span<const Task> probe_tasks() {
    return list;
}

} // namespace linefeed::printer
