// Carries out a session's effects over TCP: reads, one gather write at a time, and one timer. TCP_NODELAY, since Nagle
// and delayed acknowledgements cost up to 40 ms. Decides nothing.
#pragma once

#include "base/time.hpp"
#include "link/handler_memory.hpp"
#include "session/session.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace linefeed::link {

/// Whoever looks after the ledger, the pages and the people. Called on the link's thread; must neither block nor call
/// the link.
class EffectHandler {
public:
    virtual ~EffectHandler() = default;
    /// Settle, BeginRun, AdoptRun, AskIntent, ConfirmPrinted, ReleasePage, RecordsWritten, Notice or End.
    virtual void on_effect(const session::Effect& effect) = 0;
    /// There is no connection; the reason in words.
    virtual void on_unreachable(const std::string& reason) = 0;
    /// Called after every fact that the session was told at `at`, and all that followed from it.
    virtual void on_progress(Instant at) = 0;
};

/// Flow: connect(), then call() whenever the session has to be told something. Lives on one thread, that of `context`.
class TcpLink {
public:
    TcpLink(boost::asio::io_context& context, session::Session& session, EffectHandler& handler);

    /// Tries the endpoints in turn, each for at most `timeout`.
    void connect(std::vector<boost::asio::ip::tcp::endpoint> endpoints, Duration timeout);

    /// Tells the session something: `fact(session, now, effects)`, and carries out what follows.
    template <typename Fact>
    void call(Fact&& fact) {
        session::Effects effects;
        const Instant at = now();
        fact(session_, at, effects);
        carry_out(effects);
        handler_.on_progress(at);
        arm_timer();
    }

    /// Gives up: closes without telling the session.
    void abort();

private:
    [[nodiscard]] static Instant now();
    void try_next_endpoint();
    void connected();
    void read();
    void carry_out(session::Effects& effects);
    /// Begins to write what the session has. True when the write is complete.
    [[nodiscard]] bool write();
    /// Writes as much as the socket takes. True when the write is complete.
    [[nodiscard]] bool continue_write();
    void wait_until_writable();
    void broken();
    void close();
    void arm_timer();

    std::shared_ptr<HandlerMemory> memory_ = std::make_shared<HandlerMemory>();
    boost::asio::ip::tcp::socket socket_;
    boost::asio::steady_timer timer_;
    session::Session& session_;
    EffectHandler& handler_;

    std::vector<boost::asio::ip::tcp::endpoint> endpoints_;
    std::size_t endpoint_ = 0;
    Duration connect_timeout_{};
    std::string last_error_;
    bool open_ = false;
    bool given_up_ = false; ///< closed for good, also while connecting

    static constexpr std::size_t receive_bytes = 16 * 1024;
    std::array<char, receive_bytes> received_{};
    std::array<boost::asio::const_buffer, session::max_write_pieces> write_buffers_;
    std::size_t write_next_ = 0;
    std::size_t write_end_ = 0;
    std::optional<Instant> armed_;
};

} // namespace linefeed::link
