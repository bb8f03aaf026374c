#include "api/event_parser.hpp"

#include "api/query.hpp"

#include <algorithm>
#include <limits>

namespace linefeed::api {

std::vector<StreamedEvent> EventParser::take(std::string_view bytes) {
    std::vector<StreamedEvent> events;
    while (!bytes.empty()) {
        const std::size_t end = std::min(bytes.find('\n'), bytes.size());
        if (line_.size() + end <= max_line) {
            line_ += bytes.substr(0, end);
        } else {
            too_long_ = true;
        }
        if (end < bytes.size()) {
            take_line(too_long_ ? std::string_view{"data"} : std::string_view{line_}, events);
            line_.clear();
            too_long_ = false;
        }
        bytes.remove_prefix(std::min(end + 1, bytes.size()));
    }
    return events;
}

void EventParser::take_line(std::string_view line, std::vector<StreamedEvent>& events) {
    constexpr std::string_view id_field = "id: ";
    constexpr std::string_view data_field = "data: ";
    if (line.starts_with(id_field)) {
        id_ = line.substr(id_field.size());
    } else if (line.starts_with(data_field)) {
        data_ = line.substr(data_field.size());
    } else if (line.empty()) {
        const auto id = parse_number(id_, std::numeric_limits<std::uint64_t>::max());
        Json data = parsed_object(data_);
        if (id && data.is_object()) {
            events.push_back({*id, std::move(data)});
        }
        id_.clear();
        data_.clear();
    }
}

} // namespace linefeed::api
