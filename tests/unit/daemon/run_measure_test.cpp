// What a run's effects and facts amount to in figures, with a real session in between where it decides something.
#include "../session/conversation.hpp"
#include "daemon/run_measure.hpp"

#include <gtest/gtest.h>

namespace linefeed::daemon {
namespace {

using feeder::OutcomeCode;
using session::Conversation;
using session::RecordsWritten;
using std::chrono::milliseconds;

RecordRange numbers(std::uint32_t first, std::uint32_t last) {
    return RecordRange::closed(RecordNumber{first}, RecordNumber{last});
}

std::string mail(std::uint32_t entries, std::uint32_t last_printed, std::uint32_t stop_at) {
    return "^0=SM256\t" + std::to_string(entries) + "\t" + std::to_string(last_printed) + "\t" +
           std::to_string(stop_at) + "\t1\r";
}

class RunMeasureTest : public testing::Test {
protected:
    void SetUp() override {
        host.print(pages);
        for (const RecordsWritten& fill : host.records_written) {
            measure.on_effect(fill, host.session.feeder());
        }
    }
    /// The printer reports, and the session's answer is written at once.
    void report(std::uint32_t printed) {
        host.records_written.clear();
        host.now += milliseconds{20};
        host.wake(); // asks
        const std::uint32_t held = host.session.feeder().refill().sent_through().value() - printed;
        const std::uint32_t entries = held - std::min(held, 1U); // one is loaded
        host.receive(mail(entries, printed, 1000));
        measure.on_fact(host.session, host.now);
        for (const RecordsWritten& refill : host.records_written) {
            measure.on_effect(refill, host.session.feeder());
        }
    }
    [[nodiscard]] std::uint64_t leads() const { return meters.lead_time.count_from(Duration::zero()); }

    std::vector<std::unique_ptr<RecordPage>> pages = session::make_pages(1, 1000, 100, session::plain_text);
    Conversation host;
    LineMeters meters;
    RunMeasure measure{meters, RecordNumber{}};
};

TEST_F(RunMeasureTest, shouldTimeEachRecordFromItsWriteToItsReport) {
    const Instant filled = host.records_written.at(0).written_at;
    report(16);
    EXPECT_EQ(leads(), 16U);
    EXPECT_EQ(meters.lead_time.sum(), (host.now - filled) * 16);
    const Instant refilled = host.now;
    EXPECT_EQ(meters.records_sent, 272U);
    EXPECT_EQ(meters.refills, 2U);
    for (std::uint32_t printed = 32; printed <= 272; printed += 16) {
        report(printed);
    }
    EXPECT_EQ(leads(), 272U);
    const Duration of_fill = meters.lead_time.sum();
    report(274); // two of the refill behind the first
    EXPECT_EQ(leads(), 274U);
    EXPECT_LT(meters.lead_time.sum() - of_fill, 2 * (host.now - refilled));
}

TEST_F(RunMeasureTest, shouldTimeARefillFromItsAnswer) {
    RunMeasure fresh{meters, RecordNumber{}};
    const Duration before = meters.refill.sum();
    fresh.on_effect(RecordsWritten{numbers(300, 309), host.now, host.now + milliseconds{4}}, host.session.feeder());
    EXPECT_EQ(meters.refill.sum() - before, milliseconds{4});
}

TEST_F(RunMeasureTest, shouldNeverShowALeadTimeLongerThanItWas) {
    LineMeters crowded;
    RunMeasure small_writes{crowded, RecordNumber{}};
    const auto records = static_cast<std::uint32_t>(2 * RunMeasure::writes_kept);
    const Instant now = host.now;
    for (std::uint32_t number = 1; number <= records; ++number) {
        const Instant at = now - Duration{records - number};
        small_writes.on_effect(RecordsWritten{numbers(number, number), at, at}, host.session.feeder());
    }
    for (std::uint32_t printed = 0; printed < 1000; printed += 100) {
        report(printed + 100);
        small_writes.on_fact(host.session, now);
    }
    EXPECT_EQ(crowded.lead_time.count_from(Duration::zero()), 1000U);
    const auto exact = static_cast<Duration::rep>(records - 1) * records / 2;
    EXPECT_LE(crowded.lead_time.sum().count(), exact);
    EXPECT_EQ(crowded.records_sent, records);
}

TEST_F(RunMeasureTest, shouldTakeAReportThatIsOlderThanTheWriteForNoLeadAtAll) {
    LineMeters odd;
    RunMeasure one{odd, RecordNumber{}};
    one.on_effect(RecordsWritten{numbers(1, 10), host.now, host.now + milliseconds{5}}, host.session.feeder());
    report(16);
    one.on_fact(host.session, host.now - milliseconds{40});
    EXPECT_EQ(odd.lead_time.count(0), 10U);
    EXPECT_EQ(odd.lead_time.sum(), Duration::zero());
}

TEST_F(RunMeasureTest, shouldCountConfirmedAndSettledRecordsOnce) {
    const feeder::Feeder& feeder = host.session.feeder();
    measure.on_effect(feeder::ConfirmPrinted{RecordNumber{10}, {}}, feeder);
    measure.on_effect(feeder::ConfirmPrinted{RecordNumber{16}, {}}, feeder);
    measure.on_effect(feeder::ConfirmPrinted{RecordNumber{16}, {}}, feeder);
    EXPECT_EQ(meters.records_printed, 16U);
    feeder::Settle settle;
    settle.verdict.printed = numbers(17, 20);
    settle.verdict.in_doubt = numbers(21, 21);
    settle.verdict.unused = numbers(22, 256);
    measure.on_effect(settle, feeder);
    EXPECT_EQ(meters.records_printed, 20U);
    EXPECT_EQ(meters.records_in_doubt, 1U);
    EXPECT_EQ(meters.records_unused, 235U);
    measure.on_fact(host.session, host.now);
    EXPECT_EQ(leads(), 20U) << "what the verdict calls printed has a lead time as well";
}

TEST_F(RunMeasureTest, shouldCountWhatAnAdoptedRunHasPrintedMeanwhile) {
    LineMeters own;
    RunMeasure adopting{own, RecordNumber{40}};
    const feeder::Feeder& feeder = host.session.feeder();
    adopting.on_effect(feeder::AdoptRun{RecordNumber{55}, RecordNumber{200}, {}}, feeder);
    EXPECT_EQ(own.records_printed, 15U);
    adopting.on_effect(feeder::ConfirmPrinted{RecordNumber{60}, {}}, feeder);
    EXPECT_EQ(own.records_printed, 20U);
}

TEST_F(RunMeasureTest, shouldCountAnEmptyFifoOncePerTime) {
    host.writes_complete_at_once = false; // the refill hangs: nothing follows
    report(255);
    EXPECT_EQ(meters.underruns, 0U) << "one is left";
    feeder::Outcome dry;
    dry.code = OutcomeCode::ran_dry;
    measure.on_effect(feeder::End{dry}, host.session.feeder());
    EXPECT_EQ(meters.underruns, 1U);
}

TEST_F(RunMeasureTest, shouldCountAnErrorThatSaysTheFifoWasEmpty) {
    feeder::Outcome outcome;
    outcome.code = OutcomeCode::printer_error;
    outcome.error.raw = 10202;
    measure.on_effect(feeder::End{outcome}, host.session.feeder());
    EXPECT_EQ(meters.underruns, 0U);
    outcome.error.raw = 5043;
    measure.on_effect(feeder::End{outcome}, host.session.feeder());
    EXPECT_EQ(meters.underruns, 1U);
    outcome.code = OutcomeCode::finished; // a firmware without stop point ends so
    measure.on_effect(feeder::End{outcome}, host.session.feeder());
    EXPECT_EQ(meters.underruns, 1U);
}

TEST(RunMeasureWithFewPages, shouldCountAFifoThatRanEmptyWhileTheJobHadRecords) {
    const auto pages = session::make_pages(1, 1000, 100, session::plain_text);
    Conversation host;
    LineMeters meters;
    RunMeasure measure{meters, RecordNumber{}};
    const auto report = [&](std::uint32_t printed) {
        host.now += std::chrono::seconds{1};
        host.wake();
        host.receive(mail(0, printed, 1000));
        measure.on_fact(host.session, host.now);
    };
    host.connect();
    host.receive("^0=RS2\t5\t0\t0\t0\t0\r^0=VS1\t1\t1\t1\t1\t1\t1\t1\t1\t1\tS1\r^0=JLA\r");
    host.receive(mail(0, 0, 0) + mail(0, 0, 0) + "^0=CC0\t0\t1000\r");
    host.grant(1, 1000);
    host.receive(mail(0, 0, 0) + mail(0, 0, 1000));
    for (std::size_t page = 0; page < 3; ++page) { // 300 of 1000 are at hand
        host.page(*pages[page]);
    }
    host.receive(mail(255, 0, 1000));
    host.wake();
    host.receive("^0=RS2\t6\t0\t0\t0\t0\r");
    ASSERT_EQ(host.session.feeder().phase(), feeder::Phase::printing);
    report(256);
    EXPECT_EQ(meters.underruns, 0U);
    report(300);
    report(300);
    EXPECT_EQ(meters.underruns, 1U);
    host.page(*pages[3]);
    measure.on_fact(host.session, host.now);
    report(400);
    EXPECT_EQ(meters.underruns, 2U);
}

TEST_F(RunMeasureTest, shouldCountLostLinksAndWhatWasOdd) {
    host.receive("noise^0=XX1\r");
    measure.on_fact(host.session, host.now);
    measure.on_fact(host.session, host.now);
    EXPECT_EQ(meters.frames_unexpected, 1U);
    EXPECT_EQ(meters.bytes_damaged, 5U);
    feeder::Outcome outcome;
    outcome.code = OutcomeCode::link_lost;
    measure.on_effect(feeder::End{outcome}, host.session.feeder());
    EXPECT_EQ(meters.links_lost, 1U);
}

} // namespace
} // namespace linefeed::daemon
