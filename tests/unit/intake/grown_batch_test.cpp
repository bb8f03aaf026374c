// A file that is exported again and again and only grows: what was a batch before is not printed again unasked.
#include "drop_fixture.hpp"

#include <gmock/gmock.h>

namespace linefeed::intake {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class GrownBatchTest : public DropTest {
protected:
    /// The rows N001 … of a file: "first" to "last", and what comes behind them.
    static std::string rows(int count, const std::string& more = {}) {
        std::string text = "name\n";
        for (int row = 1; row <= count; ++row) {
            text += 'N' + std::to_string(row) + '\n';
        }
        return text + more;
    }
    void drop_and_run(const std::string& name, const std::string& content) {
        drop(name, content);
        ASSERT_FALSE(run());
    }
    [[nodiscard]] std::string reason(const std::string& name) const {
        return events.reports.back().name == name ? events.reports.back().reason : "?";
    }
};

TEST_F(GrownBatchTest, shouldRefuseAFileThatBeginsWithAnEarlierBatchAndHasMore) {
    start();
    drop_and_run("a.csv", rows(3));
    drop_and_run("b.csv", rows(5));
    EXPECT_THAT(events.lines, ElementsAre("a.csv: imported", "b.csv: failed"));
    EXPECT_THAT(names_in("failed"), ElementsAre("b.csv"));
    const std::string why = report_of("failed/b.csv").value("reason", "");
    EXPECT_THAT(why, HasSubstr("its first 3 records are those of job 1, which came from "));
    EXPECT_THAT(why, HasSubstr("/in/done/a.csv, and would be printed again: drop only what is new"));
    EXPECT_EQ(jobs(), 1U);
    drop_and_run("c.csv", rows(5)); // under another name, in vain
    EXPECT_EQ(events.lines.back(), "c.csv: failed");
    EXPECT_EQ(jobs(), 1U);
}

TEST_F(GrownBatchTest, shouldNameTheLongestOfSeveral) {
    settings.refuse_grown = false;
    start();
    drop_and_run("a.csv", rows(2));
    drop_and_run("b.csv", rows(4));
    drop_and_run("c.csv", rows(3));
    EXPECT_EQ(jobs(), 3U) << "this folder prints them";
    settings.refuse_grown = true;
    start_anew();
    drop_and_run("d.csv", rows(5));
    EXPECT_THAT(reason("d.csv"), HasSubstr("its first 4 records are those of job 2"));
}

TEST_F(GrownBatchTest, shouldTakeWhatOnlyBeginsAlike) {
    start();
    drop_and_run("a.csv", rows(3));
    drop_and_run("b.csv", rows(2, "X\nY\nZ\n"));
    drop_and_run("c.csv", rows(2)); // shorter
    drop_and_run("d.csv", "name\nX\n" + rows(3).substr(5));
    EXPECT_THAT(events.lines, ElementsAre("a.csv: imported", "b.csv: imported", "c.csv: imported", "d.csv: imported"));
    drop_and_run("e.csv", "name\r\nN1\r\nN2\r\nN3\r\n"); // the same records
    EXPECT_EQ(events.lines.back(), "e.csv: duplicate");
}

TEST_F(GrownBatchTest, shouldKnowTheSameRecordsHoweverTheyAreReadNow) {
    start();
    drop_and_run("a.csv", rows(3));
    settings.layout.columns = {"name"};
    start_anew();
    drop_and_run("b.csv", "name,more\nN1,x\nN2,y\nN3,z\n");
    EXPECT_EQ(events.lines.back(), "b.csv: duplicate");
    EXPECT_EQ(jobs(), 1U);
}

TEST_F(GrownBatchTest, shouldNameTheBadRowsOfAFileThatHasGrownToo) {
    start();
    drop_and_run("a.csv", rows(1));
    const std::string many = rows(3000); // the bad row comes pages behind
    drop_and_run("b.csv", many + "\xFF\xFE\n");
    EXPECT_EQ(events.lines.back(), "b.csv: failed");
    EXPECT_THAT(reason("b.csv"), HasSubstr("1 of 3001 rows cannot be printed"));
}

TEST_F(GrownBatchTest, shouldCompareBatchesOfManyPages) {
    const int many = 3000; // records of a page: some hundred
    start();
    drop_and_run("a.csv", rows(many));
    drop_and_run("b.csv", rows(many - 1, "X\nY\n"));
    drop_and_run("c.csv", rows(many, "X\n"));
    EXPECT_THAT(events.lines, ElementsAre("a.csv: imported", "b.csv: imported", "c.csv: failed"));
    EXPECT_THAT(reason("c.csv"), HasSubstr("its first 3000 records are those of job 1"));
}

TEST_F(GrownBatchTest, shouldTakeABatchWhoseBeginningWasGivenUpUnprinted) {
    start();
    drop_and_run("a.csv", rows(3));
    const spool::Job job = spool->jobs().value().front();
    spool::Ticket ticket;
    ticket.job = job.id;
    ASSERT_TRUE(spool->write_ticket(ticket));
    drop_and_run("b.csv", rows(4));
    EXPECT_EQ(events.lines.back(), "b.csv: failed") << "it is still to be printed";
    ticket.cancelled = true;
    ASSERT_TRUE(spool->write_ticket(ticket));
    drop_and_run("c.csv", rows(4));
    EXPECT_EQ(events.lines.back(), "c.csv: imported");
    const spool::RunId run = spool->begin_run(job.id, job.records, "{}").value();
    const std::vector<spool::LedgerEntry> intent{{spool::LedgerKind::intent, run, job.records, "{}"}};
    ASSERT_TRUE(spool->append(job.id, intent).has_value());
    drop_and_run("d.csv", rows(3, "X\n"));
    EXPECT_EQ(events.lines.back(), "d.csv: failed") << "something of it may be printed";
}

TEST_F(GrownBatchTest, shouldTakeWhatAnotherFolderBeginsWith) {
    start();
    drop_and_run("a.csv", rows(3));
    settings.folder = directory / "other";
    std::filesystem::create_directory(settings.folder);
    start();
    drop_and_run("b.csv", rows(4));
    EXPECT_EQ(events.lines.back(), "b.csv: imported") << "for another printer, perhaps";
}

} // namespace
} // namespace linefeed::intake
