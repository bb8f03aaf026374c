#include "api/request_log.hpp"

#include <string_view>

namespace linefeed::api {

namespace {

using config::LogLevel;

constexpr int unauthorized = 401;
constexpr int forbidden = 403;
constexpr int first_failure = 500;

std::string shortened(std::string_view text) {
    return text.size() <= RequestLog::longest_target ? std::string{text}
                                                     : std::string{text.substr(0, RequestLog::longest_target)} + "...";
}

std::string words_of(const AccessRecord& request) {
    return shortened(request.method) + ' ' + shortened(request.target) + ": " + std::to_string(request.status) +
           ", from " + request.peer + (request.caller.empty() ? "" : " as " + request.caller);
}

} // namespace

std::vector<RequestLog::Line> RequestLog::take(const AccessRecord& request, Instant now) {
    const bool refused = request.status == unauthorized || request.status == forbidden;
    if (!refused && request.status < first_failure) {
        return {{LogLevel::debug, words_of(request)}};
    }
    const auto held_back = (refused ? refused_ : failed_).take(now);
    if (!held_back) {
        return {};
    }
    std::vector<Line> lines;
    if (*held_back > 0) {
        lines.push_back({LogLevel::warning, std::to_string(*held_back) + " more requests were " +
                                                (refused ? "refused for want of rights" : "not served") +
                                                " before that"});
    }
    lines.push_back({LogLevel::warning, words_of(request)});
    return lines;
}

} // namespace linefeed::api
