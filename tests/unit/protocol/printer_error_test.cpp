// The error number of `=RS` taken apart: the vector of the manual and those of the field notes.
#include "protocol/printer_error.hpp"

#include <gtest/gtest.h>

namespace linefeed::protocol {
namespace {

PrinterError error_of(std::uint32_t bits) {
    return {static_cast<std::int32_t>(bits)};
}

TEST(PrinterError, shouldAgreeWithTheVectorOfTheManual) {
    const PrinterError error{-1711274809};
    EXPECT_EQ(static_cast<std::uint32_t>(error.raw), 0x9A0004C7U);
    EXPECT_FALSE(error.none());
    EXPECT_EQ(error.code(), error_code::last_record_printed);
    EXPECT_EQ(error.code_without_bit_24(), 1223U);
    EXPECT_EQ(error.source(), ErrorSource::rip);
    EXPECT_EQ(error.display(), ErrorDisplay::message);
    EXPECT_EQ(error.tone(), ErrorTone::once);
    EXPECT_FALSE(error.switches_off());
    EXPECT_EQ(describe(error), "1223 (last data base entry printed), message from RIP");
}

TEST(PrinterError, shouldBeNoneForZero) {
    EXPECT_TRUE(PrinterError{}.none());
    EXPECT_EQ(describe(PrinterError{}), "no error");
}

TEST(PrinterError, shouldShowBothReadingsOfANumberWithBit24) {
    const PrinterError error{151045945};
    EXPECT_EQ(error.code(), 16828217U);
    EXPECT_EQ(error.code_without_bit_24(), 51001U);
    EXPECT_EQ(describe(error), "16828217 or, without bit 24, 51001 (camera double trigger), error from FEP");
}

TEST(PrinterError, shouldTellTheSources) {
    EXPECT_EQ(error_of(0U << 25U).source(), ErrorSource::fep);
    EXPECT_EQ(error_of(1U << 25U).source(), ErrorSource::rip);
    EXPECT_EQ(error_of(2U << 25U).source(), ErrorSource::sdc);
    EXPECT_EQ(error_of(3U << 25U).source(), ErrorSource::unknown);
}

TEST(PrinterError, shouldTellWhetherTheMachineSwitchesOff) {
    EXPECT_TRUE(error_of(0).switches_off());
    EXPECT_FALSE(error_of(1U << 27U).switches_off());
    EXPECT_TRUE(error_of(~(1U << 27U)).switches_off());
}

TEST(PrinterError, shouldTellTheTones) {
    EXPECT_EQ(error_of(0U << 28U).tone(), ErrorTone::permanent);
    EXPECT_EQ(error_of(1U << 28U).tone(), ErrorTone::once);
    EXPECT_EQ(error_of(2U << 28U).tone(), ErrorTone::none);
    EXPECT_EQ(error_of(3U << 28U).tone(), ErrorTone::unknown);
}

TEST(PrinterError, shouldTellTheWindows) {
    EXPECT_EQ(error_of(0U << 30U).display(), ErrorDisplay::error);
    EXPECT_EQ(error_of(1U << 30U).display(), ErrorDisplay::warning);
    EXPECT_EQ(error_of(2U << 30U).display(), ErrorDisplay::message);
    EXPECT_EQ(error_of(3U << 30U).display(), ErrorDisplay::unknown);
}

TEST(PrinterError, shouldDescribeEverySourceAndWindow) {
    EXPECT_EQ(describe(error_of(4711)), "4711, error from FEP");
    EXPECT_EQ(describe(error_of((1U << 30U) | (2U << 25U) | 4711)), "4711, warning from SDC");
    EXPECT_EQ(describe(error_of((3U << 30U) | (3U << 25U) | 4711)), "4711, notice from an unknown processor");
}

TEST(PrinterError, shouldKnowTheNumbersOfTheFieldNotes) {
    EXPECT_EQ(describe(error_of(1015)), "1015 (mailing buffer full), error from FEP");
    EXPECT_EQ(describe(error_of(1018)), "1018 (record number wrong or missing), error from FEP");
    EXPECT_EQ(describe(error_of(1019)), "1019 (record number not consecutive), error from FEP");
    EXPECT_EQ(describe(error_of(5043)), "5043 (mailing buffer empty), error from FEP");
    EXPECT_EQ(describe(error_of(10202)), "10202 (battery low), error from FEP");
    EXPECT_EQ(describe(error_of(51001)), "51001 (camera double trigger), error from FEP");
    EXPECT_EQ(describe(error_of(51009)), "51009 (camera double trigger), error from FEP");
}

} // namespace
} // namespace linefeed::protocol
