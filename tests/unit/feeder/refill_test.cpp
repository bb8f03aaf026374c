// What may go to the printer now: never beyond its depth, never beyond what is durable or at hand.
#include "feeder/refill.hpp"

#include <gtest/gtest.h>

#include <random>

namespace linefeed::feeder {
namespace {

RecordNumber no(std::uint32_t value) {
    return RecordNumber{value};
}
RecordRange records(std::uint32_t first, std::uint32_t last) {
    return RecordRange::closed(no(first), no(last));
}

Refill begun(RecordRange range, std::uint64_t depth) {
    Refill refill;
    refill.begin(range, RecordCount{depth});
    return refill;
}

/// With everything at hand and durable.
Refill stocked(RecordRange range, std::uint64_t depth) {
    Refill refill = begun(range, depth);
    refill.supplied(range.last());
    refill.durable(range.last());
    return refill;
}

class RefillDepth : public testing::TestWithParam<std::uint32_t> {};
INSTANTIATE_TEST_SUITE_P(Depths, RefillDepth, testing::Values(1U, 3U, 16U, 256U));

TEST_P(RefillDepth, shouldSendOneDepthAndThenOnlyWhatWasPrinted) {
    const std::uint32_t depth = GetParam();
    Refill refill = stocked(records(1, 5000), depth);
    EXPECT_EQ(refill.take(), records(1, depth));
    EXPECT_EQ(refill.take(), RecordRange{});
    EXPECT_EQ(refill.ready(), RecordCount{0});

    EXPECT_TRUE(refill.printed(no(1)));
    EXPECT_EQ(refill.level(), RecordCount{depth - 1});
    EXPECT_EQ(refill.take(), records(depth + 1, depth + 1));
    EXPECT_EQ(refill.take(), RecordRange{});
}

TEST_P(RefillDepth, shouldRefillAWholeDepthWhenAllSentWasPrinted) {
    const std::uint32_t depth = GetParam();
    Refill refill = stocked(records(1, 5000), depth);
    static_cast<void>(refill.take());
    EXPECT_TRUE(refill.printed(no(depth)));
    EXPECT_EQ(refill.take(), records(depth + 1, 2 * depth));
}

TEST_P(RefillDepth, shouldCallTheFirstFillReadyWithAWholeDepth) {
    const std::uint32_t depth = GetParam();
    Refill refill = begun(records(1, 5000), depth);
    refill.durable(no(5000));
    refill.supplied(no(depth - 1));
    EXPECT_FALSE(refill.first_fill_ready());
    refill.supplied(no(depth));
    EXPECT_TRUE(refill.first_fill_ready());
}

TEST(Refill, shouldCallTheFirstFillReadyWithTheWholeRest) {
    Refill refill = begun(records(11, 13), 256);
    refill.durable(no(13));
    refill.supplied(no(12));
    EXPECT_FALSE(refill.first_fill_ready());
    refill.supplied(no(13));
    EXPECT_TRUE(refill.first_fill_ready());
}

TEST(Refill, shouldStartADeepFifoWithWhatIsSurelyAtHand) {
    Refill refill = begun(records(1, 10000), 4000);
    refill.durable(no(10000));
    refill.supplied(no(255));
    EXPECT_FALSE(refill.first_fill_ready());
    refill.supplied(no(256));
    EXPECT_TRUE(refill.first_fill_ready());
}

TEST(Refill, shouldSendNothingThatIsNotDurable) {
    Refill refill = begun(records(1, 100), 16);
    refill.supplied(no(100));
    EXPECT_EQ(refill.take(), RecordRange{});
    refill.durable(no(5));
    EXPECT_EQ(refill.take(), records(1, 5));
    EXPECT_EQ(refill.take(), RecordRange{});
    refill.durable(no(4)); // an older answer changes nothing
    EXPECT_EQ(refill.take(), RecordRange{});
    refill.durable(no(50));
    EXPECT_EQ(refill.take(), records(6, 16));
}

TEST(Refill, shouldSendNothingThatIsNotAtHand) {
    Refill refill = begun(records(1, 100), 16);
    refill.durable(no(100));
    EXPECT_EQ(refill.take(), RecordRange{});
    refill.supplied(no(5));
    EXPECT_EQ(refill.take(), records(1, 5));
    refill.supplied(no(3));
    EXPECT_EQ(refill.take(), RecordRange{});
    refill.supplied(no(7));
    EXPECT_EQ(refill.take(), records(6, 7));
}

TEST(Refill, shouldIgnoreSupplyAndIntentsBehindTheLastRecord) {
    Refill refill = begun(records(1, 10), 256);
    refill.supplied(no(512));
    refill.durable(no(512));
    EXPECT_EQ(refill.take(), records(1, 10));
    EXPECT_TRUE(refill.all_sent());
    EXPECT_EQ(refill.ready(), RecordCount{0});
}

TEST(Refill, shouldMakeTheCreditSmallerAndNeverLargerWithAStaleReport) {
    Refill refill = stocked(records(1, 100), 10);
    static_cast<void>(refill.take());
    EXPECT_TRUE(refill.printed(no(6)));
    EXPECT_TRUE(refill.printed(no(6))); // the same report once more gives nothing
    EXPECT_EQ(refill.take(), records(11, 16));
    EXPECT_TRUE(refill.printed(no(6)));
    EXPECT_EQ(refill.take(), RecordRange{});
}

TEST(Refill, shouldRefuseImpossibleReports) {
    Refill refill = stocked(records(11, 100), 10);
    EXPECT_FALSE(refill.printed(no(11))) << "nothing has been sent";
    static_cast<void>(refill.take());
    EXPECT_FALSE(refill.printed(no(21))) << "never sent";
    EXPECT_FALSE(refill.printed(no(9))) << "before the run";
    EXPECT_TRUE(refill.printed(no(15)));
    EXPECT_FALSE(refill.printed(no(14))) << "goes back";
    EXPECT_EQ(refill.printed_through(), no(15));
    EXPECT_EQ(refill.level(), RecordCount{5});
}

TEST(Refill, shouldTakeTheNumberBeforeTheFirstAsNothingPrinted) {
    Refill refill = stocked(records(11, 100), 10);
    static_cast<void>(refill.take());
    EXPECT_TRUE(refill.printed(no(10)));
    EXPECT_EQ(refill.level(), RecordCount{10});
}

TEST(Refill, shouldAskForIntentsWellBeforeTheyAreUsedUp) {
    Refill refill = begun(records(1, 100000), 100);
    refill.supplied(no(100000));
    refill.durable(no(512));
    EXPECT_EQ(refill.next_intent(), std::nullopt) << "more than two depths ahead";
    static_cast<void>(refill.take());
    ASSERT_TRUE(refill.printed(no(100)));
    static_cast<void>(refill.take()); // 101-200
    ASSERT_TRUE(refill.printed(no(200)));
    static_cast<void>(refill.take()); // 201-300
    EXPECT_EQ(refill.next_intent(), std::nullopt) << "still more than two depths ahead";
    ASSERT_TRUE(refill.printed(no(300)));
    static_cast<void>(refill.take()); // 301-400
    EXPECT_EQ(refill.next_intent(), no(800)) << "four depths ahead of 400";
    EXPECT_EQ(refill.next_intent(), std::nullopt) << "asked already";
}

TEST(Refill, shouldNotAskForIntentsBehindTheLastRecord) {
    Refill refill = begun(records(1, 300), 100);
    EXPECT_EQ(refill.next_intent(), no(300));
    EXPECT_EQ(refill.next_intent(), std::nullopt);
    refill.durable(no(300));
    EXPECT_EQ(refill.next_intent(), std::nullopt);
}

TEST(Refill, shouldWorkAtTheUpperEndOf32Bits) {
    constexpr std::uint32_t max = 4294967295U;
    Refill refill = begun(records(max - 4, max), 3);
    EXPECT_EQ(refill.next_intent(), no(max));
    refill.durable(no(max));
    refill.supplied(no(max));
    EXPECT_EQ(refill.take(), records(max - 4, max - 2));
    EXPECT_TRUE(refill.printed(no(max - 2)));
    EXPECT_EQ(refill.take(), records(max - 1, max));
    EXPECT_TRUE(refill.all_sent());
    EXPECT_TRUE(refill.printed(no(max)));
    EXPECT_EQ(refill.level(), RecordCount{0});
    EXPECT_EQ(refill.take(), RecordRange{});
    EXPECT_EQ(refill.next_intent(), std::nullopt);
}

TEST(Refill, shouldTakeADepthOf32Bits) {
    Refill refill = stocked(records(1, 4294967295U), 4294967295U);
    EXPECT_EQ(refill.take(), records(1, 4294967295U));
    EXPECT_TRUE(refill.all_sent());
}

/// Random facts, possible and impossible, against bounds that are kept apart from the class under test.
TEST(Refill, shouldKeepItsBoundsUnderRandomFacts) {
    for (std::uint32_t seed = 1; seed <= 300; ++seed) {
        std::mt19937 random{seed};
        const auto draw = [&random](std::uint32_t low, std::uint32_t high) {
            return low + static_cast<std::uint32_t>(random() % (std::uint64_t{high} - low + 1));
        };
        const std::uint32_t depth = draw(1, 300);
        const std::uint32_t count = draw(1, 2000);
        const std::uint32_t first = seed % 2 == 0 ? draw(1, 100000) : 4294967295U - count + 1;
        const std::uint32_t last = first + (count - 1);
        Refill refill = begun(records(first, last), depth);
        std::uint32_t sent = first - 1;
        std::uint32_t printed = first - 1;
        std::uint32_t durable = first - 1;
        std::uint32_t supplied = first - 1;
        std::uint32_t asked = first - 1;
        for (int step = 0; step < 400; ++step) {
            SCOPED_TRACE(testing::Message() << "seed " << seed << ", step " << step);
            const std::uint32_t number = draw(first - 1, last);
            switch (draw(0, 4)) {
            case 0:
                refill.supplied(no(number));
                supplied = std::max(supplied, number);
                break;
            case 1:
                refill.durable(no(number));
                durable = std::max(durable, number);
                break;
            case 2: {
                const std::uint32_t report = draw(0, 3) == 0 ? number : draw(printed, sent);
                const bool possible = report >= printed && report <= sent;
                ASSERT_EQ(refill.printed(no(report)), possible);
                printed = possible ? report : printed;
                break;
            }
            case 3: {
                const RecordRange taken = refill.take();
                if (!taken.empty()) {
                    ASSERT_EQ(taken.first().value(), sent + 1);
                    sent = taken.last().value();
                }
                ASSERT_LE(sent, std::min({durable, supplied, last}));
                ASSERT_LE(sent - printed, depth);
                ASSERT_EQ(refill.ready(), RecordCount{0}) << "it takes all that may go";
                const bool bounded = sent == last || sent == durable || sent == supplied || sent - printed == depth;
                ASSERT_TRUE(bounded) << "it holds nothing back";
                break;
            }
            case 4:
                if (const auto intent = refill.next_intent()) {
                    ASSERT_GT(intent->value(), std::max(asked, durable));
                    ASSERT_LE(intent->value(), last);
                    asked = intent->value();
                }
                // Whatever may be sent next is durable or has been asked for.
                ASSERT_GE(std::max(asked, durable), std::min<std::uint64_t>(last, std::uint64_t{sent} + depth));
                break;
            }
            ASSERT_EQ(refill.sent_through().value(), sent);
            ASSERT_EQ(refill.printed_through().value(), printed);
        }
    }
}

} // namespace
} // namespace linefeed::feeder
