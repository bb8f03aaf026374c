// Conversations in files: any bytes come back as they were, and what is said again is compared.
#include "printer/conversation.hpp"
#include "printer/message_json.hpp"
#include "support/peer.hpp"

#include <gtest/gtest.h>

namespace linefeed::printer {
namespace {

std::vector<SpokenFrame> frames_of(const std::vector<Utterance>& utterances) {
    FrameFinder finder{protocol::EscapeMode::backslash};
    std::vector<SpokenFrame> frames;
    for (const Utterance& utterance : utterances) {
        finder.add(utterance, [&frames](const SpokenFrame& frame) { frames.push_back(frame); });
    }
    return frames;
}

Utterance said(bool sent, std::string bytes) {
    const std::size_t size = bytes.size();
    return {1, sent, std::move(bytes), size};
}

TEST(EscapedBytes, shouldGiveEveryByteBack) {
    std::string all;
    for (int i = 0; i < 256; ++i) {
        all.push_back(static_cast<char>(i));
    }
    EXPECT_EQ(unescaped_bytes(escaped_bytes(all)), all);
    for (const char* wrong : {"\\", "\\q", "\\x", "\\x1", "\\xG0"}) {
        EXPECT_EQ(unescaped_bytes(wrong), std::nullopt) << wrong;
    }
    EXPECT_EQ(unescaped_bytes("\\x4a\\t\\\\"), "J\t\\");
}

TEST(Conversation, shouldComeBackFromItsLine) {
    const Utterance utterance{1'700'000'000'000'000'000, true, "^0=MR1\t\xFF\x00x\r", 500};
    EXPECT_EQ(read_line(to_line(utterance)).value(), utterance);
    EXPECT_EQ(read_line(to_line(said(false, "^0=RS"))).value(), said(false, "^0=RS"));
    for (const char* wrong : {"", "{}", "[]", R"({"time_ns":1,"direction":"up","bytes":""})",
                              R"({"time_ns":1,"direction":"sent","bytes":"\\q"})"}) {
        EXPECT_FALSE(read_line(wrong)) << wrong;
    }
}

TEST(Conversation, shouldFindFramesHoweverTheyWereSplit) {
    const auto frames =
        frames_of({said(false, "^0=SM256\t2"), said(true, "^0?RS\r"), said(false, "55\t0\t100000\t1\r")});
    ASSERT_EQ(frames.size(), 2U);
    EXPECT_EQ(frames[0].raw, "^0?RS");
    EXPECT_EQ(frames[1].raw, "^0=SM256\t255\t0\t100000\t1");
    EXPECT_EQ(in_words(frames[1].message),
              "mailing status: depth 256, entries 255, last printed 0, stop at 100000, last print finished yes");
}

TEST(Conversation, shouldShowTheBeginningOfWhatWasNotKept) {
    const auto frames = frames_of({{1, true, "^0=MR1\tabc", 600}, said(true, "^0?SM\r")});
    ASSERT_EQ(frames.size(), 2U);
    EXPECT_FALSE(frames[0].whole);
    EXPECT_TRUE(frames[1].whole);
}

TEST(Conversation, shouldTellWhatIsAnsweredDifferentlyNow) {
    Peer peer{[](std::string_view frame) { return Peer::Reaction{frame == "^0?RS" ? "^0=RS2\t5\t0\t0\t9\t1\r" : ""}; }};
    const auto client = PrinterClient::connect(peer.settings()).value();
    const auto frames = frames_of({said(true, "^0!NO\r"), said(true, "^0?RS\r"), said(false, "^0=RS2\t5\t0\t0\t9\t1\r"),
                                   said(true, "^0?RS\r"), said(false, "^0=RS2\t6\t0\t0\t9\t1\r"), said(true, "^0?SM\r"),
                                   said(false, "^0=SM256\t0\t0\t0\t1\r")});
    const auto rerun = say_again(*client, frames, [](Duration) {}).value();
    EXPECT_EQ(rerun.sent, 4U);
    EXPECT_EQ(rerun.compared, 3U);
    ASSERT_EQ(rerun.differences.size(), 2U);
    EXPECT_EQ(rerun.differences[0], (Difference{"^0?RS", "^0=RS2\t6\t0\t0\t9\t1", "^0=RS2\t5\t0\t0\t9\t1"}));
    EXPECT_EQ(rerun.differences[1], (Difference{"^0?SM", "^0=SM256\t0\t0\t0\t1", ""}));
    EXPECT_EQ(peer.heard(), "^0!NO\n^0?RS\n^0?RS\n^0?SM\n");
}

TEST(Conversation, shouldNotSayAgainWhatWasNotKept) {
    Peer peer{[](std::string_view) { return Peer::Reaction{}; }};
    const auto client = PrinterClient::connect(peer.settings()).value();
    const auto rerun = say_again(*client, frames_of({{1, true, "^0=MR1\tabc", 600}}), [](Duration) {});
    ASSERT_FALSE(rerun);
    EXPECT_EQ(rerun.error().kind, FailureKind::usage);
    EXPECT_EQ(peer.heard(), "");
}

} // namespace
} // namespace linefeed::printer
