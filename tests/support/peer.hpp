// Whoever listens where a printer should: any number of connections, frames in, and a script that says what comes back.
#pragma once

#include "printer/printer_client.hpp"
#include "protocol/frame_decoder.hpp"
#include "simulator/simulator.hpp"

#include <boost/asio/ip/address.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <list>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace linefeed::printer {

inline ClientSettings client_of(std::uint16_t port) {
    ClientSettings settings;
    settings.address = "tcp://127.0.0.1:" + std::to_string(port);
    settings.endpoints.tcp = {{boost::asio::ip::address_v4::loopback(), port}};
    settings.reply_timeout = std::chrono::milliseconds{200};
    return settings;
}

class Peer {
public:
    /// What the peer does about a frame.
    struct Reaction {
        std::string bytes{};
        bool close = false;
    };
    using Script = std::function<Reaction(std::string_view frame)>;

    explicit Peer(Script script)
        : script_(std::move(script)) {
        accept();
        thread_ = std::thread{[this] { context_.run(); }};
    }
    ~Peer() {
        context_.stop();
        thread_.join();
    }
    Peer(const Peer&) = delete;
    Peer& operator=(const Peer&) = delete;

    [[nodiscard]] ClientSettings settings() const { return client_of(port_); }
    /// Every frame that came, on whichever connection, CR as line end.
    [[nodiscard]] std::string heard() {
        const std::lock_guard lock{mutex_};
        return heard_;
    }
    [[nodiscard]] int connections() {
        const std::lock_guard lock{mutex_};
        return connections_;
    }
    /// Closes all that are connected.
    void cut() {
        boost::asio::post(context_, [this] {
            for (Client& client : clients_) {
                client.socket.close();
            }
        });
    }

private:
    using Socket = boost::asio::ip::tcp::socket;
    struct Client {
        Socket socket;
        protocol::FrameDecoder decoder{};
        std::array<char, 4096> buffer{};
    };

    void accept() {
        acceptor_.async_accept([this](const boost::system::error_code& error, Socket socket) {
            if (error) {
                return;
            }
            {
                const std::lock_guard lock{mutex_};
                ++connections_;
            }
            clients_.push_back({std::move(socket)});
            read(std::prev(clients_.end()));
            accept();
        });
    }
    void read(std::list<Client>::iterator client) {
        const auto handler = [this, client](const boost::system::error_code& error, std::size_t size) {
            if (error || !react(*client, size)) {
                clients_.erase(client);
                return;
            }
            read(client);
        };
        client->socket.async_read_some(boost::asio::buffer(client->buffer), handler);
    }
    bool react(Client& client, std::size_t size) {
        std::string_view bytes{client.buffer.data(), size};
        while (!bytes.empty()) {
            const auto result = client.decoder.next(bytes);
            const auto* const frame = std::get_if<protocol::Frame>(&result);
            if (frame == nullptr) {
                continue;
            }
            {
                const std::lock_guard lock{mutex_};
                (heard_ += frame->raw) += '\n';
            }
            const Reaction reaction = script_(frame->raw);
            boost::system::error_code ignored;
            boost::asio::write(client.socket, boost::asio::buffer(reaction.bytes), ignored);
            if (reaction.close) {
                return false;
            }
        }
        return true;
    }

    Script script_;
    boost::asio::io_context context_;
    boost::asio::ip::tcp::acceptor acceptor_{context_, {boost::asio::ip::address_v4::loopback(), 0}};
    std::uint16_t port_ = acceptor_.local_endpoint().port();
    std::list<Client> clients_;
    std::mutex mutex_;
    std::string heard_;
    int connections_ = 0;
    std::thread thread_;
};

/// The simulated printer, on a thread of its own.
class RunningSimulator {
public:
    explicit RunningSimulator(simulator::SimulatorSettings settings = {})
        : simulator_(
              [&settings] {
                  settings.port = "0";
                  return settings;
              }(),
              context_) {
        const std::string address = simulator_.open().value();
        port_ = static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1)));
        simulator_.start();
        thread_ = std::thread{[this] { context_.run(); }};
    }
    ~RunningSimulator() {
        context_.stop();
        thread_.join();
    }
    RunningSimulator(const RunningSimulator&) = delete;
    RunningSimulator& operator=(const RunningSimulator&) = delete;

    [[nodiscard]] ClientSettings settings() const { return client_of(port_); }

private:
    boost::asio::io_context context_{1};
    simulator::Simulator simulator_;
    std::uint16_t port_ = 0;
    std::thread thread_;
};

} // namespace linefeed::printer
