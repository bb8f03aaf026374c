// The service's HTTP interface from the other side: what the command line is built on. Blocking; over the Unix socket
// of the service, or over TCP with a token.
#pragma once

#include "base/failure.hpp"
#include "base/time.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace linefeed::api {

using Json = nlohmann::ordered_json;

/// Where the service is: a socket file, or host and port.
struct ServiceAddress {
    std::filesystem::path socket; ///< empty = over TCP
    std::string host;             ///< name or numeric address; IPv6 without brackets
    std::uint16_t port = 0;

    friend bool operator==(const ServiceAddress&, const ServiceAddress&) = default;
};

/// Reads `/PATH`, `unix:PATH`, `tcp://HOST:PORT`, `tcp://[IPV6]:PORT`. FailureKind::usage otherwise, saying what is
/// expected.
[[nodiscard]] Result<ServiceAddress> parse_service_address(std::string_view text);
[[nodiscard]] std::string to_string(const ServiceAddress& address);

struct ClientSettings {
    ServiceAddress address;
    std::string token;                                     ///< sent over TCP only; empty = none
    Duration connect_timeout = std::chrono::seconds{5};    ///< for each of the host's addresses
    Duration answer_timeout = std::chrono::minutes{10};    ///< between two pieces of an answer
    Duration heartbeat_timeout = std::chrono::seconds{45}; ///< of the event stream: the service shows life every 15 s
};

/// An answer with status 200…299.
struct Reply {
    int status = 0;
    Json body;             ///< null if the answer is not JSON
    std::string text;      ///< as it came, e.g. of /metrics
    bool replayed = false; ///< of a POST: its key was known, and nothing was done again
};

/// `text` for a path or a query: everything but letters, digits and `-._~` as %NN.
[[nodiscard]] std::string url_encoded(std::string_view text);
/// 128 random bits in hex, for `Idempotency-Key`.
[[nodiscard]] std::string new_key();

/// One connection, opened when it is needed and again when it is lost. A failure that the service has answered has the
/// kind of its problem (`kind`), and its detail and advice as message; FailureKind::unreachable if there was no answer.
class Client {
public:
    explicit Client(ClientSettings settings);
    ~Client();
    Client(Client&&) noexcept;
    Client& operator=(Client&&) noexcept;

    /// `target` is path and query, encoded, e.g. "/api/v1/jobs?limit=20".
    [[nodiscard]] Result<Reply> get(std::string_view target);
    /// Every element of `items`, page after page, until `on_item` returns false.
    [[nodiscard]] Result<void> each(std::string_view target, const std::function<bool(const Json&)>& on_item);
    /// `body` null = none. `key` empty = no Idempotency-Key. With a key, a connection that is lost before the answer is
    /// opened once more and the request repeated.
    [[nodiscard]] Result<Reply> post(std::string_view target, const Json& body, std::string_view key);
    /// The file as body, never whole in memory.
    [[nodiscard]] Result<Reply> upload(std::string_view target, const std::filesystem::path& file,
                                       std::string_view content_type, std::string_view key);
    /// Events behind `after` (absent = from now on) as they come, until `on_event` returns false. Goes on by itself
    /// after a lost connection, with what was missed; `on_lost` (may be empty) is told why, and returns false to give
    /// up, which fails with that reason. Fails at once if the service refuses.
    [[nodiscard]] Result<void> follow(std::optional<std::uint64_t> after,
                                      const std::function<bool(const Json&)>& on_event,
                                      const std::function<bool(const Failure&)>& on_lost);

private:
    class Connection;
    std::unique_ptr<Connection> connection_;
};

} // namespace linefeed::api
