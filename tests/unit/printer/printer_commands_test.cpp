// Acknowledging one error and no other; and the panel, held and always released.
#include "printer/printer_commands.hpp"
#include "support/peer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <optional>
#include <vector>

namespace linefeed::printer {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

std::string status(std::int32_t error) {
    return "^0=RS2\t5\t" + std::to_string(error) + "\t0\t9\t1\r";
}

/// A printer that shows errors one after the other, each until it is acknowledged.
class ErrorsTest : public testing::Test {
protected:
    void show(const std::vector<std::int32_t>& errors, bool stubborn = false) {
        peer_.emplace([errors = errors, stubborn](std::string_view frame) mutable {
            if (frame == "^0!EQ" && !stubborn && !errors.empty()) {
                errors.erase(errors.begin());
            }
            return Peer::Reaction{frame == "^0?RS" ? status(errors.empty() ? 0 : errors.front()) : ""};
        });
    }
    std::optional<Peer> peer_;
};

TEST_F(ErrorsTest, shouldAcknowledgeTheErrorThatIsShown) {
    show({10202});
    EXPECT_EQ(acknowledge(peer_->settings(), 10202).value().raw, 0);
    EXPECT_THAT(peer_->heard(), HasSubstr("^0?RS\n^0!EQ\n^0?RS\n"));
}

TEST_F(ErrorsTest, shouldTellWhatStoodBehindIt) {
    show({51001 | 1 << 24, 10202}); // some firmware sets bit 24
    EXPECT_EQ(acknowledge(peer_->settings(), 51001).value().code(), 10202U);
}

TEST_F(ErrorsTest, shouldNotAcknowledgeAnotherError) {
    show({10202});
    const auto refused = acknowledge(peer_->settings(), 51001);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, FailureKind::stopped);
    EXPECT_THAT(refused.error().message, HasSubstr("error 51001 is not what the printer shows: 10202 (battery low)"));
    EXPECT_THAT(peer_->heard(), Not(HasSubstr("!EQ")));
}

TEST_F(ErrorsTest, shouldNotAcknowledgeWhereThereIsNoError) {
    show({});
    const auto refused = acknowledge(peer_->settings(), 0);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, FailureKind::stopped);
    EXPECT_THAT(refused.error().message, HasSubstr("no error"));
    EXPECT_THAT(peer_->heard(), Not(HasSubstr("!EQ")));
}

TEST_F(ErrorsTest, shouldSayThatTheCauseHasNotGone) {
    show({10202}, true);
    const auto result = acknowledge(peer_->settings(), 10202);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().kind, FailureKind::stopped);
    EXPECT_THAT(result.error().message, HasSubstr("still shows error 10202"));
    EXPECT_EQ(peer_->heard().find("!EQ"), peer_->heard().rfind("!EQ")) << "once";
}

TEST(Acknowledge, shouldSayThatThePrinterDoesNotAnswer) {
    Peer silent{[](std::string_view) { return Peer::Reaction{}; }};
    EXPECT_EQ(acknowledge(silent.settings(), 1).error().kind, FailureKind::unreachable);
}

class PanelTest : public testing::Test {
protected:
    static constexpr auto repeat = milliseconds{50};

    std::atomic<bool> silent_{false};
    Peer peer_{
        [this](std::string_view frame) { return Peer::Reaction{frame == "^0?RS" && !silent_ ? status(0) : ""}; }};

    std::size_t times(std::string_view command) {
        const std::string heard = peer_.heard();
        std::size_t count = 0;
        for (std::size_t at = heard.find(command); at != std::string::npos; at = heard.find(command, at + 1)) {
            ++count;
        }
        return count;
    }
    template <typename Condition>
    static bool comes_true(const Condition& condition) {
        const auto deadline = std::chrono::steady_clock::now() + seconds{20};
        while (!condition() && std::chrono::steady_clock::now() < deadline) {
            std::this_thread::sleep_for(milliseconds{5});
        }
        return condition();
    }
};

TEST_F(PanelTest, shouldRepeatUntilItIsTakenBack) {
    PanelHold panel{peer_.settings(), repeat};
    EXPECT_FALSE(panel.held());
    ASSERT_TRUE(panel.hold(seconds{60}));
    EXPECT_TRUE(panel.held());
    EXPECT_EQ(times("^0!US"), 1U);
    EXPECT_TRUE(comes_true([&] { return times("^0!US") >= 4; }));
    EXPECT_EQ(peer_.connections(), 1);
    panel.release();
    EXPECT_FALSE(panel.held());
    EXPECT_EQ(times("^0!UR"), 1U);
    const std::size_t before = times("^0!US");
    std::this_thread::sleep_for(4 * repeat);
    EXPECT_EQ(times("^0!US"), before);
    panel.release(); // nothing to do
    EXPECT_EQ(times("^0!UR"), 1U);
}

TEST_F(PanelTest, shouldReleaseWhenNobodyAsksAgain) {
    PanelHold panel{peer_.settings(), repeat};
    ASSERT_TRUE(panel.hold(milliseconds{120}));
    EXPECT_TRUE(comes_true([&] { return times("^0!UR") == 1; }));
    EXPECT_FALSE(panel.held());
    EXPECT_GE(times("^0!US"), 2U);
    ASSERT_TRUE(panel.hold(seconds{60})); // and again
    EXPECT_TRUE(panel.held());
}

TEST_F(PanelTest, shouldReleaseWhenTheServiceEnds) {
    {
        PanelHold panel{peer_.settings(), repeat};
        ASSERT_TRUE(panel.hold(seconds{60}));
    }
    EXPECT_EQ(times("^0!UR"), 1U);
}

TEST_F(PanelTest, shouldGoOnOnANewConnection) {
    PanelHold panel{peer_.settings(), repeat};
    ASSERT_TRUE(panel.hold(seconds{60}));
    peer_.cut();
    const std::size_t before = times("^0!US");
    EXPECT_TRUE(comes_true([&] { return times("^0!US") >= before + 2; }));
    EXPECT_TRUE(comes_true([&] { return panel.held(); }));
    EXPECT_EQ(peer_.connections(), 2);
    peer_.cut();
    panel.release();
    EXPECT_GE(times("^0!UR"), 1U) << "also where the connection has just been lost";
}

TEST_F(PanelTest, shouldReleaseAPrinterThatDoesNotAnswer) {
    silent_ = true;
    PanelHold panel{peer_.settings(), repeat};
    const auto held = panel.hold(seconds{60});
    ASSERT_FALSE(held);
    EXPECT_EQ(held.error().kind, FailureKind::unreachable);
    EXPECT_FALSE(panel.held());
    EXPECT_EQ(times("^0!US"), 1U);
    EXPECT_TRUE(comes_true([&] { return times("^0!UR") >= 1; })) << "it may have heard";
}

TEST_F(PanelTest, shouldNotClaimToHoldAPrinterThatAnswersNoMore) {
    PanelHold panel{peer_.settings(), repeat};
    ASSERT_TRUE(panel.hold(seconds{60}));
    silent_ = true;
    EXPECT_TRUE(comes_true([&] { return !panel.held(); }));
    silent_ = false;
    EXPECT_TRUE(comes_true([&] { return panel.held(); }));
}

TEST(PanelHold, shouldSayThatThereIsNoPrinter) {
    ClientSettings nobody = client_of(1);
    PanelHold panel{nobody};
    EXPECT_EQ(panel.hold(seconds{1}).error().kind, FailureKind::unreachable);
    panel.release();
}

} // namespace
} // namespace linefeed::printer
