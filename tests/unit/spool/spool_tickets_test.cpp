#include "spool_fixture.hpp"

#include <gmock/gmock.h>

namespace linefeed::spool {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class SpoolTicketsTest : public SpoolTest {
protected:
    static Ticket ticket(JobId job, const std::string& printer = "line1", std::optional<std::int64_t> place = {}) {
        return {.job = job,
                .name = "a.csv",
                .printer = printer,
                .layout = "names",
                .created_by = "anna",
                .autostart = true,
                .place = place,
                .message = "waits"};
    }
    static std::vector<JobId> jobs_of(const Result<std::vector<Ticket>>& tickets) {
        std::vector<JobId> jobs;
        for (const Ticket& ticket : tickets.value()) {
            jobs.push_back(ticket.job);
        }
        return jobs;
    }
};

TEST_F(SpoolTicketsTest, shouldKeepATicketAndItsLatestState) {
    const JobId job = [&] {
        Spool spool = open();
        const JobId id = make_job(spool, 10).id;
        EXPECT_EQ(spool.ticket(id).value(), std::nullopt);
        EXPECT_TRUE(spool.write_ticket(ticket(id, "line1", -3)));
        return id;
    }();
    Spool spool = open();
    EXPECT_EQ(spool.ticket(job).value(), ticket(job, "line1", -3));
    Ticket changed = ticket(job, "line2");
    changed.begun = changed.cancelled = true;
    changed.autostart = false;
    ASSERT_TRUE(spool.write_ticket(changed));
    EXPECT_EQ(spool.ticket(job).value(), changed);
}

TEST_F(SpoolTicketsTest, shouldRefuseATicketOfNoJob) {
    Spool spool = open();
    EXPECT_FALSE(spool.write_ticket(ticket(JobId{7})));
    EXPECT_TRUE(spool.writable()) << "a wrong request is no failure of the disk";
}

TEST_F(SpoolTicketsTest, shouldOrderEachQueueByPlace) {
    Spool spool = open();
    const JobId a = make_job(spool, 10).id;
    const JobId b = make_job(spool, 10).id;
    const JobId c = make_job(spool, 10).id;
    EXPECT_THAT(jobs_of(spool.queue("line1")), IsEmpty());
    EXPECT_EQ(spool.first_place("line1").value(), 0);
    EXPECT_EQ(spool.last_place("line1").value(), 1);
    for (const JobId job : {a, b}) {
        ASSERT_TRUE(spool.write_ticket(ticket(job, "line1", spool.last_place("line1").value())));
    }
    ASSERT_TRUE(spool.write_ticket(ticket(c, "line2", spool.last_place("line2").value())));
    EXPECT_THAT(jobs_of(spool.queue("line1")), ElementsAre(a, b));
    ASSERT_TRUE(spool.write_ticket(ticket(b, "line1", spool.first_place("line1").value())));
    EXPECT_THAT(jobs_of(spool.queue("line1")), ElementsAre(b, a));
    EXPECT_THAT(jobs_of(spool.queue("line2")), ElementsAre(c));
    ASSERT_TRUE(spool.write_ticket(ticket(b, "line1")));
    EXPECT_THAT(jobs_of(spool.queue("line1")), ElementsAre(a));
}

TEST_F(SpoolTicketsTest, shouldListWhatWasBegun) {
    Spool spool = open();
    const JobId a = make_job(spool, 10).id;
    const JobId b = make_job(spool, 10).id;
    for (const JobId job : {a, b}) {
        Ticket begun = ticket(job);
        begun.begun = job == b;
        ASSERT_TRUE(spool.write_ticket(begun));
    }
    EXPECT_THAT(jobs_of(spool.begun_jobs()), ElementsAre(b));
}

TEST_F(SpoolTicketsTest, shouldSeePastTheJobAtWork) {
    Spool spool = open();
    const JobId at_work = make_job(spool, 10).id;
    const JobId next = make_job(spool, 10).id;
    const auto write = [&](JobId job, std::int64_t place, bool begun) {
        Ticket written = ticket(job, "line1", place);
        written.begun = begun;
        ASSERT_TRUE(spool.write_ticket(written));
    };
    write(at_work, 1, true);
    EXPECT_TRUE(spool.has_begun_job("line1").value());
    EXPECT_FALSE(spool.has_begun_job("line1", at_work).value());
    EXPECT_EQ(spool.first_in_queue("line1", at_work).value(), std::nullopt);
    write(next, 2, false);
    EXPECT_EQ(spool.first_in_queue("line1").value()->job, at_work);
    EXPECT_EQ(spool.first_in_queue("line1", at_work).value()->job, next);
    write(next, 2, true);
    EXPECT_TRUE(spool.has_begun_job("line1", at_work).value());
    EXPECT_FALSE(spool.has_begun_job("line2", at_work).value());
}

TEST_F(SpoolTicketsTest, shouldFindJobsByTheirFirstRecord) {
    Spool spool = open();
    const JobId a = make_job(spool, 10).id;
    const JobId b = make_job(spool, 30).id;
    const RecordPage page = spool.read_page(a, RecordNumber{1}).value();
    const auto found = [&](RecordNumber number) {
        std::vector<JobId> ids;
        for (const Job& job : spool.find_by_first_record(page.slice({number, RecordCount{1}})).value()) {
            ids.push_back(job.id);
        }
        return ids;
    };
    EXPECT_THAT(found(RecordNumber{1}), ElementsAre(a, b));
    EXPECT_THAT(found(RecordNumber{2}), IsEmpty());
    ASSERT_TRUE(spool.remove_job(a));
    EXPECT_THAT(found(RecordNumber{1}), ElementsAre(b));
    EXPECT_EQ(sql("SELECT count(*) FROM job_heads"), "1");
}

TEST_F(SpoolTicketsTest, shouldLoseTheTicketWithItsJob) {
    Spool spool = open();
    const JobId job = make_job(spool, 10).id;
    ASSERT_TRUE(spool.write_ticket(ticket(job)));
    ASSERT_TRUE(spool.remove_job(job));
    EXPECT_EQ(spool.ticket(job).value(), std::nullopt);
}

TEST_F(SpoolTicketsTest, shouldRemoveALargeJobStepByStep) {
    Spool spool = open();
    const JobId job = make_job(spool, 6000).id; // pages of 10: 600
    int steps = 0;
    while (spool.remove_job_step(job).value()) {
        EXPECT_EQ(spool.job(job).value()->state, ImportState::importing);
        ++steps;
    }
    EXPECT_EQ(steps, 3);
    EXPECT_EQ(spool.job(job).value(), std::nullopt);
    EXPECT_EQ(sql("SELECT count(*) FROM pages"), "0");
}

TEST_F(SpoolTicketsTest, shouldLeaveAJobThatIsGivenUpToBeRemoved) {
    Spool spool = open();
    JobId id{};
    {
        auto import = spool.begin_import(spec()).value();
        ASSERT_TRUE(import.add(page_of(1, 10)));
        ASSERT_TRUE(import.flush());
        id = import.id();
        import.give_up();
    }
    EXPECT_TRUE(spool.job(id).value().has_value());
    EXPECT_TRUE(spool.remove_job(id));
    EXPECT_EQ(spool.job(id).value(), std::nullopt);
}

TEST_F(SpoolTicketsTest, shouldGiveTheNewestJobsPageByPage) {
    Spool spool = open();
    const JobId a = make_job(spool, 10).id;
    const JobId b = make_job(spool, 10).id;
    const JobId c = make_job(spool, 10).id;
    const auto ids = [](const Result<std::vector<Job>>& jobs) {
        std::vector<JobId> found;
        for (const Job& job : jobs.value()) {
            found.push_back(job.id);
        }
        return found;
    };
    EXPECT_THAT(ids(spool.newest_jobs({}, 2)), ElementsAre(c, b));
    EXPECT_THAT(ids(spool.newest_jobs(b, 2)), ElementsAre(a));
    EXPECT_THAT(ids(spool.newest_jobs(a, 2)), IsEmpty());
}

TEST_F(SpoolTicketsTest, shouldSeeWhatAnotherConnectionWritesMeanwhile) {
    Spool spool = open();
    const JobId job = make_job(spool, 10).id;
    Spool reader = Spool::open_for_reading(path, {}).value();
    EXPECT_TRUE(reader.ledger_state(job)->segments().empty());
    EXPECT_FALSE(reader.write_ticket(ticket(job)));
    EXPECT_FALSE(reader.writable());

    const RunId run = spool.begin_run(job, range(1, 10), "{}").value();
    ASSERT_TRUE(append(spool, job, {{LedgerKind::intent, run, range(1, 10), {}}}));
    EXPECT_EQ(reader.ledger_state(job)->count(RecordState::open), RecordCount{10});
}

} // namespace
} // namespace linefeed::spool
