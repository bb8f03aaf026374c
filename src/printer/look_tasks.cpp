// What can be seen of a printer: each task asks one or a few inquiries and shows the answers.
#include "printer/exchange.hpp"
#include "printer/host_time.hpp"
#include "printer/message_json.hpp"
#include "printer/print_parameters.hpp"
#include "printer/tasks.hpp"

#include <array>

namespace linefeed::printer {

using protocol::Group;
using protocol::Parameter;
using protocol::printable;

namespace {

constexpr CommandId asks(std::string_view code) {
    return {Group::inquiry, code};
}
constexpr CommandId answer(std::string_view code) {
    return {Group::parameter, code};
}

/// The answer's fields.
template <typename Answer>
Result<Json> look(PrinterClient& printer, const Order& /*order*/) {
    const auto answer = asked<Answer>(printer, Answer::parameter);
    return answer ? json_result(fields_of(*answer)) : answer.error();
}

/// What the plant's table says.
void add_meaning(Json& json, const protocol::PrinterError& error, const Order& order) {
    const ErrorWords words = order.meaning(error);
    json["meaning"] = printable(words.meaning);
    json["advice"] = printable(words.advice);
}

Json error_json(const protocol::PrinterError& error, const Order& order) {
    Json json = to_json(error);
    if (!json.is_null()) {
        add_meaning(json, error, order);
    }
    return json;
}

/// With the unit of its speeds, which depends on the firmware.
Json with_speed_unit(Json json, const PrinterClient& printer) {
    json["speed_unit"] = printer.settings().profile.speed_in_metres ? "m/min" : "dm/min";
    return json;
}

Result<Json> status(PrinterClient& printer, const Order& order) {
    const auto machine = asked<protocol::MachineStatus>(printer, Parameter::RS);
    if (!machine) {
        return machine.error();
    }
    Json json = with_speed_unit(fields_of(*machine), printer);
    json["error"] = error_json(machine->error, order);
    const bool standby = machine->machine == protocol::MachineState::standby; // then it answers nothing else
    const auto job = standby ? std::nullopt : printer.ask<protocol::JobName>(Parameter::JL);
    json["job"] = job ? Json(printable(job->path)) : Json{};
    const auto mail = standby ? std::nullopt : printer.ask<protocol::MailStatus>(Parameter::SM);
    json["mailing"] = mail ? fields_of(*mail) : Json{};
    return json_result(std::move(json));
}

Result<Json> info(PrinterClient& printer, const Order& order) {
    auto json = look<protocol::VersionInfo>(printer, order);
    if (!json) {
        return json;
    }
    const auto flash = printer.ask<protocol::FreeFlash>(Parameter::DS);
    (*json)["free_flash_kbyte"] = flash ? Json(flash->kbyte) : Json{};
    return json;
}

Result<Json> counters(PrinterClient& printer, const Order& order) {
    auto json = look<protocol::Counters>(printer, order);
    if (!json) {
        return json;
    }
    const auto job = printer.ask<protocol::JobCounters>(Parameter::AC);
    (*json)["counters"] = job ? fields_of(*job)["counters"] : Json{};
    return json;
}

Result<Json> errors(PrinterClient& printer, const Order& order) {
    const auto list = ask_error_list(printer);
    if (!list) {
        return list.error();
    }
    Json entries = Json::array();
    for (const protocol::ErrorEntry& entry : *list) {
        Json json = listed_error_json(entry);
        add_meaning(json, entry.error, order);
        entries.push_back(std::move(json));
    }
    return json_result({{"total", list->size()}, {"errors", std::move(entries)}});
}

Result<Json> events(PrinterClient& printer, const Order& /*order*/) {
    const auto list = ask_event_list(printer);
    if (!list) {
        return list.error();
    }
    Json entries = Json::array();
    for (const protocol::EventEntry& entry : *list) {
        entries.push_back(event_json(entry));
    }
    return json_result({{"total", list->size()}, {"events", std::move(entries)}});
}

/// Each input with its bit of `=EX` and its function of `=IC`, which not every printer tells.
Result<Json> inputs(PrinterClient& printer, const Order& /*order*/) {
    const auto states = asked<protocol::ExternalStates>(printer, Parameter::EX);
    if (!states) {
        return states.error();
    }
    const auto functions = printer.ask<protocol::InputConfiguration>(Parameter::IC);
    Json json = fields_of(*states);
    json["inputs_code"] = json["inputs"];
    Json inputs = Json::array();
    for (std::size_t i = 0; i < protocol::input_count && states->inputs; ++i) {
        const auto input = static_cast<protocol::Input>(i);
        Json entry{{"contact", contact(input)}, {"on", is_on(*states->inputs, input)}, {"function", purpose(input)}};
        if (functions && i < functions->functions.size() && functions->functions[i]) {
            entry["function"] = to_string(*functions->functions[i]);
            entry["function_code"] = static_cast<std::uint32_t>(*functions->functions[i]);
        }
        inputs.push_back(std::move(entry));
    }
    json["inputs"] = std::move(inputs);
    return json_result(std::move(json));
}

Result<Json> outputs(PrinterClient& printer, const Order& /*order*/) {
    constexpr std::array<std::string_view, protocol::OutputConfiguration::max_outputs> contacts{
        "X3.1", "X3.2", "X3.3", "X3.4", "X3.9", "X3.10", "X3.11", "X3.12"};
    const auto configuration = asked<protocol::OutputConfiguration>(printer, Parameter::OC);
    if (!configuration) {
        return configuration.error();
    }
    Json outputs = Json::array();
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        if (const auto& signal = configuration->signals[i]) {
            outputs.push_back({{"output", i + 1},
                               {"contact", contacts[i]},
                               {"signal", to_string(*signal)},
                               {"signal_code", static_cast<std::uint32_t>(*signal)}});
        }
    }
    return json_result({{"outputs", std::move(outputs)}});
}

Result<Json> clock_look(PrinterClient& printer, const Order& /*order*/) {
    const auto clock = asked<protocol::ClockTime>(printer, Parameter::DL);
    return clock ? json_result(clock_json(*clock)) : clock.error();
}

/// "06:30" of hour × 100 + minute.
Json time_of_day(const protocol::MaybeNumber& number) {
    if (!number) {
        return nullptr;
    }
    const std::string digits = std::to_string(10'000 + *number);
    return digits.substr(1, 2) + ':' + digits.substr(3);
}

Result<Json> config(PrinterClient& printer, const Order& /*order*/) {
    const auto settings = asked<protocol::MainConfiguration>(printer, Parameter::MC);
    if (!settings) {
        return settings.error();
    }
    Json json = fields_of(*settings);
    json["interval_on"] = time_of_day(settings->interval_on);
    json["interval_off"] = time_of_day(settings->interval_off);
    return json_result(std::move(json));
}

Result<Json> service(PrinterClient& printer, const Order& /*order*/) {
    const auto history = asked<protocol::ServiceHistory>(printer, Parameter::SH);
    if (!history) {
        return history.error();
    }
    Json json = fields_of(*history);
    if (history->last_service_date) {
        json["last_service_date_code"] = *history->last_service_date;
        json["last_service_date"] =
            to_json(protocol::unpack_date(static_cast<std::uint32_t>(*history->last_service_date)));
    }
    const auto intervals = printer.ask<protocol::ServiceIntervals>(Parameter::SC);
    json["interval_hours"] = intervals && intervals->hours ? Json(*intervals->hours) : Json{};
    json["interval_days"] = intervals && intervals->days ? Json(*intervals->days) : Json{};
    return json_result(std::move(json));
}

/// The second of two answers is surely current (protocol, section 5).
Result<Json> mailing(PrinterClient& printer, const Order& order) {
    static_cast<void>(printer.ask<protocol::MailStatus>(Parameter::SM));
    return look<protocol::MailStatus>(printer, order);
}

Result<Json> text(PrinterClient& printer, const Order& /*order*/) {
    const auto text = asked<protocol::ExternText>(printer, Parameter::ET);
    return text ? json_result(fields_of(protocol::Message{*text})) : text.error();
}

constexpr std::array status_uses{asks("RS"), answer("RS"), asks("JL"), answer("JL"), asks("SM"), answer("SM")};
constexpr std::array info_uses{asks("VS"), answer("VS"), asks("DS"), answer("DS")};
constexpr std::array counters_uses{asks("CC"), answer("CC"), asks("AC"), answer("AC")};
constexpr std::array errors_uses{asks("EL"), answer("EL")};
constexpr std::array events_uses{asks("EV"), answer("EV")};
constexpr std::array inputs_uses{asks("EX"), answer("EX"), asks("IC"), answer("IC")};
constexpr std::array outputs_uses{asks("OC"), answer("OC")};
constexpr std::array clock_uses{asks("DL"), answer("DL")};
constexpr std::array config_uses{asks("MC"), answer("MC")};
constexpr std::array service_uses{asks("SC"), answer("SC"), asks("SH"), answer("SH")};
constexpr std::array hydraulics_uses{asks("HS"), answer("HS")};
constexpr std::array actors_uses{asks("MS"), answer("MS")};
constexpr std::array mailing_uses{asks("SM"), answer("SM")};
constexpr std::array parameter_uses{asks("PR"), answer("PR")};
constexpr std::array text_uses{asks("ET"), answer("ET")};

constexpr auto look_kind = Task::Kind::look;

constexpr std::array list{
    Task{"status", look_kind, "What the machine does: state, nozzle, error, job, mailing", status_uses, {}, status},
    Task{"info", look_kind, "Versions, serial number and free memory", info_uses, {}, info},
    Task{"counters", look_kind, "Products, prints, and the counters of the job", counters_uses, {}, counters},
    Task{"errors", look_kind, "The printer's list of errors, in words", errors_uses, {}, errors},
    Task{"events", look_kind, "The printer's list of hydraulic events", events_uses, {}, events},
    Task{"inputs",
         look_kind,
         "Speed, and what comes in from outside, with the function of each input",
         inputs_uses,
         {},
         inputs},
    Task{"outputs", look_kind, "What each output signals", outputs_uses, {}, outputs},
    Task{"clock", look_kind, "Date and time of the printer", clock_uses, {}, clock_look},
    Task{"config", look_kind, "Main configuration", config_uses, {}, config},
    Task{"service", look_kind, "Hours of operation, last service and service intervals", service_uses, {}, service},
    Task{"hydraulics", look_kind, "State of the hydraulics", hydraulics_uses, {}, look<protocol::HydraulicState>},
    Task{"actors", look_kind, "Pumps, valves and motor", actors_uses, {}, look<protocol::ActorStates>},
    Task{"mailing", look_kind, "The mailing FIFO: entries, last printed record, stop-at", mailing_uses, {}, mailing},
    Task{"parameter", look_kind, "Print parameters", parameter_uses, parameter_look_arguments, look_at_parameters},
    Task{"text", look_kind, "The extern text", text_uses, {}, text},
};

} // namespace

std::span<const Task> look_tasks() {
    return list;
}

} // namespace linefeed::printer
