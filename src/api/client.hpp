// The service's HTTP interface from the other side: what the command line is built on. Blocking; over the Unix socket
// of the service, or over TCP with a token.
#pragma once

#include "api/json_text.hpp"
#include "api/random.hpp"
#include "api/service_address.hpp"
#include "api/url.hpp"
#include "base/failure.hpp"
#include "base/time.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace linefeed::api {

class ClientConnection;
struct WireRequest;

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

/// Random, for `Idempotency-Key`.
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
    /// What the service has answered instead of what was asked, a Problem of openapi.yaml; null if the last request did
    /// not fail, or was not answered.
    [[nodiscard]] const Json& problem() const { return problem_; }

private:
    [[nodiscard]] Result<Reply> exchange(const WireRequest& request, bool repeatable);
    [[nodiscard]] WireRequest request(std::string_view method, std::string_view target, std::string_view key) const;
    /// One connection of follow(), until it is lost. `after` moves on.
    [[nodiscard]] Result<bool> follow_once(std::optional<std::uint64_t>& after,
                                           const std::function<bool(const Json&)>& on_event);

    ClientSettings settings_;
    std::unique_ptr<ClientConnection> connection_;
    Json problem_;
};

} // namespace linefeed::api
