// Dates of the printer: packed, short, and as the standard library counts.
#include "protocol/printer_time.hpp"

#include <gtest/gtest.h>

namespace linefeed::protocol {
namespace {

TEST(PrinterTime, shouldPackAsTheManualLaysOutTheBits) {
    // 2023-06-15 09:00:00: 23 << 26 | 6 << 22 | 15 << 17 | 9 << 12
    EXPECT_EQ(pack_date({2023, 6, 15, 9, 0, 0}), 1570672640U);
    const PrinterTime all_different{2041, 12, 31, 23, 58, 57};
    EXPECT_EQ(pack_date(all_different), 41U << 26U | 12U << 22U | 31U << 17U | 23U << 12U | 58U << 6U | 57U);
    EXPECT_EQ(unpack_date(pack_date(all_different)), all_different);
    EXPECT_EQ(unpack_date(0), (PrinterTime{2000, 0, 0, 0, 0, 0}));
}

TEST(PrinterTime, shouldReadAndWriteTheShortDate) {
    const PrinterTime time{2024, 5, 6, 7, 8, 9};
    EXPECT_EQ(read_short_date("24-05-06 07:08:09"), time);
    std::string out = ">";
    append_short_date(out, time);
    EXPECT_EQ(out, ">24-05-06 07:08:09");
    EXPECT_EQ(to_string(time), "2024-05-06 07:08:09");
    EXPECT_EQ(read_short_date("99-12-31 23:59:59")->year, 2099U);
    EXPECT_EQ(read_short_date("24-05-06 07:08::09"), time) << "as the manual writes it for the event list";
    EXPECT_EQ(read_short_date("00-00-00 00:00:00"), (PrinterTime{2000, 0, 0, 0, 0, 0})) << "a clock that was never set";
}

TEST(PrinterTime, shouldRefuseOtherTexts) {
    for (const char* const text : {"", "24-05-06", "24-05-06 07:08:9", "24-05-06 07:08:099", "24-05-06T07:08:09",
                                   "24-05-06 07::08:09", "24-05-06 07:08:::09", "24-05-06 07:08::",
                                   "2024-05-06 07:08:09", "-4-05-06 07:08:09", "24-05-06 07:08:09 "}) {
        EXPECT_EQ(read_short_date(text), std::nullopt) << text;
    }
}

TEST(PrinterTime, shouldKnowTheCalendar) {
    const auto leap_day = to_sys_seconds({2024, 2, 29, 23, 59, 58});
    ASSERT_TRUE(leap_day);
    EXPECT_EQ(to_printer_time(*leap_day), (PrinterTime{2024, 2, 29, 23, 59, 58}));
    EXPECT_EQ(to_printer_time(*leap_day + std::chrono::seconds{2}), (PrinterTime{2024, 3, 1, 0, 0, 0}));
    EXPECT_EQ(weekday_of(*leap_day), 4U) << "a Thursday";
    for (const PrinterTime wrong :
         {PrinterTime{2023, 2, 29, 0, 0, 0}, PrinterTime{2024, 0, 1, 0, 0, 0}, PrinterTime{2024, 13, 1, 0, 0, 0},
          PrinterTime{2024, 4, 31, 0, 0, 0}, PrinterTime{2024, 1, 32, 0, 0, 0}, PrinterTime{2024, 1, 1, 24, 0, 0},
          PrinterTime{2024, 1, 1, 0, 60, 0}, PrinterTime{2024, 1, 1, 0, 0, 60}, PrinterTime{40000, 1, 1, 0, 0, 0}}) {
        EXPECT_EQ(to_sys_seconds(wrong), std::nullopt) << to_string(wrong);
    }
}

} // namespace
} // namespace linefeed::protocol
