#include "api/idempotency.hpp"

namespace linefeed::api {

namespace {

using daemon::Operations;

/// Remembered::status of a request that was begun, and has no answer.
constexpr int begun = 0;
constexpr int first_failure = 500;

/// What is remembered of an answer: `Location`, a newline, the body.
std::string packed(const Answer& answer) {
    return answer.location + '\n' + answer.body;
}

Answer unpacked(const Operations::Remembered& remembered) {
    const std::size_t newline = remembered.body.find('\n');
    Answer answer;
    answer.status = remembered.status;
    answer.content_type = remembered.status < 400 ? media::json : media::problem;
    answer.location = remembered.body.substr(0, newline);
    answer.body = remembered.body.substr(newline + 1);
    answer.replayed = true;
    return answer;
}

Problem reused(std::string_view key) {
    return {ProblemType::key_reused, "the Idempotency-Key " + std::string{key} + " was used for another request",
            "use a new key for every new request"};
}

Problem interrupted() {
    return {ProblemType::key_interrupted,
            "the service was ended while it carried this out, and does not know how far it has come",
            "look at the job, the events and the audit log; what is still to be done, ask for with a new key"};
}

} // namespace

/// Marks a key as being carried out, for as long as it lives.
class KeyedAnswers::InFlight {
public:
    InFlight(KeyedAnswers& answers, const Request& request)
        : answers_(answers)
        , id_(request.caller.name, request.key) {
        const std::lock_guard lock{answers_.mutex_};
        const auto [place, inserted] = answers_.in_flight_.emplace(id_, request.hash);
        entered_ = inserted;
        same_ = place->second == request.hash;
    }
    InFlight(const InFlight&) = delete;
    InFlight& operator=(const InFlight&) = delete;
    ~InFlight() {
        if (entered_) {
            const std::lock_guard lock{answers_.mutex_};
            answers_.in_flight_.erase(id_);
        }
    }
    [[nodiscard]] bool entered() const { return entered_; }
    /// Whether the request that is being carried out is the same.
    [[nodiscard]] bool same() const { return same_; }

private:
    KeyedAnswers& answers_;
    Id id_;
    bool entered_ = false;
    bool same_ = false;
};

Checked<std::optional<Answer>> KeyedAnswers::given_before(const Request& request) {
    const auto remembered = operations_.remembered(request.caller, request.key);
    if (!remembered) {
        return to_problem(remembered.error());
    }
    if (!*remembered) {
        return std::optional<Answer>{};
    }
    if ((*remembered)->request_hash != request.hash) {
        return reused(request.key);
    }
    if ((*remembered)->status >= first_failure) {
        return std::optional<Answer>{};
    }
    if ((*remembered)->status == begun) {
        return interrupted();
    }
    return std::optional{unpacked(**remembered)};
}

Outcome KeyedAnswers::answer(const Request& request, const std::function<Outcome()>& carry_out) {
    const InFlight in_flight{*this, request};
    if (!in_flight.entered()) {
        Problem problem = in_flight.same() ? Problem{ProblemType::key_in_use, "this very request is being carried out",
                                                     "ask again with the same key in a moment"}
                                           : reused(request.key);
        problem.retry_after_s = in_flight.same() ? std::optional{1} : std::nullopt;
        return problem;
    }
    const auto before = given_before(request);
    if (before && *before) {
        return **before;
    }
    if (!before && (!request.harmless_twice || before.error().type == ProblemType::key_reused)) {
        return before.error();
    }
    const auto marked = operations_.remember(request.caller, request.key, {request.hash, begun, ""});
    if (!marked && !request.harmless_twice) {
        return to_problem(marked.error());
    }
    const Outcome outcome = carry_out();
    const Answer answer = outcome ? *outcome : to_answer(outcome.error());
    // If this fails, the key stays begun: it is never carried out again, and says that it does not know.
    static_cast<void>(operations_.remember(request.caller, request.key, {request.hash, answer.status, packed(answer)}));
    return outcome;
}

} // namespace linefeed::api
