// Server-sent events, there and back, however the bytes are split.
#include "api/event_feed.hpp"
#include "api/event_parser.hpp"

#include <gtest/gtest.h>

namespace linefeed::api {
namespace {

std::string story() {
    std::string text = "retry: 2000\n\n: still here\n\n";
    for (std::uint64_t id = 1; id <= 3; ++id) {
        daemon::EventView event;
        event.id = id;
        event.kind = "job.\nstarted";
        event.message = "line\nbreak \xFF\r\n\ndata: {}";
        text += to_server_sent(event);
    }
    return text;
}

TEST(EventParser, GivesTheSameEventsForEverySplit) {
    const std::string text = story();
    for (std::size_t first = 0; first <= text.size(); ++first) {
        EventParser parser;
        auto events = parser.take(std::string_view{text}.substr(0, first));
        for (StreamedEvent& event : parser.take(std::string_view{text}.substr(first))) {
            events.push_back(std::move(event));
        }
        ASSERT_EQ(events.size(), 3U) << first;
        EXPECT_EQ(events[2].id, 3U);
        EXPECT_EQ(events[2].data["message"], "line\nbreak \\xFF\r\n\ndata: {}");
    }
}

TEST(EventParser, PassesOverWhatIsNoEvent) {
    EventParser parser;
    EXPECT_TRUE(parser.take("id: x\ndata: {}\n\nid: 1\n\ndata: {}\n\nid: 2\ndata: nonsense\n\n").empty());
    EXPECT_TRUE(parser.take("id: 5\ndata: {\"x\":\"" + std::string(EventParser::max_line, 'x')).empty());
    EXPECT_TRUE(parser.take("\"}\n\n").empty());
    EXPECT_EQ(parser.take("id: 6\ndata: {}\n\n").size(), 1U);
}

} // namespace
} // namespace linefeed::api
