// What a run makes of the line to its printer, and when noise ends a job.
#include "daemon/line_use.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace linefeed::daemon {
namespace {

using feeder::OutcomeCode;
using testing::HasSubstr;
using testing::Not;

link::PrinterAddress address(const char* text) {
    return link::parse_printer_address(text).value();
}

RunProgress printed(std::uint32_t through, double rate) {
    RunProgress progress;
    progress.range = RecordRange::closed(RecordNumber{101}, RecordNumber{999});
    progress.printed_through = RecordNumber{through};
    progress.rate_per_s = rate;
    progress.fifo_depth = 256;
    return progress;
}

constexpr feeder::Outcome noise{.code = OutcomeCode::line_noise};

TEST(LineUse, shouldKnowHowLongRecordsAre) {
    spool::Job job;
    EXPECT_EQ(record_bytes(job), 40U) << "a guess";
    job.records = RecordRange::closed(RecordNumber{1}, RecordNumber{10});
    job.frame_bytes = 250;
    EXPECT_EQ(record_bytes(job), 25U);
}

TEST(LineUse, shouldFitTheRunToASerialLine) {
    JobRunSettings settings;
    use_line(settings, address("serial:///dev/ttyUSB0?baud=9600&crc=on"), {}, 40);
    EXPECT_TRUE(settings.session.line.crc);
    EXPECT_DOUBLE_EQ(settings.session.line.bytes_per_second, 960.0);
    EXPECT_EQ(settings.session.feeder.pacing.most_inquiries, 1);
}

TEST(LineUse, shouldSayWhatASerialLineCarries) {
    EXPECT_EQ(line_words(address("tcp://printer"), 40), "");
    const std::string plain = line_words(address("serial:///dev/ttyUSB0?baud=9600"), 40);
    EXPECT_THAT(plain, HasSubstr("about 19 records a second (9600 baud, records of 40 bytes, not secured)"));
    EXPECT_THAT(plain, HasSubstr("Without crc=on"));
    EXPECT_THAT(line_words(address("serial:///dev/ttyUSB0?crc=on"), 40), Not(HasSubstr("Without crc=on")));
    EXPECT_THAT(line_words(address("serial:///dev/ttyUSB0?baud=1200"), 2000), HasSubstr("carries less than 1 records"));
}

TEST(LineUse, shouldSayWhereASerialLineCarriesTooLittle) {
    const auto slow = address("serial:///dev/ttyUSB0?baud=9600");
    EXPECT_FALSE(shortfall(slow, 40, 19));
    EXPECT_EQ(shortfall(slow, 40, 20)->words, "the conveyor is to bring 20 products a second, and the serial line "
                                              "carries about 19: the printer will run dry and stop");
    EXPECT_THAT(shortfall(slow, 40, 20)->advice, HasSubstr("raise the baud rate"));
    EXPECT_THAT(shortfall(address("serial:///dev/ttyUSB0?baud=1200"), 2000, 1)->words,
                HasSubstr("carries less than 1:"));
    EXPECT_FALSE(shortfall(address("tcp://printer"), 40, 10'000));
}

TEST(NoisePatience, shouldChangeNothingAfterAnyOtherRun) {
    NoisePatience patience;
    JobRunSettings settings;
    for (const OutcomeCode code : {OutcomeCode::finished, OutcomeCode::stop_requested, OutcomeCode::nothing_to_print}) {
        EXPECT_FALSE(patience.goes_on({.code = code}, printed(500, 100), settings));
    }
    EXPECT_EQ(settings.session.feeder.level_at_most, feeder::FeederSettings{}.level_at_most);
}

TEST(NoisePatience, shouldKeepLittleInTheFifoOfABadLine) {
    NoisePatience patience;
    JobRunSettings settings;
    EXPECT_TRUE(patience.goes_on(noise, printed(200, 10), settings));
    EXPECT_EQ(settings.session.feeder.level_at_most, RecordCount{128});
    for (int i = 0; i < 5; ++i) {
        EXPECT_TRUE(patience.goes_on(noise, printed(200, 0), settings));
    }
    EXPECT_EQ(settings.session.feeder.level_at_most, RecordCount{20}) << "two seconds at the rate that it had";
}

TEST(NoisePatience, shouldNotGoOnForEverWithoutAPrint) {
    NoisePatience patience;
    JobRunSettings settings;
    for (int i = 1; i < NoisePatience::runs_without_print; ++i) {
        ASSERT_TRUE(patience.goes_on(noise, printed(100, 0), settings)) << i;
    }
    EXPECT_TRUE(patience.goes_on(noise, printed(101, 0), settings)) << "a print: it counts anew";
    for (int i = 1; i < NoisePatience::runs_without_print; ++i) {
        ASSERT_TRUE(patience.goes_on(noise, printed(100, 0), settings)) << i;
    }
    EXPECT_FALSE(patience.goes_on(noise, printed(100, 0), settings));
}

} // namespace
} // namespace linefeed::daemon
