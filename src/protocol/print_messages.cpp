// Words of print parameters and the ends of scripts, see print_messages.hpp.
#include "protocol/print_messages.hpp"

namespace linefeed::protocol {

bool ScriptLine::is_word(std::string_view word) const {
    return text.starts_with(word) &&
           (text.size() == word.size() || std::string_view{" \t[("}.find(text[word.size()]) != std::string_view::npos);
}

std::string_view to_string(PrintParameterType type) {
    switch (type) {
    case PrintParameterType::print_go_delay:
        return "PrintGo delay in µm";
    case PrintParameterType::print_go_distance:
        return "PrintGo distance in µm";
    case PrintParameterType::stroke_distance:
        return "stroke distance in µm";
    case PrintParameterType::printing_height:
        return "printing height";
    case PrintParameterType::encoder_speed:
        return "speed of the internal encoder";
    }
    return "unknown";
}

} // namespace linefeed::protocol
