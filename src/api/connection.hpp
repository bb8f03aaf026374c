// One client's connection: reads a request within its limits, has it carried out, writes the answer, and again. Nothing
// that a client does or leaves undone keeps the thread: every step has a deadline, and a body that is too large is
// never read to its end.
#pragma once

#include "api/core.hpp"
#include "api/upload.hpp"

#include <boost/asio/steady_timer.hpp>

#include <chrono>
#include <memory>
#include <string>

namespace linefeed::api {

/// Flow: start(); it keeps itself alive until it is closed. Lives on the control thread.
class Connection : public std::enable_shared_from_this<Connection> {
public:
    Connection(Socket socket, Peer peer, Core& core, std::unique_ptr<ConnectionSlot> slot);
    ~Connection();
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    void start();
    /// Answers `problem` to whatever comes, and ends.
    void turn_away(Problem problem);
    /// Ends behind the answer that is being worked on; now, if there is none.
    void end();
    void close();

    /// No request has come in whole: it may be closed in favour of another client.
    [[nodiscard]] bool is_waiting() const { return state_ == State::idle || state_ == State::header; }
    [[nodiscard]] std::chrono::steady_clock::time_point since() const { return since_; }
    [[nodiscard]] bool over_tcp() const { return !peer_.unix_socket; }

private:
    enum class State {
        idle,      ///< no byte of a request has come
        header,    ///< it is being read
        body,      ///< it is being read
        working,   ///< its request is being carried out
        writing,   ///< the answer
        lingering, ///< the answer is written, and what the client still sends is thrown away, so that he can read it
        closed,
    };
    struct Reader; ///< Boost.Beast

    void wait_for_request();
    void read_header();
    void on_header(const boost::system::error_code& error);
    void admit_request();
    void start_body();
    void create_upload();
    void read_body();
    void on_body(const boost::system::error_code& error);
    [[nodiscard]] bool take_piece(std::string_view piece, bool last);
    void write_piece(std::string piece, bool last);
    void carry_out(const spool::Sha256Digest& body);
    void start_stream();
    void refuse(Problem problem);
    void respond(Answer answer);
    void on_written(const boost::system::error_code& error);
    void linger();
    void discard();
    void drop_upload();
    void log(const Answer& answer) const;

    void enter(State state, Duration deadline);
    void enter_without_deadline(State state);
    void arm(std::chrono::steady_clock::time_point deadline);
    void on_deadline();

    Socket socket_;
    Peer peer_;
    Core& core_;
    std::unique_ptr<ConnectionSlot> slot_;
    boost::asio::steady_timer timer_;
    std::uint64_t timer_turn_ = 0;                ///< of the newest deadline: older ones mean nothing
    std::chrono::steady_clock::time_point since_; ///< when the state was entered
    State state_ = State::idle;

    std::unique_ptr<Reader> reader_;
    std::shared_ptr<const Rules> rules_;          ///< those of this request
    std::chrono::steady_clock::time_point begun_; ///< first byte of the request
    std::string caller_;                          ///< as in Admission
    std::string method_;
    std::string target_;
    std::shared_ptr<Admitted> admitted_;
    std::string cors_origin_;
    bool preflight_ = false;
    bool without_body_ = false;
    bool keep_alive_ = false;
    bool body_left_ = false; ///< what is left of the body has not been read
    std::uint64_t body_bytes_ = 0;
    std::shared_ptr<Upload> upload_;
    bool counts_upload_ = false;
    bool timed_out_ = false;
    std::string head_;
    Answer answer_;
    std::size_t discarded_ = 0;
};

} // namespace linefeed::api
