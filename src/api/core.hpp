// What the connections of a server share. Everything here is used on the control thread only, but for what says that it
// takes any thread.
#pragma once

#include "api/access.hpp"
#include "api/admission.hpp"
#include "api/connection_limits.hpp"
#include "api/dispatcher.hpp"
#include "api/event_feed.hpp"
#include "api/metrics.hpp"
#include "api/workers.hpp"
#include "base/time.hpp"

#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/io_context.hpp>

#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>

namespace linefeed::api {

class Connection;
class EventStream;

using Socket = boost::asio::generic::stream_protocol::socket;

/// One answered request, for the access log. Texts are as the client has sent them: any bytes.
struct AccessRecord {
    std::string peer;   ///< address, or the user of the Unix socket
    std::string caller; ///< Caller::name; empty = it was refused before that was known
    std::string method;
    std::string target;
    int status = 0;
    std::uint64_t body_bytes = 0; ///< of the answer
    Duration took{};
};

/// What of the configuration can change while connections live.
struct Rules {
    AccessRules access;
    BodyLimits body;
    std::uint32_t max_header = 16U << 10U; ///< bytes
    Duration request_timeout = std::chrono::seconds{30};
};

struct Core {
    boost::asio::io_context& context;
    std::shared_ptr<const Rules> rules; ///< never nullptr
    Workers& workers;                   ///< any thread
    Dispatcher& dispatcher;             ///< any thread
    Metrics& metrics;                   ///< any thread
    EventFeed& feed;
    std::filesystem::path uploads;
    std::function<void(const AccessRecord&)> on_request; ///< may be empty; must not block
    std::size_t open_uploads = 0;
    bool stopping = false;
    std::set<Connection*> connections{};
    std::set<EventStream*> streams{};
};

inline constexpr std::size_t max_uploads = 4; ///< at once; each at most http.max_body
inline constexpr std::size_t max_streams = 64;

} // namespace linefeed::api
