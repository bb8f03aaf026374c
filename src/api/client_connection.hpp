// A client's connection: requests and answers as bytes and texts, each step with a time limit. Boost.Beast stays in its
// .cpp.
#pragma once

#include "api/service_address.hpp"
#include "base/failure.hpp"
#include "base/time.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace linefeed::api {

struct WireRequest {
    std::string method;
    std::string target;
    std::vector<std::pair<std::string, std::string>> fields{}; ///< besides Host and Content-Length
    std::string body{};
    std::optional<std::filesystem::path> file{}; ///< instead of body
};

struct WireReply {
    int status = 0;
    std::string content_type;
    bool replayed = false;
    std::string body;
};

/// Flow: exchange() as often as wanted; or open(), then read_piece() until it is empty. One thread.
class ClientConnection {
public:
    /// Of answers that are not streams.
    static constexpr std::size_t max_reply_bytes = std::size_t{256} << 20U;

    ClientConnection(ServiceAddress address, Duration connect_timeout);
    ~ClientConnection();

    /// Opens the connection if there is none. FailureKind::unreachable if there is no answer; ::input if the file
    /// cannot be read.
    [[nodiscard]] Result<WireReply> exchange(const WireRequest& request, Duration answer_timeout);
    /// The same, but of an answer with status 200 the body is left to read_piece().
    [[nodiscard]] Result<WireReply> open(const WireRequest& request, Duration answer_timeout);
    /// What has come next; empty = the stream has ended. FailureKind::unreachable if nothing comes for `timeout`.
    [[nodiscard]] Result<std::string> read_piece(Duration timeout);

    [[nodiscard]] bool is_open() const;
    void close();
    /// Whether the last request may have reached the service.
    [[nodiscard]] bool was_sent() const;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace linefeed::api
