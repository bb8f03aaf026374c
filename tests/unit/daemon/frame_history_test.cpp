// The last frames of a conversation: how many, how much of each, in which order, and read while they are written.
#include "daemon/frame_history.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>

namespace linefeed::daemon {
namespace {

using std::chrono::seconds;

Instant now() {
    return Instant{std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch())};
}

std::int64_t wall_ns() {
    return std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch()).count();
}

RecordRange numbers(std::uint32_t first, std::uint32_t last) {
    return RecordRange::closed(RecordNumber{first}, RecordNumber{last});
}

TEST(FrameHistory, shouldHaveNothingAtFirst) {
    const FrameHistory history;
    EXPECT_TRUE(history.frames().empty());
    EXPECT_TRUE(history.kept().empty());
}

TEST(FrameHistory, shouldShowBothWaysInTheOrderOfTheConversation) {
    FrameHistory history;
    const Instant at = now();
    history.on_command_sent("^0?SM\r", at);
    history.on_frame_received("^0=SM256\t0\t0\t0\t1", at);
    history.on_records_sent(numbers(101, 150), "^0=MR101\tA\r", 550, at);
    history.on_damage_received(7, at);
    const auto frames = history.frames();
    ASSERT_EQ(frames.size(), 4U);
    EXPECT_EQ(frames[0].bytes, "^0?SM\r");
    EXPECT_TRUE(frames[0].sent);
    EXPECT_EQ(frames[0].size, 6U);
    EXPECT_TRUE(frames[0].records.empty());
    EXPECT_EQ(frames[1].bytes, "^0=SM256\t0\t0\t0\t1");
    EXPECT_FALSE(frames[1].sent);
    EXPECT_EQ(frames[1].size, frames[1].bytes.size() + 1) << "its CR counts";
    EXPECT_EQ(frames[2].bytes, "^0=MR101\tA\r");
    EXPECT_EQ(frames[2].size, 550U);
    EXPECT_EQ(frames[2].records, numbers(101, 150));
    EXPECT_EQ(frames[3].bytes, "");
    EXPECT_EQ(frames[3].size, 7U);
    EXPECT_FALSE(frames[3].sent);
}

TEST(FrameHistory, shouldShowWallTime) {
    FrameHistory history;
    history.on_command_sent("^0?SM\r", now() - seconds{60});
    const std::int64_t shown = history.frames().at(0).time_ns;
    const std::int64_t wanted = wall_ns() - Duration{seconds{60}}.count();
    EXPECT_LT(std::abs(shown - wanted), Duration{seconds{5}}.count());
}

TEST(FrameHistory, shouldKeepTheBeginningOfALongFrame) {
    FrameHistory history;
    std::string frame = "^0*";
    for (int i = 0; i < 1000; ++i) {
        frame += static_cast<char>('a' + i % 26);
    }
    history.on_frame_received(frame, now());
    const auto frames = history.frames();
    EXPECT_EQ(frames.at(0).bytes, frame.substr(0, FrameHistory::bytes_kept));
    EXPECT_EQ(frames.at(0).size, frame.size() + 1);
}

TEST(FrameHistory, shouldKeepAHundredEachWayWhateverComesTheOtherWay) {
    FrameHistory history;
    history.on_command_sent("^0!GO\r", now());
    for (int i = 0; i < 1000; ++i) {
        history.on_frame_received("^0=SM" + std::to_string(i), now());
    }
    const auto frames = history.frames();
    ASSERT_EQ(frames.size(), FrameHistory::frames_kept + 1);
    EXPECT_EQ(frames.front().bytes, "^0!GO\r");
    EXPECT_EQ(frames[1].bytes, "^0=SM900");
    EXPECT_EQ(frames.back().bytes, "^0=SM999");
}

TEST(FrameHistory, shouldNotLetARefillPushOutWhatCameBefore) {
    FrameHistory history;
    history.on_command_sent("^0!GO\r", now());
    for (std::uint32_t refill = 0; refill < FrameHistory::frames_kept - 1; ++refill) {
        history.on_records_sent(numbers(refill * 200 + 1, refill * 200 + 200), "^0=MR\r", 2000, now());
    }
    EXPECT_EQ(history.frames().front().bytes, "^0!GO\r");
    history.on_records_sent(numbers(1, 1), "^0=MR\r", 6, now());
    EXPECT_NE(history.frames().front().bytes, "^0!GO\r");
}

TEST(FrameHistory, shouldKeepThoseOfAnErrorUntilTheNext) {
    FrameHistory history;
    history.on_command_sent("^0!ST\r", now());
    history.keep();
    history.on_command_sent("^0!EQ\r", now());
    ASSERT_EQ(history.kept().size(), 1U);
    EXPECT_EQ(history.kept().front().bytes, "^0!ST\r");
    EXPECT_EQ(history.frames().size(), 2U);
    history.keep();
    EXPECT_EQ(history.kept().size(), 2U);
}

/// Every frame repeats its own number, so that two halves of different frames would show.
TEST(FrameHistory, shouldNeverShowHalfOfAFrame) {
    FrameHistory history;
    constexpr std::uint32_t frames = 200000;
    std::thread feed{[&] {
        for (std::uint32_t i = 1; i <= frames; ++i) {
            const std::string text(FrameHistory::bytes_kept, static_cast<char>('a' + i % 26));
            history.on_records_sent(numbers(i, i), text, i, Instant{Duration{i}});
        }
    }};
    std::uint32_t last = 0;
    std::size_t reads = 0;
    while (last < frames) {
        ++reads;
        std::uint32_t before = 0;
        for (const FrameView& frame : history.frames()) {
            const std::uint32_t number = frame.size;
            ASSERT_GT(number, before);
            ASSERT_EQ(frame.records, numbers(number, number));
            ASSERT_EQ(frame.bytes, std::string(FrameHistory::bytes_kept, static_cast<char>('a' + number % 26)));
            before = number;
        }
        last = std::max(last, before);
    }
    feed.join();
    EXPECT_EQ(history.frames().size(), FrameHistory::frames_kept);
    EXPECT_GT(reads, 1U);
}

} // namespace
} // namespace linefeed::daemon
