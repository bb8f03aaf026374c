#include "api/connection.hpp"

#include "api/event_stream.hpp"
#include "api/response_head.hpp"

#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/buffer_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>

#include <algorithm>
#include <array>
#include <exception>
#include <optional>

namespace linefeed::api {

namespace http = boost::beast::http;
using boost::system::error_code;
using std::chrono::steady_clock;

namespace {

constexpr std::size_t piece_bytes = std::size_t{64} << 10U;
/// Slower than this, an upload is not one but somebody who wants to keep a connection.
constexpr std::uint64_t least_upload_rate = std::uint64_t{128} << 10U; ///< bytes per second
constexpr std::chrono::seconds linger_time{2};
constexpr std::size_t max_discarded = std::size_t{1} << 20U; ///< bytes

std::string lower_case(std::string_view text) {
    std::string lower{text};
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c | 0x20) : c; });
    return lower;
}

spool::Sha256Digest sha256_of(std::string_view bytes) {
    spool::Sha256 sha256;
    sha256.update(bytes);
    return sha256.finish();
}

Problem stopping_problem() {
    return {ProblemType::stopping, "the service is ending", "ask again when it is started again"};
}

Problem late_body() {
    return {ProblemType::request_timeout, "the body did not come in time",
            "send it faster, or raise http.request_timeout"};
}

Problem busy_problem(std::string detail) {
    Problem problem{ProblemType::busy, std::move(detail), "ask again in a moment"};
    problem.retry_after_s = 1;
    return problem;
}

} // namespace

/// A request as it is being read.
struct Connection::Reader {
    explicit Reader(std::uint32_t max_header)
        : buffer(max_header + piece_bytes)
        , max_header_(max_header) {
        start();
    }

    void start() {
        parser.emplace();
        parser->header_limit(max_header_);
        parser->body_limit(boost::none); // counted by the connection, which knows the limit only behind the header
    }

    boost::beast::flat_buffer buffer;
    std::optional<http::request_parser<http::buffer_body>> parser;
    std::string piece; ///< of the body

private:
    std::uint32_t max_header_;
};

Connection::Connection(Socket socket, Peer peer, Core& core, std::unique_ptr<ConnectionSlot> slot)
    : socket_(std::move(socket))
    , peer_(std::move(peer))
    , core_(core)
    , slot_(std::move(slot))
    , timer_(core.context)
    , rules_(core.rules) {
    core_.metrics.connection_opened();
    core_.connections.insert(this);
}

Connection::~Connection() {
    close();
    core_.connections.erase(this);
    core_.metrics.connection_closed();
}

void Connection::start() {
    wait_for_request();
}

void Connection::turn_away(Problem problem) {
    begun_ = steady_clock::now();
    body_left_ = true; // nothing was read
    refuse(std::move(problem));
}

void Connection::end() {
    keep_alive_ = false;
    if (is_waiting()) {
        close();
    }
}

void Connection::close() {
    if (state_ == State::closed) {
        return;
    }
    state_ = State::closed;
    ++timer_turn_;
    timer_.cancel();
    error_code ignored;
    socket_.close(ignored);
    slot_.reset();
    drop_upload();
}

void Connection::drop_upload() {
    if (std::exchange(counts_upload_, false)) {
        --core_.open_uploads;
    }
    if (upload_ && !core_.workers.post(Lane::disk, [upload = upload_] {})) {
        upload_.reset(); // removed here, then
    }
    upload_.reset();
}

// Deadlines

void Connection::enter(State state, Duration deadline) {
    enter_without_deadline(state);
    arm(since_ + deadline);
}

void Connection::enter_without_deadline(State state) {
    state_ = state;
    since_ = steady_clock::now();
    ++timer_turn_;
    timer_.cancel();
}

void Connection::arm(steady_clock::time_point deadline) {
    timer_.expires_at(deadline);
    timer_.async_wait([self = shared_from_this(), turn = ++timer_turn_](const error_code& cancelled) {
        if (!cancelled && turn == self->timer_turn_) {
            self->on_deadline();
        }
    });
}

void Connection::on_deadline() {
    if (state_ == State::header || state_ == State::body) {
        timed_out_ = true; // the reading ends, and its handler answers
        error_code ignored;
        socket_.cancel(ignored);
    } else {
        close();
    }
}

// The header

void Connection::wait_for_request() {
    if (reader_ && reader_->buffer.size() > 0) { // the next request has come with the one before
        read_header();
        return;
    }
    reader_.reset(); // an idle connection costs little
    enter(State::idle, core_.rules->request_timeout);
    socket_.async_wait(Socket::wait_read, [self = shared_from_this()](const error_code& error) {
        if (error || self->state_ != State::idle) {
            self->close();
        } else {
            self->read_header();
        }
    });
}

void Connection::read_header() {
    rules_ = core_.rules; // those in force now, also on a connection that was opened before
    enter(State::header, rules_->request_timeout);
    begun_ = since_;
    caller_.clear();
    method_.clear();
    target_.clear();
    cors_origin_.clear();
    preflight_ = without_body_ = keep_alive_ = body_left_ = timed_out_ = false;
    body_bytes_ = 0;
    admitted_.reset();
    if (reader_) {
        reader_->start();
    } else {
        reader_ = std::make_unique<Reader>(rules_->max_header);
    }
    http::async_read_header(
        socket_, reader_->buffer, *reader_->parser,
        [self = shared_from_this()](const error_code& error, std::size_t) { self->on_header(error); });
}

void Connection::on_header(const error_code& error) {
    if (state_ != State::header) {
        return;
    }
    const bool begun = reader_->parser->got_some();
    body_left_ = true;
    if (timed_out_) {
        refuse({ProblemType::request_timeout, "the header did not come in time", "send the request in one go"});
    } else if (error == http::error::header_limit || error == http::error::buffer_overflow) {
        refuse({ProblemType::header_too_large,
                "the header has more than " + std::to_string(rules_->max_header) + " bytes",
                "send less, or raise http.max_header"});
    } else if (error && begun && error.category() == make_error_code(http::error::bad_method).category() &&
               error != http::error::end_of_stream && error != http::error::partial_message) {
        refuse({ProblemType::malformed, "this is no HTTP request: " + error.message(), "see RFC 9112"});
    } else if (error) {
        close();
    } else {
        admit_request();
    }
}

void Connection::admit_request() {
    const auto& message = reader_->parser->get();
    Header header;
    header.method = method_ = message.method_string();
    header.target = target_ = message.target();
    constexpr unsigned version_1_0 = 10;
    header.http_1_0 = message.version() == version_1_0;
    for (const auto& field : message) {
        header.fields.emplace_back(lower_case(field.name_string()), field.value());
    }
    header.chunked = reader_->parser->chunked();
    if (const auto length = reader_->parser->content_length()) {
        header.content_length = *length;
    }
    Admission admission = admit(header, peer_, rules_->access, rules_->body);
    caller_ = std::move(admission.caller);
    cors_origin_ = std::move(admission.cors_origin);
    preflight_ = admission.preflight;
    without_body_ = admission.without_body;
    body_left_ = !reader_->parser->is_done() && (header.chunked || header.content_length.value_or(0) > 0);
    keep_alive_ = message.keep_alive() && !core_.stopping;
    if (core_.stopping) {
        refuse(stopping_problem());
    } else if (admission.answer) {
        respond(std::move(*admission.answer));
    } else if (!admission.admitted) {
        refuse(admission.admitted.error());
    } else {
        admitted_ = std::make_shared<Admitted>(std::move(*admission.admitted));
        start_body();
    }
}

// The body

void Connection::start_body() {
    if (admitted_->route->kind() == Kind::stream && !without_body_) {
        start_stream();
        return;
    }
    if (!body_left_ && !admitted_->upload) {
        carry_out(sha256_of({}));
        return;
    }
    if (admitted_->upload && core_.open_uploads >= max_uploads) {
        refuse(busy_problem(std::to_string(max_uploads) + " files are being sent already"));
        return;
    }
    enter(State::body, rules_->request_timeout);
    const auto go_on = [](const std::shared_ptr<Connection>& self) {
        if (self->admitted_->upload) {
            self->create_upload();
        } else {
            self->read_body();
        }
    };
    if (!admitted_->wants_continue) {
        go_on(shared_from_this());
        return;
    }
    boost::asio::async_write(socket_, boost::asio::buffer(continue_head),
                             [self = shared_from_this(), go_on](const error_code& error, std::size_t) {
                                 if (error || self->state_ != State::body) {
                                     self->close();
                                 } else {
                                     go_on(self);
                                 }
                             });
}

void Connection::create_upload() {
    ++core_.open_uploads;
    counts_upload_ = true;
    const bool posted = core_.workers.post(Lane::disk, [self = shared_from_this(), &core = core_]() mutable {
        auto created = Upload::create(core.uploads);
        std::shared_ptr<Upload> upload = created ? std::move(*created) : nullptr;
        boost::asio::post(core.context, [self = std::move(self), upload = std::move(upload),
                                         problem = created ? Problem{} : created.error()]() mutable {
            if (self->state_ != State::body) {
                return;
            }
            self->upload_ = std::move(upload);
            if (!self->upload_) {
                self->refuse(std::move(problem));
            } else if (self->timed_out_) {
                self->refuse(late_body());
            } else {
                self->read_body();
            }
        });
    });
    if (!posted) {
        refuse(busy_problem("too many files are being written"));
    }
}

void Connection::read_body() {
    if (reader_->parser->is_done()) { // nothing is left to come
        if (take_piece({}, true) && !admitted_->upload) {
            carry_out(sha256_of(admitted_->request.body));
        }
        return;
    }
    reader_->piece.resize(piece_bytes);
    auto& body = reader_->parser->get().body();
    body.data = reader_->piece.data();
    body.size = reader_->piece.size();
    http::async_read(socket_, reader_->buffer, *reader_->parser,
                     [self = shared_from_this()](const error_code& error, std::size_t) { self->on_body(error); });
}

void Connection::on_body(const error_code& error) {
    if (state_ != State::body) {
        return;
    }
    if (timed_out_) {
        refuse(late_body());
        return;
    }
    if (error && error != http::error::need_buffer) {
        if (error.category() == make_error_code(http::error::bad_method).category() &&
            error != http::error::partial_message && error != http::error::end_of_stream) {
            refuse({ProblemType::malformed, "the body is no HTTP: " + error.message(), "see RFC 9112"});
        } else {
            close();
        }
        return;
    }
    const std::size_t got = piece_bytes - reader_->parser->get().body().size;
    const bool last = reader_->parser->is_done();
    if (!take_piece(std::string_view{reader_->piece}.substr(0, got), last) || admitted_->upload) {
        return;
    }
    if (last) {
        carry_out(sha256_of(admitted_->request.body));
    } else {
        read_body();
    }
}

bool Connection::take_piece(std::string_view piece, bool last) {
    body_bytes_ += piece.size();
    body_left_ = !last;
    if (body_bytes_ > admitted_->max_body) {
        refuse({ProblemType::too_large, "the body has more than " + std::to_string(admitted_->max_body) + " bytes",
                "send less, or raise http.max_body"});
        return false;
    }
    if (admitted_->upload) {
        write_piece(std::string{piece}, last);
    } else {
        admitted_->request.body += piece;
    }
    return true;
}

void Connection::write_piece(std::string piece, bool last) {
    const bool posted = core_.workers.post(Lane::disk, [self = shared_from_this(), &context = core_.context,
                                                        upload = upload_, piece = std::move(piece), last]() mutable {
        const auto written = upload->append(piece);
        auto closed = last && written ? upload->close() : Checked<spool::Sha256Digest>{spool::Sha256Digest{}};
        std::optional<Problem> problem;
        if (!written || !closed) {
            problem = written ? closed.error() : written.error();
        }
        upload.reset();
        boost::asio::post(context, [self = std::move(self), last, problem = std::move(problem),
                                    digest = closed ? *closed : spool::Sha256Digest{}]() mutable {
            if (self->state_ != State::body) {
                return;
            }
            if (problem) {
                self->refuse(std::move(*problem));
            } else if (self->timed_out_) {
                self->refuse(late_body());
            } else if (last) {
                self->carry_out(digest);
            } else {
                const auto flowing = std::chrono::seconds{self->body_bytes_ / least_upload_rate};
                self->arm(self->begun_ + self->rules_->request_timeout + flowing);
                self->read_body();
            }
        });
    });
    if (!posted) {
        refuse(busy_problem("too many files are being written"));
    }
}

// The work

void Connection::carry_out(const spool::Sha256Digest& body) {
    enter_without_deadline(State::working);
    if (upload_) {
        admitted_->request.upload = upload_->path();
    }
    if (admitted_->route->kind() == Kind::stream) { // HEAD
        Answer answer;
        answer.content_type = media::events;
        respond(std::move(answer));
        return;
    }
    if (admitted_->route->lane == Lane::at_once) {
        respond(core_.dispatcher.carry_out(*admitted_, body));
        return;
    }
    const bool posted =
        core_.workers.post(admitted_->route->lane, [self = shared_from_this(), &core = core_, admitted = admitted_,
                                                    upload = std::move(upload_), body]() mutable {
            Answer answer = core.dispatcher.carry_out(*admitted, body);
            upload.reset(); // the file is removed before the answer says that it is read
            boost::asio::post(core.context, [self = std::move(self), answer = std::move(answer)]() mutable {
                if (self->state_ == State::working) {
                    self->respond(std::move(answer));
                }
            });
        });
    if (!posted) {
        refuse(busy_problem("too many requests are being carried out"));
    }
}

void Connection::start_stream() {
    if (!core_.feed.last()) {
        refuse(busy_problem("the events cannot be read yet"));
        return;
    }
    if (core_.streams.size() >= max_streams) {
        Problem problem{ProblemType::too_many, std::to_string(max_streams) + " event streams are open already",
                        "close one, or ask for /api/v1/events now and then"};
        problem.retry_after_s = 10;
        refuse(std::move(problem));
        return;
    }
    Answer answer;
    answer.content_type = media::events;
    log(answer);
    const std::uint64_t newest = *core_.feed.last();
    const auto stream =
        std::make_shared<EventStream>(std::move(socket_), core_, std::move(slot_),
                                      std::min(admitted_->last_event.value_or(newest), newest), !peer_.unix_socket);
    state_ = State::closed; // what is left of it has no socket
    ++timer_turn_;
    timer_.cancel();
    stream->start(response_head(answer, {cors_origin_, false, true, true}));
}

// The answer

void Connection::refuse(Problem problem) {
    respond(to_answer(problem));
}

void Connection::respond(Answer answer) {
    drop_upload();
    keep_alive_ = keep_alive_ && !body_left_ && !core_.stopping;
    answer_ = std::move(answer);
    head_ = response_head(answer_, {cors_origin_, preflight_, !keep_alive_, false});
    enter(State::writing, rules_->request_timeout);
    const std::array<boost::asio::const_buffer, 2> buffers{
        boost::asio::buffer(head_), boost::asio::buffer(answer_.body.data(), without_body_ ? 0 : answer_.body.size())};
    boost::asio::async_write(socket_, buffers, [self = shared_from_this()](const error_code& error, std::size_t) {
        self->on_written(error);
    });
}

void Connection::on_written(const error_code& error) {
    if (state_ != State::writing) {
        return;
    }
    log(answer_);
    core_.metrics.count_request(answer_.status, steady_clock::now() - begun_);
    if (error) {
        close();
    } else if (keep_alive_ && !core_.stopping) {
        wait_for_request();
    } else {
        linger();
    }
}

void Connection::log(const Answer& answer) const {
    if (core_.on_request) {
        core_.on_request(
            {peer_.name, caller_, method_, target_, answer.status, answer.body.size(), steady_clock::now() - begun_});
    }
}

void Connection::linger() {
    enter(State::lingering, linger_time);
    error_code ignored;
    socket_.shutdown(Socket::shutdown_send, ignored);
    discarded_ = 0;
    head_.resize(piece_bytes);
    discard();
}

void Connection::discard() {
    socket_.async_read_some(boost::asio::buffer(head_),
                            [self = shared_from_this()](const error_code& error, std::size_t got) {
                                self->discarded_ += got;
                                if (error || self->state_ != State::lingering || self->discarded_ > max_discarded) {
                                    self->close();
                                } else {
                                    self->discard();
                                }
                            });
}

} // namespace linefeed::api
