// Carries out a session's effects over TCP or a serial line: reads, one gather write at a time, and one timer. Decides
// nothing.
#pragma once

#include "base/time.hpp"
#include "link/dialer.hpp"
#include "link/handler_memory.hpp"
#include "session/session.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

#include <array>
#include <memory>
#include <optional>
#include <string>

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
class PrinterLink {
public:
    PrinterLink(boost::asio::io_context& context, session::Session& session, EffectHandler& handler);

    /// Tries TCP endpoints in turn, each for at most `timeout`; opens a serial line.
    void connect(Endpoints endpoints, Duration timeout);

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
    void connected(Channel channel);
    void read();
    void carry_out(session::Effects& effects);
    /// Begins to write what the session has. True when the write is complete.
    [[nodiscard]] bool write();
    /// Writes as much as the socket takes. True when the write is complete.
    [[nodiscard]] bool continue_write();
    void wait_until_writable();
    void write_on(const boost::system::error_code& error);
    /// The kernel has all of the write. True when it has gone out, as far as anybody can tell.
    [[nodiscard]] bool gone_out();
    void broken();
    void close();
    void arm_timer();

    std::shared_ptr<HandlerMemory> memory_ = std::make_shared<HandlerMemory>();
    Dialer dialer_;
    Channel channel_;
    boost::asio::steady_timer timer_;
    boost::asio::steady_timer drain_timer_; ///< looks whether a serial line has sent what it was given
    session::Session& session_;
    EffectHandler& handler_;

    Duration byte_time_{}; ///< of a serial line
    bool open_ = false;

    static constexpr std::size_t receive_bytes = 16 * 1024;
    std::array<char, receive_bytes> received_{};
    std::array<boost::asio::const_buffer, session::max_write_pieces> write_buffers_;
    std::size_t write_next_ = 0;
    std::size_t write_end_ = 0;
    std::optional<Instant> armed_;
};

} // namespace linefeed::link
