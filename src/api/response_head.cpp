#include "api/response_head.hpp"

#include <array>

namespace linefeed::api {

namespace {

struct Reason {
    int status;
    std::string_view words;
};

constexpr std::array reasons{
    Reason{200, "OK"},
    Reason{201, "Created"},
    Reason{202, "Accepted"},
    Reason{204, "No Content"},
    Reason{400, "Bad Request"},
    Reason{401, "Unauthorized"},
    Reason{403, "Forbidden"},
    Reason{404, "Not Found"},
    Reason{405, "Method Not Allowed"},
    Reason{406, "Not Acceptable"},
    Reason{408, "Request Timeout"},
    Reason{409, "Conflict"},
    Reason{411, "Length Required"},
    Reason{413, "Content Too Large"},
    Reason{415, "Unsupported Media Type"},
    Reason{417, "Expectation Failed"},
    Reason{421, "Misdirected Request"},
    Reason{422, "Unprocessable Content"},
    Reason{429, "Too Many Requests"},
    Reason{431, "Request Header Fields Too Large"},
    Reason{500, "Internal Server Error"},
    Reason{502, "Bad Gateway"},
    Reason{503, "Service Unavailable"},
    Reason{507, "Insufficient Storage"},
};

std::string_view reason(int status) {
    for (const Reason& candidate : reasons) {
        if (candidate.status == status) {
            return candidate.words;
        }
    }
    return "";
}

/// Nothing here is a page: not to be framed, guessed at, cached or read by other origins.
constexpr std::string_view of_every_answer = "Server: linefeed\r\n"
                                             "Cache-Control: no-store\r\n"
                                             "Content-Security-Policy: default-src 'none'; frame-ancestors 'none'\r\n"
                                             "Cross-Origin-Resource-Policy: same-origin\r\n"
                                             "Referrer-Policy: no-referrer\r\n"
                                             "X-Content-Type-Options: nosniff\r\n"
                                             "X-Frame-Options: DENY\r\n";

void add(std::string& head, std::string_view name, std::string_view value) {
    head.append(name).append(": ").append(value).append("\r\n");
}

void add_cors(std::string& head, const HeadOptions& options) {
    add(head, "Vary", "Origin");
    if (options.cors_origin.empty()) {
        return;
    }
    add(head, "Access-Control-Allow-Origin", options.cors_origin);
    if (options.preflight) {
        add(head, "Access-Control-Allow-Methods", "GET, HEAD, POST");
        add(head, "Access-Control-Allow-Headers", "Authorization, Content-Type, Idempotency-Key, Last-Event-ID");
        add(head, "Access-Control-Max-Age", "600");
    } else {
        add(head, "Access-Control-Expose-Headers", "Idempotency-Replayed, Location, Retry-After");
    }
}

} // namespace

std::string response_head(const Answer& answer, const HeadOptions& options) {
    std::string head = "HTTP/1.1 " + std::to_string(answer.status) + ' ';
    head.append(reason(answer.status)).append("\r\n").append(of_every_answer);
    add_cors(head, options);
    constexpr int no_content = 204;
    if (answer.status != no_content) {
        add(head, "Content-Type", answer.content_type);
        if (!options.stream) {
            add(head, "Content-Length", std::to_string(answer.body.size()));
        }
    }
    if (!answer.location.empty()) {
        add(head, "Location", answer.location);
    }
    if (!answer.allow.empty()) {
        add(head, "Allow", answer.allow);
    }
    if (answer.retry_after_s) {
        add(head, "Retry-After", std::to_string(*answer.retry_after_s));
    }
    if (answer.replayed) {
        add(head, "Idempotency-Replayed", "true");
    }
    constexpr int unauthorized = 401;
    if (answer.status == unauthorized) {
        add(head, "WWW-Authenticate", "Bearer realm=\"linefeed\"");
    }
    if (options.close || options.stream) {
        add(head, "Connection", "close");
    }
    return head + "\r\n";
}

} // namespace linefeed::api
