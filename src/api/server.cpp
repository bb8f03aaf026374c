#include "api/server.hpp"

#include "api/connection.hpp"
#include "api/event_stream.hpp"
#include "api/unix_listener.hpp"

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/post.hpp>

#include <algorithm>
#include <optional>
#include <thread>
#include <vector>

namespace linefeed::api {

using boost::asio::ip::tcp;
using boost::asio::local::stream_protocol;
using boost::system::error_code;

namespace {

/// Of the Unix socket; operators must get in however many programs come over TCP.
constexpr std::size_t max_unix_connections = 512;
/// So many may be told at once that there are too many; more are closed without a word.
constexpr std::size_t max_turned_away = 64;
constexpr std::chrono::milliseconds accept_retry{100};
constexpr std::chrono::seconds stop_grace{2};

Result<std::shared_ptr<const Rules>> load_rules(const config::HttpSettings& settings) {
    auto access = AccessRules::load(settings);
    if (!access) {
        return access.error();
    }
    Rules rules{std::move(*access), {}, static_cast<std::uint32_t>(settings.max_header), settings.request_timeout};
    rules.body.upload = settings.max_body;
    return std::make_shared<const Rules>(std::move(rules));
}

/// Without the prefix of IPv4 addresses on an IPv6 socket.
std::string numeric(const boost::asio::ip::address& address) {
    if (address.is_v6() && address.to_v6().is_v4_mapped()) {
        return boost::asio::ip::make_address_v4(boost::asio::ip::v4_mapped, address.to_v6()).to_string();
    }
    return address.to_string();
}

/// std::nullopt: the client is gone again.
std::optional<Peer> peer_of(tcp::socket& socket) {
    error_code error;
    const tcp::endpoint remote = socket.remote_endpoint(error);
    const tcp::endpoint local = error ? tcp::endpoint{} : socket.local_endpoint(error);
    if (error) {
        return std::nullopt;
    }
    socket.set_option(tcp::no_delay{true}, error);
    return Peer{false, numeric(remote.address()), numeric(local.address()), local.port()};
}

std::optional<Peer> peer_of(stream_protocol::socket& socket) {
    return Peer{true, peer_name(socket.native_handle()), "", 0};
}

} // namespace

class Server::Impl {
public:
    Impl(daemon::Operations& operations, const config::Settings& settings,
         std::function<void(const AccessRecord&)> on_request)
        : http_(settings.http)
        , control_(settings.control)
        , dispatcher_(operations, metrics_)
        , feed_(std::make_shared<EventFeed>(context_, operations, workers_))
        , core_{context_,
                nullptr,
                workers_,
                dispatcher_,
                metrics_,
                *feed_,
                settings.spool.parent_path() / "uploads",
                std::move(on_request)} {}

    Result<void> start() {
        auto rules = load_rules(http_);
        if (!rules) {
            return rules.error();
        }
        core_.rules = std::move(*rules);
        tcp_limits_.set_most(http_.max_connections);
        if (auto prepared = prepare_uploads(core_.uploads); !prepared) {
            return prepared;
        }
        if (auto listening = listen(unix_acceptor_, control_); !listening) {
            return listening;
        }
        socket_inode_ = socket_inode(control_.socket);
        if (auto listening = listen_tcp(); !listening) {
            unix_acceptor_.close();
            remove_socket(control_.socket, socket_inode_);
            return listening;
        }
        feed_->start();
        accept(unix_acceptor_, unix_limits_);
        accept(tcp_acceptor_, tcp_limits_);
        thread_ = std::thread{[this] { run(); }};
        return {};
    }

    Result<void> reload(const config::HttpSettings& settings) {
        config::HttpSettings next = settings;
        next.listen = http_.listen; // bound already
        auto rules = load_rules(next);
        if (!rules) {
            return rules.error();
        }
        boost::asio::post(context_, [this, rules = std::move(*rules), most = settings.max_connections] {
            core_.rules = rules;
            tcp_limits_.set_most(most);
            close_streams([](const EventStream& stream) { return stream.over_tcp(); });
        });
        return {};
    }

    void stop() {
        if (!thread_.joinable()) {
            return;
        }
        boost::asio::post(context_, [this] {
            core_.stopping = true;
            error_code ignored;
            tcp_acceptor_.close(ignored);
            unix_acceptor_.close(ignored);
            retry_.cancel();
            feed_->stop();
            close_streams([](const EventStream&) { return true; });
            for_each_connection([](Connection& connection) { connection.end(); });
        });
        workers_.finish();
        boost::asio::post(context_, [this] {
            work_.reset();
            grace_.expires_after(stop_grace);
            grace_.async_wait(
                [this](const error_code&) { for_each_connection([](Connection& connection) { connection.close(); }); });
            end_grace_early();
        });
        thread_.join();
        remove_socket(control_.socket, socket_inode_);
    }

    [[nodiscard]] std::uint16_t port() const { return port_; }

private:
    void run() {
        for (;;) {
            try {
                context_.run();
                return;
            } catch (const std::exception&) { // out of memory in one connection's step: the others go on
            }
        }
    }

    Result<void> listen_tcp() {
        error_code error;
        const tcp::endpoint endpoint{boost::asio::ip::make_address(http_.listen, error), http_.port};
        if (!error) {
            tcp_acceptor_.open(endpoint.protocol(), error);
        }
        if (!error) {
            tcp_acceptor_.set_option(tcp::acceptor::reuse_address{true}, error);
        }
        if (!error) {
            tcp_acceptor_.bind(endpoint, error);
        }
        if (!error) {
            tcp_acceptor_.listen(boost::asio::socket_base::max_listen_connections, error);
        }
        if (error) {
            return Failure{FailureKind::unreachable, "cannot listen on " + http_.listen + " port " +
                                                         std::to_string(http_.port) + ": " + error.message()};
        }
        port_ = tcp_acceptor_.local_endpoint().port();
        return {};
    }

    template <typename Acceptor>
    void accept(Acceptor& acceptor, ConnectionLimits& limits) {
        acceptor.async_accept([this, &acceptor, &limits](const error_code& error, auto socket) {
            if (!acceptor.is_open()) {
                return;
            }
            if (error) { // out of descriptors, say: try again when some may have been closed
                make_room(true);
                retry_.expires_after(accept_retry);
                retry_.async_wait([this, &acceptor, &limits](const error_code&) {
                    if (acceptor.is_open()) {
                        accept(acceptor, limits);
                    }
                });
                return;
            }
            if (auto peer = peer_of(socket)) {
                accepted(Socket{std::move(socket)}, std::move(*peer), limits);
            }
            accept(acceptor, limits);
        });
    }

    void accepted(Socket socket, Peer peer, ConnectionLimits& limits) {
        using Verdict = ConnectionLimits::Verdict;
        Verdict verdict = limits.verdict(peer.name);
        if (verdict == Verdict::too_many) {
            make_room(!peer.unix_socket);
            verdict = limits.verdict(peer.name);
        }
        if (verdict == Verdict::admitted) {
            auto slot = std::make_unique<ConnectionSlot>(limits, peer.name);
            std::make_shared<Connection>(std::move(socket), std::move(peer), core_, std::move(slot))->start();
            return;
        }
        if (core_.connections.size() >= tcp_limits_.open() + unix_limits_.open() + max_turned_away) {
            return;
        }
        Problem problem = verdict == Verdict::too_many_from_address
                              ? Problem{ProblemType::too_many,
                                        std::to_string(limits.most_from_address()) + " connections are open from you",
                                        "use those that you have, or raise http.max_connections"}
                              : Problem{ProblemType::busy, "too many connections are open",
                                        "ask again in a moment, or raise http.max_connections"};
        problem.retry_after_s = 1;
        std::make_shared<Connection>(std::move(socket), std::move(peer), core_, nullptr)->turn_away(std::move(problem));
    }

    /// Closes the connection that has been silent for longest, if one is.
    void make_room(bool over_tcp) {
        Connection* longest = nullptr;
        for (Connection* const connection : core_.connections) {
            if (connection->is_waiting() && connection->over_tcp() == over_tcp &&
                (longest == nullptr || connection->since() < longest->since())) {
                longest = connection;
            }
        }
        if (longest != nullptr) {
            longest->close();
        }
    }

    template <typename Function>
    void for_each_connection(Function&& function) {
        const std::vector<Connection*> connections{core_.connections.begin(), core_.connections.end()};
        for (Connection* const connection : connections) {
            function(*connection); // closes at most; who is closed goes later, with its handlers
        }
    }

    template <typename Predicate>
    void close_streams(Predicate&& which) {
        const std::vector<EventStream*> streams{core_.streams.begin(), core_.streams.end()};
        for (EventStream* const stream : streams) {
            if (which(*stream)) {
                stream->close();
            }
        }
    }

    /// The grace ends with the last connection.
    void end_grace_early() {
        if (core_.connections.empty()) {
            grace_.cancel();
            return;
        }
        retry_.expires_after(std::chrono::milliseconds{10});
        retry_.async_wait([this](const error_code&) { end_grace_early(); });
    }

    config::HttpSettings http_;
    config::ControlSettings control_;
    boost::asio::io_context context_;
    std::optional<boost::asio::executor_work_guard<boost::asio::io_context::executor_type>> work_{
        boost::asio::make_work_guard(context_)};
    Metrics metrics_;
    Workers workers_;
    Dispatcher dispatcher_;
    std::shared_ptr<EventFeed> feed_;
    Core core_;
    ConnectionLimits tcp_limits_{0};
    ConnectionLimits unix_limits_{max_unix_connections};
    tcp::acceptor tcp_acceptor_{context_};
    stream_protocol::acceptor unix_acceptor_{context_};
    boost::asio::steady_timer retry_{context_};
    boost::asio::steady_timer grace_{context_};
    std::uint64_t socket_inode_ = 0;
    std::uint16_t port_ = 0;
    std::thread thread_;
};

Server::Server(daemon::Operations& operations, const config::Settings& settings,
               std::function<void(const AccessRecord&)> on_request)
    : impl_(std::make_unique<Impl>(operations, settings, std::move(on_request))) {}

Server::~Server() {
    impl_->stop();
}

Result<void> Server::start() {
    return impl_->start();
}

Result<void> Server::reload(const config::HttpSettings& settings) {
    return impl_->reload(settings);
}

void Server::stop() {
    impl_->stop();
}

std::uint16_t Server::port() const {
    return impl_->port();
}

} // namespace linefeed::api
