// What is decided when the header of a request is there, before its body is read: where it leads, who asks, whether he
// may, and how much of a body is taken. Knows headers, not sockets.
#pragma once

#include "api/access.hpp"
#include "api/exchange.hpp"
#include "api/route.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace linefeed::api {

/// A request without its body.
struct Header {
    std::string method;
    std::string target;
    bool http_1_0 = false;
    std::vector<std::pair<std::string, std::string>> fields; ///< names in lower case
    std::optional<std::uint64_t> content_length;
    bool chunked = false;

    /// Empty = there is none. The first, if there are several.
    [[nodiscard]] std::string_view field(std::string_view name) const;
    [[nodiscard]] std::size_t count(std::string_view name) const;
};

/// A request that may be carried out, once its body is there.
struct Admitted {
    const Route* route = nullptr;
    Request request;
    std::string key;        ///< Idempotency-Key; empty = none
    std::string media_type; ///< of the body, in lower case, without parameters
    bool upload = false;    ///< the body goes into a file
    std::uint64_t max_body = 0;
    bool wants_continue = false;             ///< waits for status 100 before it sends the body
    std::optional<std::uint64_t> last_event; ///< of a stream; absent = from now on
};

/// One of three: a problem, an answer that needs no handler (OPTIONS), or a request.
struct Admission {
    std::string caller;           ///< Caller::name; empty = it was refused before that was known
    std::string cors_origin;      ///< goes into the answer, whatever it is; empty = none
    bool preflight = false;       ///< the answer is for a browser that asks beforehand
    bool without_body = false;    ///< HEAD
    std::optional<Answer> answer; ///< of OPTIONS
    Checked<Admitted> admitted = Problem{};
};

struct BodyLimits {
    std::uint64_t json = std::uint64_t{64} << 10U; ///< bytes
    std::uint64_t upload = 0;                      ///< bytes
};

[[nodiscard]] Admission admit(const Header& header, const Peer& peer, const AccessRules& rules,
                              const BodyLimits& limits);

} // namespace linefeed::api
