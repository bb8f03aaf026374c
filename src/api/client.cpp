#include "api/client.hpp"

#include "api/client_connection.hpp"
#include "api/event_parser.hpp"
#include "api/exchange.hpp"
#include "api/media_type.hpp"

#include <array>
#include <thread>

namespace linefeed::api {

namespace {

constexpr std::size_t key_bytes = 16;
constexpr std::chrono::seconds come_again_after{2};

FailureKind kind_from_name(std::string_view name) {
    using enum FailureKind;
    for (const FailureKind kind : {usage, unreachable, stopped, input, in_doubt, storage}) {
        if (to_string(kind) == name) {
            return kind;
        }
    }
    return internal;
}

std::string text_of(const Json& json, std::string_view member) {
    const auto found = json.find(member);
    return found != json.end() && found->is_string() ? found->get<std::string>() : std::string{};
}

/// Of an answer that is a problem, or no answer of ours: then `problem` is null.
Failure to_failure(const WireReply& reply, Json& problem) {
    problem = media_type_of(reply.content_type) == media::problem ? parsed_object(reply.body) : Json(nullptr);
    if (!problem.is_object()) {
        return {FailureKind::internal, "the service answers with status " + std::to_string(reply.status) +
                                           ", which is not how linefeed answers: is that its address?"};
    }
    const std::string advice = text_of(problem, "advice");
    return {kind_from_name(text_of(problem, "kind")),
            text_of(problem, "detail") + (advice.empty() ? "" : ": ") + advice};
}

bool is_success(int status) {
    return status >= 200 && status < 300;
}

} // namespace

std::string new_key() {
    return random_hex(key_bytes);
}

Client::Client(ClientSettings settings)
    : settings_(std::move(settings))
    , connection_(std::make_unique<ClientConnection>(settings_.address, settings_.connect_timeout)) {}

Client::~Client() = default;
Client::Client(Client&&) noexcept = default;
Client& Client::operator=(Client&&) noexcept = default;

WireRequest Client::request(std::string_view method, std::string_view target, std::string_view key) const {
    WireRequest request{std::string{method}, std::string{target}};
    if (!settings_.token.empty() && settings_.address.socket.empty()) {
        request.fields.emplace_back("Authorization", "Bearer " + settings_.token);
    }
    if (!key.empty()) {
        request.fields.emplace_back("Idempotency-Key", key);
    }
    return request;
}

Result<Reply> Client::exchange(const WireRequest& request, bool repeatable) {
    problem_ = nullptr;
    if (!repeatable) {
        connection_->close(); // one that the service has closed meanwhile would leave open whether the request came in
    }
    auto reply = connection_->exchange(request, settings_.answer_timeout);
    if (!reply && repeatable && connection_->was_sent() && reply.error().kind == FailureKind::unreachable) {
        reply = connection_->exchange(request, settings_.answer_timeout);
    }
    if (!reply) {
        return reply.error();
    }
    if (!is_success(reply->status)) {
        return to_failure(*reply, problem_);
    }
    return Reply{reply->status, Json::parse(reply->body, nullptr, false), reply->body, reply->replayed};
}

Result<Reply> Client::get(std::string_view target) {
    return exchange(request("GET", target, ""), true);
}

Result<void> Client::each(std::string_view target, const std::function<bool(const Json&)>& on_item) {
    std::string next{target};
    while (!next.empty()) {
        const auto reply = get(next);
        if (!reply) {
            return reply.error();
        }
        const auto items = reply->body.find("items");
        if (!reply->body.is_object() || items == reply->body.end()) {
            return Failure{FailureKind::internal, "the service answers " + next + " with no list"};
        }
        for (const Json& item : *items) {
            if (!on_item(item)) {
                return {};
            }
        }
        next = text_of(reply->body, "next");
    }
    return {};
}

Result<Reply> Client::post(std::string_view target, const Json& body, std::string_view key) {
    WireRequest wire = request("POST", target, key);
    if (!body.is_null()) {
        wire.fields.emplace_back("Content-Type", media::json);
        wire.body = body.dump(-1, ' ', false, Json::error_handler_t::replace);
    }
    return exchange(wire, !key.empty());
}

Result<Reply> Client::upload(std::string_view target, const std::filesystem::path& file, std::string_view content_type,
                             std::string_view key) {
    WireRequest wire = request("POST", target, key);
    wire.fields.emplace_back("Content-Type", content_type);
    wire.file = file;
    return exchange(wire, !key.empty());
}

Result<bool> Client::follow_once(std::optional<std::uint64_t>& after,
                                 const std::function<bool(const Json&)>& on_event) {
    problem_ = nullptr;
    WireRequest wire = request("GET", "/api/v1/events/stream", "");
    if (after) {
        wire.fields.emplace_back("Last-Event-ID", std::to_string(*after));
    }
    ClientConnection stream{settings_.address, settings_.connect_timeout};
    const auto head = stream.open(wire, settings_.answer_timeout);
    if (!head) {
        return head.error();
    }
    if (head->status != 200) {
        return to_failure(*head, problem_);
    }
    EventParser parser;
    for (;;) {
        const auto piece = stream.read_piece(settings_.heartbeat_timeout);
        if (!piece) {
            return piece.error();
        }
        if (piece->empty()) {
            return Failure{FailureKind::unreachable, "the service has ended the stream of events"};
        }
        for (const StreamedEvent& event : parser.take(*piece)) {
            after = event.id;
            if (!on_event(event.data)) {
                return true;
            }
        }
    }
}

Result<void> Client::follow(std::optional<std::uint64_t> after, const std::function<bool(const Json&)>& on_event,
                            const std::function<bool(const Failure&)>& on_lost) {
    for (;;) {
        const auto done = follow_once(after, on_event);
        if (done) {
            return {};
        }
        if (done.error().kind != FailureKind::unreachable || (on_lost && !on_lost(done.error()))) {
            return done.error();
        }
        std::this_thread::sleep_for(come_again_after);
    }
}

} // namespace linefeed::api
