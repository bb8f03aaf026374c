#include "printer/print_parameters.hpp"

#include "printer/exchange.hpp"
#include "printer/message_json.hpp"

#include <algorithm>

namespace linefeed::printer {

using protocol::Parameter;
using protocol::PrintParameter;
using protocol::PrintParameterType;

namespace {

struct Named {
    PrintParameterType type;
    std::string_view name;
};
constexpr std::array names{
    Named{PrintParameterType::print_go_delay, "delay"}, Named{PrintParameterType::print_go_distance, "distance"},
    Named{PrintParameterType::stroke_distance, "stroke-distance"}, Named{PrintParameterType::printing_height, "height"},
    Named{PrintParameterType::encoder_speed, "encoder-speed"}};

std::string number_of(PrintParameterType type) {
    return std::to_string(static_cast<std::uint32_t>(type));
}

Result<PrintParameterType> type_of(std::string_view word) {
    const auto found = std::ranges::find_if(
        names, [word](const Named& named) { return named.name == word || number_of(named.type) == word; });
    return found == names.end()
               ? Result<PrintParameterType>{Failure{FailureKind::usage,
                                                    "there is no print parameter \"" + std::string{word} + "\": say " +
                                                        std::string{parameter_set_arguments[0].help}}}
               : found->type;
}

Result<PrintParameter> ask_for(PrinterClient& printer, PrintParameterType type) {
    return asked<PrintParameter>(printer, Parameter::PR, number_of(type));
}

Json parameter_json(const PrintParameter& parameter) {
    const auto named = std::ranges::find(names, parameter.type, &Named::type);
    return {{"type", named == names.end() ? number_of(parameter.type) : std::string{named->name}},
            {"type_code", static_cast<std::uint32_t>(parameter.type)},
            {"value", parameter.value},
            {"what", to_string(parameter.type)}};
}

} // namespace

Result<Json> look_at_parameters(PrinterClient& printer, const Order& order) {
    std::vector<PrintParameterType> wanted;
    if (order.arguments.has("type")) {
        const auto type = type_of(order.arguments.text("type"));
        if (!type) {
            return type.error();
        }
        wanted.push_back(*type);
    } else {
        for (const Named& named : names) {
            wanted.push_back(named.type);
        }
    }
    Json parameters = Json::array();
    for (const PrintParameterType type : wanted) {
        const auto parameter = ask_for(printer, type);
        if (!parameter) {
            return parameter.error();
        }
        parameters.push_back(parameter_json(*parameter));
    }
    return json_result({{"parameters", std::move(parameters)}});
}

Result<Json> set_parameter(PrinterClient& printer, const Order& order) {
    const auto type = type_of(order.arguments.text("type"));
    if (!type) {
        return type.error();
    }
    const auto value = static_cast<std::uint32_t>(*order.arguments.number("value"));
    const protocol::Limits limits = limits_of(*type);
    if (value < limits.smallest || value > limits.largest) {
        return Failure{FailureKind::usage, "the " + std::string{to_string(*type)} + " must be from " +
                                               std::to_string(limits.smallest) + " to " +
                                               std::to_string(limits.largest)};
    }
    if (!printer.send(PrintParameter{*type, value})) {
        return not_confirmed(printer);
    }
    const auto now = ask_for(printer, *type);
    if (!now) {
        return now.error();
    }
    Json json{{"parameters", Json::array({parameter_json(*now)})}};
    if (now->value != value) {
        json["note"] = "the printer still shows another value: it takes the new one at one of the next PrintGos";
    }
    return json_result(std::move(json));
}

} // namespace linefeed::printer
