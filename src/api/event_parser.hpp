// Server-sent events, as a client reads them: any split of the bytes gives the same events.
#pragma once

#include "api/json_text.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::api {

struct StreamedEvent {
    std::uint64_t id = 0;
    Json data; ///< an Event of openapi.yaml
};

/// Takes what the service sends (to_server_sent() in event_feed.hpp): one `id` and one line of `data` for each event;
/// comments and other fields are passed over, and events without both, too.
class EventParser {
public:
    /// An event that is longer than this is passed over.
    static constexpr std::size_t max_line = std::size_t{1} << 20U;

    [[nodiscard]] std::vector<StreamedEvent> take(std::string_view bytes);

private:
    void take_line(std::string_view line, std::vector<StreamedEvent>& events);

    std::string line_; ///< that has not ended yet
    bool too_long_ = false;
    std::string id_;
    std::string data_;
};

} // namespace linefeed::api
