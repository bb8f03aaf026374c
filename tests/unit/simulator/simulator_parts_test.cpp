// What stands around the printer model: the ring of records, the conveyor's grid, the tape, the judgement of a run.
#include "simulator/conveyor.hpp"
#include "simulator/lead_time_log.hpp"
#include "simulator/mail_fifo.hpp"
#include "simulator/number_sequence.hpp"
#include "simulator/run_statistics.hpp"
#include "simulator/tape.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

namespace linefeed::simulator {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

TEST(MailFifo, shouldKeepOrderRoundItsEnd) {
    MailFifo fifo{3};
    std::uint32_t sent = 0;
    for (std::uint32_t printed = 1; printed <= 10; ++printed) {
        while (!fifo.full()) {
            fifo.push().number = RecordNumber{++sent};
        }
        ASSERT_EQ(fifo.loaded()->number, RecordNumber{printed});
        EXPECT_EQ(fifo.entries(), 2U);
        fifo.pop();
    }
    fifo.clear();
    EXPECT_EQ(fifo.loaded(), nullptr);
    EXPECT_EQ(fifo.entries(), 0U);
    EXPECT_TRUE(fifo.push().starts_sequence);
    EXPECT_FALSE(fifo.push().starts_sequence);
}

ConveyorSettings at_rate(double rate) {
    ConveyorSettings settings;
    settings.rate = rate;
    settings.start_delay = Duration::zero();
    return settings;
}

TEST(Conveyor, shouldHoldItsGridWhenThePlatformIsALittleLate) {
    Conveyor conveyor{at_rate(100)};
    EXPECT_EQ(conveyor.due(), std::nullopt);
    const Instant start{};
    conveyor.start(start);
    for (int step = 1; step <= 1000; ++step) {
        ASSERT_EQ(conveyor.due(), start + step * milliseconds{10}) << step;
        conveyor.passed(*conveyor.due() + microseconds{900});
    }
    EXPECT_EQ(conveyor.stalls(), 0U);
}

TEST(Conveyor, shouldHoldAFractionalRateWithoutDrift) {
    Conveyor conveyor{at_rate(1000.0 / 3.0)};
    conveyor.start(Instant{});
    for (int step = 1; step < 1000000; ++step) {
        conveyor.passed(*conveyor.due());
    }
    EXPECT_EQ(conveyor.due(), Instant{std::chrono::seconds{3000}});
}

TEST(Conveyor, shouldBeginANewGridAfterAStallInsteadOfBursting) {
    Conveyor conveyor{at_rate(100)};
    conveyor.start(Instant{});
    const Instant late = *conveyor.due() + milliseconds{25};
    EXPECT_TRUE(conveyor.stalled(late));
    conveyor.passed(late);
    EXPECT_EQ(conveyor.due(), late + milliseconds{10});
    EXPECT_EQ(conveyor.stalls(), 1U);
    EXPECT_EQ(conveyor.longest_stall(), milliseconds{25});
}

TEST(Conveyor, shouldMakeUpForADelayOfLessThanAPeriodAndNeverComeNearerThanHalf) {
    Conveyor conveyor{at_rate(100)};
    conveyor.start(Instant{});
    conveyor.passed(Instant{milliseconds{19}});
    EXPECT_EQ(conveyor.due(), Instant{milliseconds{24}});
    conveyor.passed(Instant{milliseconds{24}});
    EXPECT_EQ(conveyor.due(), Instant{milliseconds{30}});
}

TEST(Conveyor, shouldBringTheProductLaterWhenToldSo) {
    Conveyor conveyor{at_rate(100)};
    conveyor.start(Instant{});
    const Instant late = *conveyor.due() + milliseconds{5};
    conveyor.postpone(late, milliseconds{3});
    EXPECT_EQ(conveyor.due(), late + milliseconds{3});
    conveyor.passed(*conveyor.due());
    EXPECT_EQ(conveyor.due(), late + milliseconds{13});
    EXPECT_EQ(conveyor.stalls(), 1U);
}

TEST(Conveyor, shouldStandStillWithoutRateAndAfterAHalt) {
    Conveyor none{at_rate(0)};
    none.start(Instant{});
    EXPECT_EQ(none.due(), std::nullopt);
    Conveyor conveyor{at_rate(100)};
    conveyor.start(Instant{});
    conveyor.halt();
    EXPECT_EQ(conveyor.due(), std::nullopt);
    conveyor.start(Instant{milliseconds{500}});
    EXPECT_EQ(conveyor.due(), Instant{milliseconds{510}});
}

TEST(Conveyor, shouldWaitForTheLineToStart) {
    ConveyorSettings settings = at_rate(1000);
    settings.start_delay = milliseconds{20};
    Conveyor conveyor{settings};
    conveyor.start(Instant{});
    EXPECT_EQ(conveyor.due(), Instant{milliseconds{20}});
    conveyor.passed(*conveyor.due());
    EXPECT_EQ(conveyor.due(), Instant{milliseconds{21}});
}

TEST(Conveyor, shouldJitterAroundTheGridTheSameWayForTheSameSeed) {
    ConveyorSettings settings = at_rate(100);
    settings.jitter_percent = 30;
    settings.seed = 42;
    Conveyor first{settings};
    Conveyor second{settings};
    settings.seed = 43;
    Conveyor other{settings};
    for (Conveyor* conveyor : {&first, &second, &other}) {
        conveyor->start(Instant{});
    }
    bool differs = false;
    Duration widest{};
    Instant before{};
    for (int step = 1; step <= 1000; ++step) {
        ASSERT_EQ(first.due(), second.due());
        differs = differs || first.due() != other.due();
        const Duration off = *first.due() - (Instant{} + step * milliseconds{10});
        ASSERT_LE(off, milliseconds{3});
        ASSERT_GE(off, -milliseconds{3});
        ASSERT_GE(*first.due() - before, Conveyor::smallest_distance(settings));
        widest = std::max(widest, off);
        before = *first.due();
        for (Conveyor* conveyor : {&first, &second, &other}) {
            conveyor->passed(*conveyor->due());
        }
    }
    EXPECT_TRUE(differs);
    EXPECT_GT(widest, microseconds{2500});
}

TEST(TapeLine, shouldQuoteAsRfc4180Wants) {
    EXPECT_EQ(tape_line(5, RecordNumber{7}, "M\xC3\xBCller"), "5,7,M\xC3\xBCller\n");
    EXPECT_EQ(tape_line(5, RecordNumber{7}, "a\tb"), "5,7,a\tb\n");
    EXPECT_EQ(tape_line(5, RecordNumber{7}, "a,b"), "5,7,\"a,b\"\n");
    EXPECT_EQ(tape_line(5, RecordNumber{7}, "say \"x\""), "5,7,\"say \"\"x\"\"\"\n");
    EXPECT_EQ(tape_line(5, RecordNumber{7}, "a\nb"), "5,7,\"a\nb\"\n");
    EXPECT_EQ(tape_line(5, RecordNumber{7}, ""), "5,7,\n");
}

TEST(TapeText, shouldReadBytesAsTheFontDoes) {
    using protocol::Charset;
    EXPECT_EQ(to_utf8("M\xFCller\t\xDF", Charset::latin1), "M\xC3\xBCller\t\xC3\x9F");
    EXPECT_EQ(to_utf8("5 \x80", Charset::windows_1252), "5 \xE2\x82\xAC");
    EXPECT_EQ(to_utf8("00480065006C006C006F\t20AC\t", Charset::unicode_hex), "Hello\t\xE2\x82\xAC\t");
    EXPECT_EQ(to_utf8("Hello\t004\t00G0\t+048", Charset::unicode_hex), "Hello\t004\t00G0\t+048");
    EXPECT_EQ(to_utf8("D83D", Charset::unicode_hex), "\xEF\xBF\xBD");
}

TEST(Tape, shouldWriteLinesPromptlyAndEverythingAtClose) {
    const std::string path = testing::TempDir() + "linefeed_tape_test.csv";
    const auto content = [&path] {
        std::ifstream file{path};
        std::ostringstream all;
        all << file.rdbuf();
        return all.str();
    };
    auto tape = Tape::open(path);
    ASSERT_TRUE(tape);
    (*tape)->write("1,2,a\n");
    const std::string expected = "time_ns,number,text\n1,2,a\n";
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds{5};
    while (content() != expected && std::chrono::steady_clock::now() < deadline) {
        std::this_thread::sleep_for(milliseconds{1});
    }
    EXPECT_EQ(content(), expected);
    for (int line = 0; line < 1000; ++line) {
        (*tape)->write("3,4,b\n");
    }
    EXPECT_TRUE((*tape)->close());
    EXPECT_EQ(content().size(), expected.size() + 6000);
    std::filesystem::remove(path);
}

TEST(Tape, shouldSayWhyItCannotBeWritten) {
    const auto missing = Tape::open("/nonexistent/tape.csv");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().message, "cannot write the tape /nonexistent/tape.csv: No such file or directory");
    auto full = Tape::open("/dev/full");
    ASSERT_TRUE(full);
    (*full)->write("1,2,a\n");
    const auto closed = (*full)->close();
    ASSERT_FALSE(closed);
    EXPECT_EQ(closed.error().message, "the tape /dev/full is not complete: No space left on device");
}

TEST(NumberSequence, shouldFindDoublesAndGapsInAnyOrder) {
    NumberSequence numbers;
    for (const std::uint32_t number : {5U, 6U, 7U, 0U, 0U, 10U, 12U, 11U, 6U, 8U}) {
        numbers.add(RecordNumber{number});
    }
    EXPECT_EQ(numbers.doubles(), 1U);
    EXPECT_EQ(numbers.gaps(), 1U);
    EXPECT_EQ(numbers.missing(), 1U);
    EXPECT_EQ(numbers.smallest(), RecordNumber{5});
    EXPECT_EQ(numbers.largest(), RecordNumber{12});
    numbers.add(RecordNumber{9});
    EXPECT_EQ(numbers.gaps(), 0U);
    EXPECT_EQ(numbers.missing(), 0U);
    numbers.add(RecordNumber::max());
    numbers.add(RecordNumber::max());
    EXPECT_EQ(numbers.doubles(), 2U);
    EXPECT_EQ(numbers.missing(), 4294967295U - 13U);
}

TEST(NumberSequence, shouldBeWholeWhileNothingWasPrinted) {
    const NumberSequence numbers;
    EXPECT_EQ(numbers.missing(), 0U);
    EXPECT_EQ(numbers.gaps(), 0U);
}

TEST(LeadTimeLog, shouldLeaveOutTheFirstFillAndKnowItsQuantiles) {
    LeadTimeLog log{2, 16};
    EXPECT_EQ(log.quantile(0), std::nullopt);
    log.printed(Instant{milliseconds{1}}, milliseconds{1});
    log.printed(Instant{milliseconds{2}}, milliseconds{2});
    EXPECT_EQ(log.quantile(0), std::nullopt);
    for (const int lead : {50, 40, 30, 20}) {
        log.printed(Instant{milliseconds{100 - lead}}, milliseconds{lead});
    }
    EXPECT_EQ(log.prints(), 6U);
    EXPECT_EQ(log.quantile(0), Duration{milliseconds{20}});
    EXPECT_EQ(log.quantile(0.5), Duration{milliseconds{40}});
    EXPECT_EQ(log.quantile(1), Duration{milliseconds{50}});
    EXPECT_EQ(log.first_print(), Instant{milliseconds{1}});
    EXPECT_EQ(log.last_print(), Instant{milliseconds{80}});
}

TEST(LeadTimeLog, shouldTellAMissHowLateItsRecordWas) {
    LeadTimeLog log{0, 16};
    log.missed(Instant{milliseconds{10}}, Duration{7}, Instant{milliseconds{8}}); // too late, but there
    log.missed(Instant{milliseconds{20}}, Duration{0}, std::nullopt);
    log.missed(Instant{milliseconds{21}}, Duration{0}, std::nullopt);
    EXPECT_EQ(log.listed_misses().at(1).lead, std::nullopt);
    log.arrived(Instant{milliseconds{25}});
    log.arrived(Instant{milliseconds{30}}); // nobody waits any more
    EXPECT_EQ(log.misses(), 3U);
    EXPECT_EQ(log.listed_misses().at(0).late, Duration{7});
    EXPECT_EQ(log.listed_misses().at(0).lead, Duration{milliseconds{2}});
    EXPECT_EQ(log.listed_misses().at(1).lead, Duration{milliseconds{-5}});
    EXPECT_EQ(log.listed_misses().at(2).lead, Duration{milliseconds{-4}});
}

TEST(Conveyor, shouldKeepItsGridWhateverStalls) {
    ConveyorSettings settings;
    settings.rate = 1000;
    settings.start_delay = Duration::zero();
    settings.keeps_grid = true;
    Conveyor conveyor{settings};
    conveyor.start(Instant{});
    ASSERT_EQ(conveyor.due(), Instant{milliseconds{1}});
    conveyor.passed(Instant{milliseconds{6}}); // five periods late
    Instant last;
    for (int product = 0; product < 12; ++product) { // made up for at twice the rate
        last = *conveyor.due();
        conveyor.passed(last);
    }
    EXPECT_EQ(conveyor.due(), Instant{milliseconds{14}});
    EXPECT_EQ(last, Instant{milliseconds{13}});
}

TEST(RunStatistics, shouldTellTheRunInWordsAndAsJson) {
    RunStatistics run;
    run.depth = 256;
    run.add(Printed{Instant{}, RecordNumber{5}, "a", milliseconds{12}});
    run.add(Printed{Instant{}, RecordNumber{0}, "a", std::nullopt, PrintSource::last_record_again});
    run.add(Printed{Instant{}, RecordNumber{0}, "job", std::nullopt, PrintSource::job});
    run.add(Printed{Instant{}, RecordNumber{0}, "text", std::nullopt, PrintSource::extern_text});
    run.add(Underrun{Instant{}, milliseconds{2}});
    run.add(ErrorRaised{Instant{}, protocol::PrinterError{0x13000000 | 5043}});
    run.note_fill(17);
    std::ostringstream words;
    write_summary(words, run);
    EXPECT_THAT(words.str(), testing::HasSubstr("prints: 4 (numbers 5 to 5; printed again: 1; "
                                                "without a record: 2; broken off: 0)\n"));
    EXPECT_THAT(words.str(), testing::HasSubstr("errors: 5043 x 1\n"));
    EXPECT_THAT(words.str(), testing::HasSubstr("smallest lead time before a PrintGo: 2.000 ms\n"));
    EXPECT_THAT(words.str(), testing::HasSubstr("  10-20 ms: 1\n"));
    EXPECT_THAT(words.str(), testing::HasSubstr("highest fill: 17 of 256 records"));
    const std::string json = summary_json(run);
    EXPECT_THAT(json, testing::HasSubstr("\"errors\":{\"5043\":1}"));
    EXPECT_THAT(json, testing::HasSubstr("\"smallest_lead_ms\":2.0"));
    EXPECT_THAT(json, testing::HasSubstr("{\"count\":1,\"from_ms\":2.0,\"to_ms\":3.0}"));
    EXPECT_THAT(json, testing::HasSubstr("{\"count\":0,\"from_ms\":60000.0,\"to_ms\":null}"));
    EXPECT_THAT(json, testing::HasSubstr("\"lowest_fill\":null"));
    EXPECT_THAT(json, testing::HasSubstr("\"without_record\":2"));
}

} // namespace
} // namespace linefeed::simulator
