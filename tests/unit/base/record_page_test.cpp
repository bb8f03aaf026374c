// A refill is a slice of a page: exactly the frames of the numbers asked for.
#include "base/record_page.hpp"

#include <gtest/gtest.h>

namespace linefeed {
namespace {

RecordPage page_from_22118() {
    RecordPage page;
    page.first = RecordNumber{22118};
    for (const char* const frame : {"^0=MR22118\tMaier\r", "^0=MR22119\tMail\xE4nder\r", "^0=MR22120\tMalasse\r"}) {
        page.frames += frame;
        page.ends.push_back(static_cast<std::uint32_t>(page.frames.size()));
    }
    return page;
}

RecordRange range(std::uint32_t first, std::uint32_t last) {
    return RecordRange::closed(RecordNumber{first}, RecordNumber{last});
}

TEST(RecordPage, shouldKnowItsRange) {
    EXPECT_EQ(page_from_22118().range(), range(22118, 22120));
}

TEST(RecordPage, shouldSliceTheFirstTheMiddleAndTheLastRecord) {
    const RecordPage page = page_from_22118();
    EXPECT_EQ(page.slice(range(22118, 22118)), "^0=MR22118\tMaier\r");
    EXPECT_EQ(page.slice(range(22119, 22119)), "^0=MR22119\tMail\xE4nder\r");
    EXPECT_EQ(page.slice(range(22120, 22120)), "^0=MR22120\tMalasse\r");
}

TEST(RecordPage, shouldSliceSeveralAndAll) {
    const RecordPage page = page_from_22118();
    EXPECT_EQ(page.slice(range(22119, 22120)), "^0=MR22119\tMail\xE4nder\r^0=MR22120\tMalasse\r");
    EXPECT_EQ(page.slice(page.range()), page.frames);
}

TEST(RecordPage, shouldHaveAnEmptyRangeWithoutRecords) {
    EXPECT_TRUE(RecordPage{}.range().empty());
}

TEST(RecordPageDeathTest, shouldAbortOnNumbersItDoesNotHold) {
    const RecordPage page = page_from_22118();
    EXPECT_DEATH(static_cast<void>(page.slice(range(22117, 22118))), "contains");
    EXPECT_DEATH(static_cast<void>(page.slice(range(22120, 22121))), "contains");
}

} // namespace
} // namespace linefeed
