// Who was refused leaves a trace, and nobody can fill the disk with them.
#include "api/request_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace linefeed::api {
namespace {

using config::LogLevel;
using testing::HasSubstr;
using testing::IsEmpty;

AccessRecord request(int status, std::string target = "/api/v1/jobs") {
    return {"10.0.0.7", "token anna", "POST", std::move(target), status, 0, {}};
}

constexpr Instant start{std::chrono::hours{5}};

TEST(RequestLog, NamesWhoWasRefusedAndWhatHeWanted) {
    RequestLog log;
    for (const int status : {401, 403, 500, 503}) {
        const auto lines = log.take(request(status), start);
        ASSERT_EQ(lines.size(), 1U);
        EXPECT_EQ(lines[0].level, LogLevel::warning);
        EXPECT_EQ(lines[0].text, "POST /api/v1/jobs: " + std::to_string(status) + ", from 10.0.0.7 as token anna");
    }
    for (const int status : {200, 404, 409, 422, 429}) {
        const auto lines = log.take(request(status), start);
        ASSERT_EQ(lines.size(), 1U);
        EXPECT_EQ(lines[0].level, LogLevel::debug);
    }
}

TEST(RequestLog, LeavesLittleOfAFloodAndSaysHowMuchItWas) {
    RequestLog log;
    std::size_t written = 0;
    for (int k = 0; k < 100'000; ++k) {
        written += log.take(request(401), start + std::chrono::microseconds{k}).size();
    }
    EXPECT_EQ(written, RequestLog::lines_a_minute);
    const auto lines = log.take(request(403), start + std::chrono::minutes{1});
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_EQ(lines[0].text, "99980 more requests were refused for want of rights before that");
    EXPECT_THAT(lines[1].text, HasSubstr("403"));
    EXPECT_EQ(log.take(request(401), start + std::chrono::minutes{2}).size(), 1U);
}

TEST(RequestLog, DoesNotHideTheRefusedBehindFailures) {
    RequestLog log;
    for (std::uint32_t k = 0; k <= RequestLog::lines_a_minute; ++k) {
        static_cast<void>(log.take(request(503), start));
    }
    EXPECT_THAT(log.take(request(503), start), IsEmpty());
    EXPECT_EQ(log.take(request(401), start).size(), 1U);
}

TEST(RequestLog, ShowsTheBeginningOfALongTarget) {
    RequestLog log;
    const auto lines = log.take(request(401, '/' + std::string(10'000, 'x')), start);
    EXPECT_LT(lines.front().text.size(), 300U);
}

} // namespace
} // namespace linefeed::api
