// What can be seen of a printer: each task asks one or a few inquiries and shows the answers.
#include "printer/exchange.hpp"
#include "printer/message_json.hpp"
#include "printer/tasks.hpp"

#include <array>

namespace linefeed::printer {

using protocol::Group;
using protocol::Parameter;

namespace {

constexpr CommandId asks(std::string_view code) {
    return {Group::inquiry, code};
}
constexpr CommandId answer(std::string_view code) {
    return {Group::parameter, code};
}

/// The answer's fields.
template <typename Answer>
Result<Json> look(PrinterClient& printer) {
    const auto answer = asked<Answer>(printer, Answer::parameter);
    return answer ? json_result(fields_of(*answer)) : answer.error();
}

/// With what the plant's table says.
Json error_json(const protocol::PrinterError& error, const Order& order) {
    Json json = to_json(error);
    if (!json.is_null()) {
        const ErrorWords words = order.meaning(error);
        json["meaning"] = protocol::printable(words.meaning);
        json["advice"] = protocol::printable(words.advice);
    }
    return json;
}

Result<Json> status(PrinterClient& printer, const Order& order) {
    const auto machine = asked<protocol::MachineStatus>(printer, Parameter::RS);
    if (!machine) {
        return machine.error();
    }
    Json json = fields_of(*machine);
    json["error"] = error_json(machine->error, order);
    const bool standby = machine->machine == protocol::MachineState::standby; // then it answers nothing else
    const auto job = standby ? std::nullopt : printer.ask<protocol::JobName>(Parameter::JL);
    json["job"] = job ? Json(protocol::printable(job->path)) : Json{};
    const auto mail = standby ? std::nullopt : printer.ask<protocol::MailStatus>(Parameter::SM);
    json["mailing"] = mail ? fields_of(*mail) : Json{};
    return json_result(std::move(json));
}

Result<Json> info(PrinterClient& printer, const Order& /*order*/) {
    auto json = look<protocol::VersionInfo>(printer);
    if (!json) {
        return json;
    }
    const auto flash = printer.ask<protocol::FreeFlash>(Parameter::DS);
    (*json)["free_flash_kbyte"] = flash ? Json(flash->kbyte) : Json{};
    return json;
}

constexpr std::array status_uses{asks("RS"), answer("RS"), asks("JL"), answer("JL"), asks("SM"), answer("SM")};
constexpr std::array info_uses{asks("VS"), answer("VS"), asks("DS"), answer("DS")};

constexpr std::array list{
    Task{"status", Task::Kind::look, "What the machine does: state, nozzle, error, job, mailing", status_uses, {},
         status},
    Task{"info", Task::Kind::look, "Versions, serial number and free memory", info_uses, {}, info},
};

} // namespace

std::span<const Task> look_tasks() {
    return list;
}

} // namespace linefeed::printer
