// The decision table of reconciliation, row by row, and its arithmetic over all small cases. The standard run issued
// the records 101-120, the printer showed number 77 before it and had made 1000 prints.
#include "feeder/reconcile.hpp"

#include <gtest/gtest.h>

#include <sstream>

namespace linefeed::feeder {
namespace {

RecordNumber no(std::uint32_t value) {
    return RecordNumber{value};
}

OpenRun run_with(std::uint32_t printed_through) {
    return {no(101), no(printed_through), no(120), "S1", 1000, no(77)};
}

/// The printer's own word after an interruption.
Evidence says(std::uint32_t last_printed, std::optional<std::uint32_t> total, bool finished = true) {
    Evidence evidence;
    evidence.mail = {256, 0, no(last_printed), {}, finished, {}};
    evidence.printer.total_prints = total;
    evidence.printer.version = protocol::VersionInfo{};
    evidence.printer.version->serial_number = "S1";
    return evidence;
}

Evidence end_message(Evidence evidence) {
    evidence.end_message = true;
    return evidence;
}

Evidence uninterrupted(Evidence evidence) {
    evidence.uninterrupted = true;
    return evidence;
}

std::string verdict(const OpenRun& run, const Evidence& evidence) {
    std::ostringstream out;
    out << reconcile(run, evidence);
    return out.str();
}

const std::string doubt_from_101 = "printed none, in doubt 101-120, unused none by no evidence";
const std::string doubt_from_111 = "printed none, in doubt 111-120, unused none by no evidence";
const std::string nothing_printed_by = "printed none, in doubt none, unused 101-120 by ";

TEST(Reconcile, shouldSettleARunThatIssuedNothing) {
    const OpenRun run{no(101), no(100), no(100), "S1", 1000, no(77)};
    EXPECT_EQ(verdict(run, says(0, std::nullopt)), "printed none, in doubt none, unused none by nothing was issued");
    OpenRun done = run_with(120);
    EXPECT_EQ(verdict(done, says(5, 5)), "printed none, in doubt none, unused none by nothing was issued");
}

TEST(Reconcile, shouldBelieveNoOtherPrinter) {
    Evidence evidence = says(105, 1005);
    evidence.printer.version->serial_number = "S2";
    EXPECT_EQ(verdict(run_with(100), evidence), doubt_from_101);
    evidence.end_message = true;
    EXPECT_EQ(verdict(run_with(110), evidence), doubt_from_111);
}

TEST(Reconcile, shouldTakeAPrinterWithoutSerialNumberForTheSame) {
    const std::string as_reported =
        "printed 101-105, in doubt none, unused 106-120 by mail status and total print counter";
    Evidence evidence = says(105, 1005);
    evidence.printer.version->serial_number.clear();
    EXPECT_EQ(verdict(run_with(100), evidence), as_reported);
    evidence.printer.version.reset();
    EXPECT_EQ(verdict(run_with(100), evidence), as_reported);
    OpenRun run = run_with(100);
    run.serial_number.clear();
    EXPECT_EQ(verdict(run, says(105, 1005)), as_reported);
}

TEST(Reconcile, shouldBelieveTheEndMessage) {
    EXPECT_EQ(verdict(run_with(117), end_message(says(118, std::nullopt, false))),
              "printed 118-120, in doubt none, unused none by end message 1223");
    EXPECT_EQ(verdict(run_with(110), end_message(says(120, 1020))),
              "printed 111-120, in doubt none, unused none by end message 1223");
    EXPECT_EQ(verdict(run_with(110), end_message(says(120, 1018))), doubt_from_111)
        << "the printer has thrown two away and printed on";
}

TEST(Reconcile, shouldBelieveANumberThatTheCounterConfirms) {
    EXPECT_EQ(verdict(run_with(110), says(115, 1015)),
              "printed 111-115, in doubt none, unused 116-120 by mail status and total print counter");
    EXPECT_EQ(verdict(run_with(110), says(110, 1010)),
              "printed none, in doubt none, unused 111-120 by mail status and total print counter");
    EXPECT_EQ(verdict(run_with(110), says(120, 1020)),
              "printed 111-120, in doubt none, unused none by mail status and total print counter");
}

TEST(Reconcile, shouldDoubtExactlyTheRecordWhosePrintDidNotFinish) {
    // The counter may count a print when it starts or when it ends.
    const std::string only_the_last =
        "printed 111-114, in doubt 115-115, unused 116-120 by mail status and total print counter";
    EXPECT_EQ(verdict(run_with(110), says(115, 1015, false)), only_the_last);
    EXPECT_EQ(verdict(run_with(110), uninterrupted(says(115, 1014, false))), only_the_last);
    const std::string up_to_it = "printed none, in doubt 111-115, unused 116-120 by mail status";
    EXPECT_EQ(verdict(run_with(110), says(115, 1014, false)), up_to_it) << "or one was skipped";
    Evidence unseen = uninterrupted(says(115, 1014, false));
    unseen.restart_unseen = true;
    EXPECT_EQ(verdict(run_with(110), unseen), up_to_it) << "or one was skipped";
    EXPECT_EQ(verdict(run_with(114), says(115, 1015, false)),
              "printed none, in doubt 115-115, unused 116-120 by mail status and total print counter");
    EXPECT_EQ(verdict(run_with(100), says(101, 1001, false)),
              "printed none, in doubt 101-101, unused 102-120 by mail status and total print counter");
    EXPECT_EQ(verdict(run_with(115), says(115, 1015, false)),
              "printed none, in doubt none, unused 116-120 by mail status and total print counter")
        << "confirmed before";
}

/// It was stopped in the print of 112, started again, and printed on to 115.
TEST(Reconcile, shouldDoubtAPrintThatWasBrokenOffBehindALaterNumberToo) {
    Evidence evidence = uninterrupted(says(115, 1015));
    evidence.broken_off = no(112);
    EXPECT_EQ(verdict(run_with(110), evidence),
              "printed 111-111, in doubt 112-115, unused 116-120 by mail status and total print counter");
    EXPECT_EQ(verdict(run_with(111), evidence),
              "printed none, in doubt 112-115, unused 116-120 by mail status and total print counter");
    EXPECT_EQ(verdict(run_with(112), evidence),
              "printed 113-115, in doubt none, unused 116-120 by mail status and total print counter");
    evidence.mail.last_print_finished = false;
    EXPECT_EQ(verdict(run_with(110), evidence),
              "printed 111-111, in doubt 112-115, unused 116-120 by mail status and total print counter");
    evidence.broken_off = no(115);
    EXPECT_EQ(verdict(run_with(110), evidence),
              "printed 111-114, in doubt 115-115, unused 116-120 by mail status and total print counter");
}

TEST(Reconcile, shouldBelieveTheNumberAloneWhenTheCounterIsMissing) {
    const std::string by_number = "printed 111-115, in doubt none, unused 116-120 by mail status";
    OpenRun run = run_with(110);
    run.total_before.reset();
    EXPECT_EQ(verdict(run, uninterrupted(says(115, std::nullopt))), by_number);
    EXPECT_EQ(verdict(run_with(110), uninterrupted(says(115, std::nullopt))), by_number);
    Evidence unseen = uninterrupted(says(115, std::nullopt));
    unseen.restart_unseen = true;
    EXPECT_EQ(verdict(run, unseen), by_number) << "nothing would ever be proven otherwise";
    // It was answered as the run began, and it could tell whether records were skipped.
    EXPECT_EQ(verdict(run_with(110), unseen), doubt_from_111);
}

/// While we were away it may have been stopped and started again, or have printed another job with numbers like ours.
TEST(Reconcile, shouldDoubtTheNumberOfAPrinterWithoutCounterBehindAnInterruption) {
    OpenRun run = run_with(110);
    run.total_before.reset();
    EXPECT_EQ(verdict(run, says(115, std::nullopt)), doubt_from_111);
    EXPECT_EQ(verdict(run, says(115, 1015)), doubt_from_111) << "it is not known how many there were before";
    EXPECT_EQ(verdict(run_with(110), says(115, std::nullopt)), doubt_from_111);
    EXPECT_EQ(verdict(run_with(110), says(115, 1000)), doubt_from_111) << "a counter that does not move";
}

TEST(Reconcile, shouldBelieveTheNumberWhenTheCounterDoesNotMove) {
    EXPECT_EQ(verdict(run_with(110), uninterrupted(says(115, 1000))),
              "printed 111-115, in doubt none, unused 116-120 by mail status");
    EXPECT_EQ(verdict(run_with(110), uninterrupted(says(115, 1000, false))),
              "printed 111-114, in doubt 115-115, unused 116-120 by mail status");
}

TEST(Reconcile, shouldDoubtEverythingWhenFewerWerePrintedThanTheNumberSays) {
    // A stop has emptied the FIFO, and the printer went on behind what it had thrown away.
    EXPECT_EQ(verdict(run_with(110), says(115, 1014)), doubt_from_111);
    EXPECT_EQ(verdict(run_with(110), uninterrupted(says(115, 1014))), doubt_from_111);
    EXPECT_EQ(verdict(run_with(110), says(115, 1013, false)), doubt_from_111);
    EXPECT_EQ(verdict(run_with(110), says(115, 1001)), doubt_from_111);
}

TEST(Reconcile, shouldDoubtEverythingWhenSomethingElseWasPrintedMeanwhile) {
    EXPECT_EQ(verdict(run_with(110), says(115, 1016)), doubt_from_111);
    EXPECT_EQ(verdict(run_with(110), uninterrupted(says(115, 1016))), doubt_from_111);
    Evidence fed = uninterrupted(says(115, 1015));
    fed.fed_by_another = true;
    EXPECT_EQ(verdict(run_with(110), fed), doubt_from_111);
    Evidence nothing_printed = uninterrupted(says(77, 1000));
    nothing_printed.fed_by_another = true;
    EXPECT_EQ(verdict(run_with(100), nothing_printed), nothing_printed_by + "mail status");
}

TEST(Reconcile, shouldTakeAPrintedEndMarkerForTheProofOfTheLastRecord) {
    const std::string all_printed = "printed 111-120, in doubt none, unused none by mail status";
    const std::string by_counter_too = all_printed + " and total print counter";
    OpenRun run = run_with(110);
    run.last = no(120);
    EXPECT_EQ(verdict(run, says(121, 1021)), by_counter_too);
    EXPECT_EQ(verdict(run, says(121, 1021, false)), by_counter_too) << "it is the marker that is unfinished";
    EXPECT_EQ(verdict(run, uninterrupted(says(121, 1020, false))), by_counter_too);
    EXPECT_EQ(verdict(run, says(121, 1020, false)), "printed none, in doubt 111-120, unused none by mail status");
    EXPECT_EQ(verdict(run, uninterrupted(says(121, std::nullopt))), all_printed);
    EXPECT_EQ(verdict(run, uninterrupted(says(121, 1000))), all_printed) << "a counter that does not move";
    EXPECT_EQ(verdict(run, says(121, 1020)), doubt_from_111) << "a record was skipped";
    EXPECT_EQ(verdict(run, uninterrupted(says(121, 1020))), doubt_from_111);
    EXPECT_EQ(verdict(run, says(121, 1022)), doubt_from_111) << "something else was printed";
    EXPECT_EQ(verdict(run, uninterrupted(says(121, 1022))), doubt_from_111);
    Evidence restarted = uninterrupted(says(121, std::nullopt));
    restarted.restarted = true;
    EXPECT_EQ(verdict(run, restarted), doubt_from_111) << "nobody counts what was thrown away";
    EXPECT_EQ(verdict(run, says(122, 1022)), doubt_from_111) << "there is one marker";
    run.last = no(130);
    EXPECT_EQ(verdict(run, says(121, 1021)), doubt_from_111) << "no marker had been sent by then";
    constexpr std::uint32_t max = 4294967295U;
    const OpenRun upper{no(max - 2), no(max - 3), no(max), "", 0, no(5), no(max)};
    EXPECT_EQ(verdict(upper, says(max, 3)),
              "printed 4294967293-4294967295, in doubt none, unused none by mail status and total print counter");
}

TEST(Reconcile, shouldAskTheCounterWhetherANumberLeftOverIsThatOfTheEndMarker) {
    OpenRun run = run_with(100);
    run.last = no(120);
    run.last_printed_before = no(121); // 121 was printed before: these are the records that were left
    for (const bool under_our_eyes : {false, true}) {
        const auto seen = [under_our_eyes](Evidence evidence) {
            evidence.uninterrupted = under_our_eyes;
            return evidence;
        };
        EXPECT_EQ(verdict(run, seen(says(121, 1000))), nothing_printed_by + "mail status and total print counter");
        EXPECT_EQ(verdict(run, seen(says(121, 1021))),
                  "printed 101-120, in doubt none, unused none by mail status and total print counter");
        EXPECT_EQ(verdict(run, seen(says(121, 1020, false))), doubt_from_101);
        EXPECT_EQ(verdict(run, seen(says(121, 1020))), doubt_from_101);
        EXPECT_EQ(verdict(run, seen(says(121, std::nullopt))), doubt_from_101);
    }
    run.last.reset(); // no marker was sent
    EXPECT_EQ(verdict(run, uninterrupted(says(121, std::nullopt))), nothing_printed_by + "mail status");
}

TEST(Reconcile, shouldBelieveARestartedPrinterOnlyWithItsCounter) {
    Evidence evidence = uninterrupted(says(115, 1015));
    evidence.restarted = true;
    EXPECT_EQ(verdict(run_with(110), evidence),
              "printed 111-115, in doubt none, unused 116-120 by mail status and total print counter");
    evidence.printer.total_prints = 1012; // it went on behind three records that it had thrown away
    EXPECT_EQ(verdict(run_with(110), evidence), doubt_from_111);
    evidence.printer.total_prints = 1016;
    EXPECT_EQ(verdict(run_with(110), evidence), doubt_from_111);
    evidence.printer.total_prints.reset();
    EXPECT_EQ(verdict(run_with(110), evidence), doubt_from_111);
}

TEST(Reconcile, shouldDoubtEverythingWhenTheNumberIsNotOfTheRun) {
    for (const std::uint32_t number : {1U, 76U, 78U, 100U, 109U, 121U, 4294967295U}) {
        EXPECT_EQ(verdict(run_with(110), says(number, 1010)), doubt_from_111) << number;
        EXPECT_EQ(verdict(run_with(110), uninterrupted(says(number, 1010))), doubt_from_111) << number;
    }
    EXPECT_EQ(verdict(run_with(110), says(77, 1010)), doubt_from_111) << "left over, but 110 are confirmed";
    EXPECT_EQ(verdict(run_with(100), says(100, 1000)), doubt_from_101) << "neither ours nor the one before";
}

// The number is still the one from before the run.

TEST(Reconcile, shouldTakeANumberLeftOverOutsideTheRunForNothingPrinted) {
    EXPECT_EQ(verdict(run_with(100), says(77, 1000)), nothing_printed_by + "mail status and total print counter");
    EXPECT_EQ(verdict(run_with(100), uninterrupted(says(77, 1000))), nothing_printed_by + "mail status");
    EXPECT_EQ(verdict(run_with(100), uninterrupted(says(77, 1003))), nothing_printed_by + "mail status")
        << "a print of ours would have changed the number";
    EXPECT_EQ(verdict(run_with(100), uninterrupted(says(77, std::nullopt))), nothing_printed_by + "mail status");
}

TEST(Reconcile, shouldDoubtANumberLeftOverOutsideTheRunWithoutACounterThatStoodStill) {
    EXPECT_EQ(verdict(run_with(100), says(77, std::nullopt)), doubt_from_101);
    EXPECT_EQ(verdict(run_with(100), says(77, 1001)), doubt_from_101);
}

TEST(Reconcile, shouldAskTheCounterAboutANumberLeftOverWithinTheRun) {
    OpenRun run = run_with(100);
    run.last_printed_before = no(105); // a reprint of records that this printer printed last
    for (const bool under_our_eyes : {false, true}) {
        const auto seen = [under_our_eyes](Evidence evidence) {
            evidence.uninterrupted = under_our_eyes;
            return evidence;
        };
        EXPECT_EQ(verdict(run, seen(says(105, 1000))), nothing_printed_by + "mail status and total print counter");
        EXPECT_EQ(verdict(run, seen(says(105, 1005))),
                  "printed 101-105, in doubt none, unused 106-120 by mail status and total print counter");
        EXPECT_EQ(verdict(run, seen(says(105, 1005, false))),
                  "printed 101-104, in doubt 105-105, unused 106-120 by mail status and total print counter");
        EXPECT_EQ(verdict(run, seen(says(105, 1003))), doubt_from_101);
        EXPECT_EQ(verdict(run, seen(says(105, 1006))), doubt_from_101);
        EXPECT_EQ(verdict(run, seen(says(105, std::nullopt))), doubt_from_101);
        EXPECT_EQ(verdict(run, seen(says(106, 1006))),
                  "printed 101-106, in doubt none, unused 107-120 by mail status and total print counter")
            << "any other number is a fresh one";
    }
}

// No number: the printer lost its memory, or printed nothing since.

TEST(Reconcile, shouldBoundTheDoubtByTheCounterAfterAPowerCycle) {
    // Somebody else may have used the printer since, so the counter proves no print; and the print in which the power
    // failed may not be counted.
    for (const bool finished : {false, true}) {
        EXPECT_EQ(verdict(run_with(110), says(0, 1015, finished)),
                  "printed none, in doubt 111-116, unused 117-120 by total print counter");
    }
    EXPECT_EQ(verdict(run_with(110), says(0, 1011)),
              "printed none, in doubt 111-112, unused 113-120 by total print counter");
    EXPECT_EQ(verdict(run_with(110), says(0, 1010)),
              "printed none, in doubt 111-111, unused 112-120 by total print counter")
        << "110 is confirmed, and finished";
    EXPECT_EQ(verdict(run_with(110), says(0, 1019)),
              "printed none, in doubt 111-120, unused none by total print counter");
    EXPECT_EQ(verdict(run_with(110), says(0, 1020)),
              "printed none, in doubt 111-120, unused none by total print counter");
    EXPECT_EQ(verdict(run_with(119), says(0, 1020)),
              "printed none, in doubt 120-120, unused none by total print counter");
    EXPECT_EQ(verdict(run_with(100), says(0, 1003)),
              "printed none, in doubt 101-104, unused 105-120 by total print counter");
    EXPECT_EQ(verdict(run_with(100), says(0, 1000)),
              "printed none, in doubt 101-101, unused 102-120 by total print counter");
    EXPECT_EQ(verdict(run_with(110), uninterrupted(says(0, 1015))),
              "printed none, in doubt 111-116, unused 117-120 by total print counter");
}

TEST(Reconcile, shouldDoubtEverythingAfterAPowerCycleWhenRecordsWereLeftOut) {
    OpenRun run = run_with(100);
    EXPECT_EQ(verdict(run, says(0, 1004)), "printed none, in doubt 101-105, unused 106-120 by total print counter");
    run.unclear = true; // 101, 102, 117 and 118, perhaps
    EXPECT_EQ(verdict(run, says(0, 1004)), doubt_from_101);
}

TEST(Reconcile, shouldDoubtEverythingAfterAPowerCycleWhenTheCounterCannotBe) {
    EXPECT_EQ(verdict(run_with(110), says(0, 1021)), doubt_from_111) << "more than were issued";
    EXPECT_EQ(verdict(run_with(110), says(0, 1009)), doubt_from_111) << "fewer than are confirmed";
    EXPECT_EQ(verdict(run_with(110), says(0, 900)), doubt_from_111) << "goes back";
    EXPECT_EQ(verdict(run_with(110), says(0, std::nullopt)), doubt_from_111);
    EXPECT_EQ(verdict(run_with(110), uninterrupted(says(0, std::nullopt))), doubt_from_111);
    EXPECT_EQ(verdict(run_with(100), says(0, std::nullopt)), doubt_from_101);
}

TEST(Reconcile, shouldKnowAPrinterThatHadNoNumberBeforeEither) {
    OpenRun run = run_with(100);
    run.last_printed_before = no(0);
    EXPECT_EQ(verdict(run, says(0, 1000)), nothing_printed_by + "mail status and total print counter");
    EXPECT_EQ(verdict(run, says(0, 1003)), "printed none, in doubt 101-104, unused 105-120 by total print counter");
    EXPECT_EQ(verdict(run, says(0, 1021)), doubt_from_101);
    EXPECT_EQ(verdict(run, says(0, std::nullopt)), doubt_from_101);
}

TEST(Reconcile, shouldDoubtWhenTheCounterMovedUnderOurEyesAndTheNumberDidNot) {
    EXPECT_EQ(verdict(run_with(100), uninterrupted(says(0, 1000))),
              nothing_printed_by + "mail status and total print counter");
    EXPECT_EQ(verdict(run_with(100), uninterrupted(says(0, std::nullopt))), nothing_printed_by + "mail status");
    EXPECT_EQ(verdict(run_with(100), uninterrupted(says(0, 1003))), doubt_from_101);
}

TEST(Reconcile, shouldCountAcrossTheWrapOfTheCounter) {
    OpenRun run = run_with(100);
    run.total_before = 4294967290U;
    EXPECT_EQ(verdict(run, says(115, 9)),
              "printed 101-115, in doubt none, unused 116-120 by mail status and total print counter");
    EXPECT_EQ(verdict(run, says(0, 9)), "printed none, in doubt 101-116, unused 117-120 by total print counter");
    EXPECT_EQ(verdict(run, says(115, 10)), doubt_from_101);
}

TEST(Reconcile, shouldWorkAtTheEndsOf32Bits) {
    constexpr std::uint32_t max = 4294967295U;
    const OpenRun upper{no(max - 2), no(max - 3), no(max), "", 0, no(0)};
    EXPECT_EQ(verdict(upper, says(max, 3)),
              "printed 4294967293-4294967295, in doubt none, unused none by mail status and total print counter");
    EXPECT_EQ(verdict(upper, says(max, 3, false)), "printed 4294967293-4294967294, in doubt 4294967295-4294967295, "
                                                   "unused none by mail status and total print counter");
    EXPECT_EQ(verdict(upper, says(0, 3)),
              "printed none, in doubt 4294967293-4294967295, unused none by total print counter");
    const OpenRun whole{no(1), no(0), no(max), "", 5, no(0)};
    EXPECT_EQ(verdict(whole, says(0, 4)), "printed none, in doubt 1-4294967295, unused none by total print counter");
    EXPECT_EQ(verdict(whole, says(max, 4)),
              "printed 1-4294967295, in doubt none, unused none by mail status and total print counter");
    const OpenRun lower{no(1), no(0), no(3), "", 5, no(9)};
    EXPECT_EQ(verdict(lower, says(1, 6, false)),
              "printed none, in doubt 1-1, unused 2-3 by mail status and total print counter");
}

using ReconcileDeathTest = testing::Test;

TEST(ReconcileDeathTest, shouldRefuseARunThatCannotBe) {
    const auto run = [](std::uint32_t first, std::uint32_t printed, std::uint32_t issued) {
        return reconcile({no(first), no(printed), no(issued), "", {}, {}}, {});
    };
    EXPECT_DEATH(static_cast<void>(run(0, 0, 5)), "first");
    EXPECT_DEATH(static_cast<void>(run(10, 8, 15)), "printed_through");
    EXPECT_DEATH(static_cast<void>(run(10, 12, 11)), "issued_through");
}

/// Every small run with every number, counter and flag: the verdict covers exactly what was issued and not confirmed,
/// in order, and doubts no more and no less than its basis allows.
TEST(Reconcile, shouldCoverExactlyWhatWasIssuedWhateverTheEvidence) {
    std::uint64_t cases = 0;
    const auto check = [&cases](const OpenRun& run, const Evidence& evidence) {
        const Verdict verdict = reconcile(run, evidence);
        std::uint32_t next = run.printed_through.value() + 1;
        for (const RecordRange& range : {verdict.printed, verdict.in_doubt, verdict.unused}) {
            if (!range.empty()) {
                ASSERT_EQ(range.first().value(), next);
                next = range.last().value() + 1;
            }
        }
        ASSERT_EQ(next, run.issued_through.value() + 1);
        switch (verdict.basis) {
        case Basis::nothing_issued:
            ASSERT_EQ(run.printed_through, run.issued_through);
            break;
        case Basis::none:
            ASSERT_TRUE(verdict.printed.empty() && verdict.unused.empty() && !verdict.in_doubt.empty());
            break;
        case Basis::end_message:
            ASSERT_TRUE(verdict.in_doubt.empty() && verdict.unused.empty());
            break;
        case Basis::mail_status:
            if (verdict.printed.empty() && verdict.in_doubt.count() > RecordCount{1}) {
                ASSERT_FALSE(evidence.mail.last_print_finished); // the counter has seen one print less
                ASSERT_NE(evidence.printer.total_prints, run.total_before);
                break;
            }
            [[fallthrough]];
        case Basis::mail_status_and_counter:
            ASSERT_LE(verdict.in_doubt.count().value(), evidence.mail.last_print_finished ? 0U : 1U);
            break;
        case Basis::counter:
            ASSERT_TRUE(verdict.printed.empty() && !verdict.in_doubt.empty());
            break;
        }
        ++cases;
    };
    for (std::uint32_t first = 1; first <= 3; ++first) {
        for (std::uint32_t issued = first - 1; issued <= first + 3; ++issued) {
            for (std::uint32_t printed = first - 1; printed <= issued; ++printed) {
                for (std::uint32_t before = 0; before <= 8; ++before) {
                    for (std::uint32_t reported = 0; reported <= 8; ++reported) {
                        for (std::uint32_t total = 0; total <= 8; ++total) {
                            for (unsigned flags = 0; flags < 16; ++flags) {
                                OpenRun run{no(first), no(printed), no(issued), "S1", 2, no(before)};
                                Evidence evidence = says(reported, total, (flags & 1U) != 0);
                                evidence.uninterrupted = (flags & 2U) != 0;
                                evidence.end_message = (flags & 4U) != 0;
                                evidence.restarted = (flags & 8U) != 0;
                                if (total == 8) {
                                    evidence.printer.total_prints.reset();
                                }
                                ASSERT_NO_FATAL_FAILURE(check(run, evidence))
                                    << first << ' ' << issued << ' ' << printed << ' ' << before << ' ' << reported
                                    << ' ' << total << ' ' << flags;
                            }
                        }
                    }
                }
            }
        }
    }
    EXPECT_GT(cases, 100000U);
}

TEST(Reconcile, shouldNameEveryBasis) {
    EXPECT_EQ(to_string(Basis::mail_status_and_counter), "mail status and total print counter");
    EXPECT_EQ(to_string(Basis::end_message), "end message 1223");
    EXPECT_EQ(to_string(Basis::mail_status), "mail status");
    EXPECT_EQ(to_string(Basis::counter), "total print counter");
    EXPECT_EQ(to_string(Basis::nothing_issued), "nothing was issued");
    EXPECT_EQ(to_string(Basis::none), "no evidence");
}

} // namespace
} // namespace linefeed::feeder
