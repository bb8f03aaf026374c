// Which job may follow another one without a stop, as far as the jobs themselves tell.
#include "service/follower.hpp"

#include <gtest/gtest.h>

namespace linefeed::service {
namespace {

using daemon::JobFacts;
using daemon::JobPhase;
using spool::LedgerKind;

RecordRange records(std::uint32_t first, std::uint32_t last) {
    return RecordRange::closed(RecordNumber{first}, RecordNumber{last});
}

class FollowerTest : public testing::Test {
protected:
    FollowerTest() {
        next_.job.id = spool::JobId{2};
        next_.job.state = spool::ImportState::ready;
        next_.job.records = records(1, 100);
        next_.job.frame_bytes = 100 * 30;
        next_.ticket = spool::Ticket{.job = next_.job.id, .printer = "line1", .autostart = true, .place = 2};
        wanted_.format = daemon::record_format(next_.job);
    }
    void write(JobFacts& facts, LedgerKind kind, RecordRange range) const {
        EXPECT_TRUE(facts.ledger.apply({kind, spool::RunId{1}, range, {}}));
    }
    /// All 100 records were granted; these are printed.
    [[nodiscard]] JobFacts printed(RecordRange range) const {
        JobFacts facts = next_;
        write(facts, LedgerKind::intent, records(1, 100));
        write(facts, LedgerKind::printed, range);
        return facts;
    }

    JobFacts next_;
    FollowerWanted wanted_;
};

TEST_F(FollowerTest, shouldTakeWhatWaitsAndMayStartByItself) {
    EXPECT_TRUE(fits_behind(next_, wanted_));
    next_.ticket->autostart = false;
    EXPECT_FALSE(fits_behind(next_, wanted_));
}

TEST_F(FollowerTest, shouldNotTakeWhatWasBegunCancelledOrIssued) {
    JobFacts begun = next_;
    begun.ticket->begun = true;
    EXPECT_FALSE(fits_behind(begun, wanted_));
    JobFacts cancelled = next_;
    cancelled.ticket->cancelled = true;
    EXPECT_FALSE(fits_behind(cancelled, wanted_));
    write(next_, LedgerKind::intent, records(1, 5));
    write(next_, LedgerKind::unused, records(1, 5));
    EXPECT_FALSE(fits_behind(next_, wanted_));
}

TEST_F(FollowerTest, shouldNotTakeWhatIsNotComplete) {
    next_.job.state = spool::ImportState::stopped;
    EXPECT_FALSE(fits_behind(next_, wanted_));
    next_.job.state = spool::ImportState::ready;
    next_.job.records = {};
    EXPECT_FALSE(fits_behind(next_, wanted_));
}

TEST_F(FollowerTest, shouldTakeOnlyRecordsOfTheSameFormat) {
    wanted_.format.charsets.push_back(protocol::Charset::latin1);
    EXPECT_FALSE(fits_behind(next_, wanted_)) << "another number of fields";
    wanted_.format = daemon::record_format(next_.job);
    wanted_.format.charsets.front() = protocol::Charset::windows_1252;
    EXPECT_FALSE(fits_behind(next_, wanted_));
    wanted_.format = daemon::record_format(next_.job);
    wanted_.format.escapes = protocol::EscapeMode::none;
    EXPECT_FALSE(fits_behind(next_, wanted_));
    wanted_.format = daemon::record_format(next_.job);
    wanted_.format.properties = true;
    EXPECT_TRUE(fits_behind(next_, wanted_)) << "whoever turns records can leave them as they are";
}

TEST_F(FollowerTest, shouldNotTakeLongerRecordsOnALineThatIsMadeForShorterOnes) {
    wanted_.most_record_bytes = 30;
    EXPECT_TRUE(fits_behind(next_, wanted_));
    wanted_.most_record_bytes = 29;
    EXPECT_FALSE(fits_behind(next_, wanted_));
}

TEST_F(FollowerTest, shouldSeeWhetherAJobEndsWithItsRun) {
    EXPECT_TRUE(ends_with(next_, records(1, 100)));
    EXPECT_FALSE(ends_with(next_, records(1, 99)));
    EXPECT_TRUE(ends_with(printed(records(1, 60)), records(1, 100))) << "the run itself has printed them";
    EXPECT_TRUE(ends_with(printed(records(1, 60)), records(61, 100)));
    EXPECT_TRUE(ends_with(printed(records(1, 60)), records(41, 100)));
    EXPECT_FALSE(ends_with(printed(records(1, 60)), records(62, 100)));
    JobFacts doubtful = printed(records(1, 60));
    write(doubtful, LedgerKind::in_doubt, records(61, 61));
    EXPECT_FALSE(ends_with(doubtful, records(62, 100))) << "somebody has to say what became of it";
    write(doubtful, LedgerKind::skipped, records(61, 61));
    EXPECT_TRUE(ends_with(doubtful, records(62, 100)));
}

/// It has been in the printer behind another job, and came back: nothing keeps it from its turn.
TEST_F(FollowerTest, shouldLetWaitWhatCameBackUnused) {
    write(next_, LedgerKind::intent, records(1, 50));
    EXPECT_EQ(phase_of(next_, {}), JobPhase::stopped);
    write(next_, LedgerKind::unused, records(1, 50));
    EXPECT_TRUE(next_.untouched());
    EXPECT_EQ(phase_of(next_, {}), JobPhase::queued);
    next_.ticket->begun = true;
    EXPECT_EQ(phase_of(next_, {}), JobPhase::stopped) << "as everything that somebody has begun";
}

} // namespace
} // namespace linefeed::service
