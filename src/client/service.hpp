// The service as the subcommands see it: where it is, and every failure to reach it with what to do about it.
#pragma once

#include "api/client.hpp"
#include "base/failure.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::client {

using api::Json;

inline constexpr std::string_view default_socket = "/run/linefeed/linefeed.sock";

/// `--socket`, `--url` and `--token-file`; empty = not given.
struct ServiceOptions {
    std::filesystem::path socket;
    std::string url;
    std::filesystem::path token_file;
};

/// Where to look for the service.
struct ServicePlace {
    api::ServiceAddress address;
    std::string token;   ///< over TCP; empty = none
    bool chosen = false; ///< by an option or LINEFEED_SOCKET, and not just the default
};

/// `variable` is the value of LINEFEED_SOCKET, empty = not set; options go before it. FailureKind::usage if the options
/// contradict each other, the URL is none, or the file of the token is empty; ::input if that cannot be read.
[[nodiscard]] Result<ServicePlace> find_service(const ServiceOptions& options, std::string_view variable);
/// With the environment of the process.
[[nodiscard]] Result<ServicePlace> find_service(const ServiceOptions& options);

/// What keeps this process from connecting to the socket file; both empty = nothing that can be seen.
struct Trouble {
    std::string words;
    std::string advice;
};
[[nodiscard]] Trouble socket_trouble(const std::filesystem::path& socket);

/// A connection to the service. Failures are as api::Client's; FailureKind::unreachable says what to do.
class Service {
public:
    explicit Service(const ServicePlace& place);
    /// Another connection to the same service. Any thread.
    [[nodiscard]] Service again() const { return Service{settings_}; }
    /// The same, but it gives up after a few seconds without an answer: for looks that come again and again, and
    /// between which Ctrl-C is heard.
    [[nodiscard]] Service impatient() const;

    [[nodiscard]] const api::ServiceAddress& address() const { return settings_.address; }
    [[nodiscard]] bool over_socket() const { return !settings_.address.socket.empty(); }

    /// The JSON that is there.
    [[nodiscard]] Result<Json> get(std::string_view target);
    /// All `items` of a list, at most `limit`.
    [[nodiscard]] Result<std::vector<Json>> list(std::string_view target, std::size_t limit);
    [[nodiscard]] Result<void> each(std::string_view target, const std::function<bool(const Json&)>& on_item);
    /// What is there, if it is not JSON.
    [[nodiscard]] Result<std::string> get_bytes(std::string_view target);
    /// With an Idempotency-Key of its own: a connection that is lost before the answer is opened once more and the
    /// request repeated, and nothing is done twice.
    [[nodiscard]] Result<Json> post(std::string_view target, const Json& body = nullptr);
    /// Without one: the service does not have to write anything down before it obeys.
    [[nodiscard]] Result<Json> post_at_once(std::string_view target);
    [[nodiscard]] Result<Json> upload(std::string_view target, const std::filesystem::path& file,
                                      std::string_view content_type);
    /// As api::Client::follow().
    [[nodiscard]] Result<void> follow(std::optional<std::uint64_t> after,
                                      const std::function<bool(const Json&)>& on_event,
                                      const std::function<bool(const Failure&)>& on_lost);
    /// What the service has answered instead of what was asked, a Problem of openapi.yaml; null if the last request did
    /// not fail, or had no answer.
    [[nodiscard]] const Json& problem() const { return client_.problem(); }

private:
    explicit Service(const api::ClientSettings& settings);
    [[nodiscard]] Failure explained(const Failure& failure) const;

    api::ClientSettings settings_;
    api::Client client_;
};

/// "/api/v1/jobs/12" + `rest`.
[[nodiscard]] std::string job_path(std::int64_t job, std::string_view rest = {});
/// "/api/v1/printers/NAME" + `rest`; the name is encoded.
[[nodiscard]] std::string printer_path(std::string_view printer, std::string_view rest = {});

} // namespace linefeed::client
