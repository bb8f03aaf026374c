#include "api/dispatcher.hpp"

#include "api/json_text.hpp"

#include <exception>

namespace linefeed::api {

namespace {

/// What makes two requests the same. Decoded texts hold no NUL, so that the parts cannot run into each other.
std::string request_hash(const Admitted& admitted, const spool::Sha256Digest& body) {
    spool::Sha256 sha256;
    const auto add = [&sha256](std::string_view text) {
        sha256.update(text);
        sha256.update(std::string_view{"\0", 1});
    };
    add(to_string(admitted.route->method));
    add(admitted.route->path);
    add(admitted.request.parameter);
    add(admitted.request.what);
    for (const auto& [name, value] : admitted.request.query.all()) {
        add(name);
        add(value);
    }
    add("");
    add(admitted.media_type);
    sha256.update({reinterpret_cast<const char*>(body.data()), body.size()});
    const spool::Sha256Digest digest = sha256.finish();
    return spool::to_hex({reinterpret_cast<const char*>(digest.data()), digest.size()});
}

/// A route that takes no JSON takes an empty object all the same: programs like to send one.
Checked<void> check_no_members(const Admitted& admitted) {
    if (admitted.route->body != Body::none || admitted.request.body.empty()) {
        return {};
    }
    const auto body = BodyReader::parse(admitted.request.body);
    return body ? body->finish() : Checked<void>{body.error()};
}

} // namespace

Outcome Dispatcher::outcome(const Admitted& admitted, const spool::Sha256Digest& body) {
    if (const auto empty = check_no_members(admitted); !empty) {
        return empty.error();
    }
    const auto carry_out = [&] { return admitted.route->handle(admitted.request, services_); };
    if (admitted.key.empty()) {
        return carry_out();
    }
    const bool harmless_twice = admitted.route->lane == Lane::stop;
    return keyed_.answer({admitted.request.caller, admitted.key, request_hash(admitted, body), harmless_twice},
                         carry_out);
}

Answer Dispatcher::carry_out(const Admitted& admitted, const spool::Sha256Digest& body) {
    try {
        const Outcome result = outcome(admitted, body);
        return result ? *result : to_answer(result.error());
    } catch (const std::exception& exception) { // a key stays begun: nobody knows how far it has come
        return to_answer({ProblemType::internal, exception.what(), "look at the log of the service"});
    }
}

} // namespace linefeed::api
