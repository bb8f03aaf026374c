// The HTTP interface of the service: one server, two listeners. The Unix socket is the operators' (rights by its
// group), TCP is for programs and pages (rights by tokens).
#pragma once

#include "base/failure.hpp"
#include "base/time.hpp"
#include "config/settings.hpp"
#include "daemon/operations.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace linefeed::api {

struct AccessRecord;

/// Flow: start(), reload() as often as the configuration is read, stop(). Has threads of its own: one for the network,
/// some that call `operations` (workers.hpp). start(), reload() and stop() not at the same time.
class Server {
public:
    /// `on_request` is called on the server's network thread after every request, and must not block; may be empty.
    /// `operations` must outlive the server.
    Server(daemon::Operations& operations, const config::Settings& settings,
           std::function<void(const AccessRecord&)> on_request = {});
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// FailureKind::usage if the tokens or the socket's place and group are not right, ::unreachable if an address is
    /// taken, ::storage if there is no place for uploads. Nothing listens then.
    [[nodiscard]] Result<void> start();
    /// Takes over what can change while it runs, and reads the tokens again: everything but listen and port. Streams
    /// over TCP end, and come again with the new rights. FailureKind::usage: nothing is changed.
    [[nodiscard]] Result<void> reload(const config::HttpSettings& settings);
    /// Answers what is being carried out, turns everything else away, and ends.
    void stop();

    /// Of TCP, as bound.
    [[nodiscard]] std::uint16_t port() const;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace linefeed::api
