#include "api/request_log.hpp"

#include <string_view>
#include <utility>

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
    std::vector<Line> lines;
    if (may_write(refused ? refused_ : failed_, now, lines)) {
        lines.push_back({LogLevel::warning, words_of(request)});
    }
    return lines;
}

/// Counts it. Behind a minute of which not all was written, `lines` says how much was not.
bool RequestLog::may_write(Kind& kind, Instant now, std::vector<Line>& lines) {
    if (kind.written == 0 || now - kind.since >= std::chrono::minutes{1}) {
        kind.since = now;
        kind.written = 0;
        if (const auto left_out = std::exchange(kind.left_out, 0U); left_out > 0) {
            lines.push_back(
                {LogLevel::warning, std::to_string(left_out) + " more requests were " + kind.words + " before that"});
        }
    }
    if (kind.written == lines_a_minute) {
        ++kind.left_out;
        return false;
    }
    ++kind.written;
    return true;
}

} // namespace linefeed::api
