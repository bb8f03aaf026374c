// The parsers of the HTTP interface that are our own, on any bytes. A text is a request: method and target on the first
// line, fields on the next ones, behind an empty line the body. One that begins with `#tokens` is a file of tokens, one
// that begins with `id:` a stream of events.
#include "api/admission.hpp"
#include "api/event_parser.hpp"
#include "api/json_text.hpp"
#include "api/tokens.hpp"
#include "api/url.hpp"
#include "base/assert.hpp"

#include <algorithm>
#include <cstdint>
#include <string_view>

namespace {

using namespace linefeed::api;

std::string_view take_line(std::string_view& text) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    return line;
}

Header header_of(std::string_view& text) {
    Header header;
    const std::string_view first = take_line(text);
    header.method = first.substr(0, first.find(' '));
    header.target = first.substr(std::min(header.method.size() + 1, first.size()));
    for (std::string_view line = take_line(text); !line.empty(); line = take_line(text)) {
        const std::size_t colon = std::min(line.find(':'), line.size());
        header.fields.emplace_back(line.substr(0, colon), line.substr(std::min(colon + 1, line.size())));
    }
    header.content_length = text.size();
    return header;
}

void check_problem(const Problem& problem) {
    const Json json = Json::parse(to_json(problem));
    LINEFEED_ASSERT(!problem.detail.empty() && json["status"] == status_of(problem.type));
}

/// Whatever was understood means the same when it is written and read again.
void check_admitted(const Admitted& admitted) {
    LINEFEED_ASSERT(admitted.route != nullptr && admitted.request.role >= admitted.route->role);
    LINEFEED_ASSERT(admitted.route->key != Key::required || !admitted.key.empty());
    LINEFEED_ASSERT(admitted.request.parameter.find('\0') == std::string::npos);
    std::string query;
    for (const auto& [name, value] : admitted.request.query.all()) {
        LINEFEED_ASSERT(admitted.route->takes(name));
        query += url_encoded(name) + '=' + url_encoded(value) + '&';
    }
    const auto again = Query::parse(query);
    LINEFEED_ASSERT(again && again->all() == admitted.request.query.all());
}

void check_body(std::string_view text) {
    auto body = BodyReader::parse(text);
    if (!body) {
        check_problem(body.error());
        return;
    }
    static_cast<void>(body->required_text("records"));
    static_cast<void>(body->number("job", 1, 100));
    static_cast<void>(body->flag("suspend"));
    if (const auto right = body->finish(); !right) {
        check_problem(right.error());
    }
}

void check_events(std::string_view text) {
    EventParser whole;
    EventParser split;
    const std::size_t expected = whole.take(text).size();
    std::size_t count = 0;
    for (const char byte : text) {
        count += split.take({&byte, 1}).size();
    }
    LINEFEED_ASSERT(count == expected);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string_view text{reinterpret_cast<const char*>(data), size};
    if (text.starts_with("#tokens")) {
        const auto tokens = Tokens::parse(text, "tokens");
        LINEFEED_ASSERT(tokens ? tokens->find("x") == nullptr || tokens->size() > 0 : !tokens.error().message.empty());
        return 0;
    }
    if (text.starts_with("id:")) {
        check_events(text);
        return 0;
    }
    if (const auto records = parse_records(text)) {
        LINEFEED_ASSERT(!records->empty());
    }
    const Header header = header_of(text);
    const Peer tcp{false, "127.0.0.1", "127.0.0.1", 8631};
    const Peer socket{true, "anna (uid 1000)", "", 0};
    AccessRules rules;
    rules.origins = {"https://mes.plant.example"};
    for (const Peer& peer : {tcp, socket}) {
        const Admission admission = admit(header, peer, rules, {65536, 65536});
        LINEFEED_ASSERT(admission.cors_origin.empty() || admission.cors_origin == rules.origins.front());
        if (admission.admitted) {
            check_admitted(*admission.admitted);
            LINEFEED_ASSERT(peer.unix_socket || admission.admitted->request.role != Role::operator_);
        } else if (!admission.answer) {
            check_problem(admission.admitted.error());
        }
    }
    check_body(text);
    return 0;
}
