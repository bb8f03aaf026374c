#include "api/exchange.hpp"

#include "base/assert.hpp"

namespace linefeed::api {

std::string_view to_string(Role role) {
    switch (role) {
    case Role::anyone:
        return "anyone";
    case Role::viewer:
        return "viewer";
    case Role::operator_:
        return "operator";
    }
    assertion_failed("Role", __FILE__, __LINE__);
}

Answer to_answer(const Problem& problem) {
    Answer answer;
    answer.status = status_of(problem.type);
    answer.content_type = media::problem;
    answer.body = to_json(problem);
    answer.allow = problem.allow;
    answer.retry_after_s = problem.retry_after_s;
    return answer;
}

} // namespace linefeed::api
