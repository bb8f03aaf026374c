#include "spool_fixture.hpp"

#include <gmock/gmock.h>

namespace linefeed::spool {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class SpoolJobsTest : public SpoolTest {
protected:
    Spool spool = [this] {
        SpoolTest::SetUp();
        return open();
    }();
    void SetUp() override {}

    Job import(const JobSpec& wanted, std::uint32_t count = 3) {
        auto job = spool.begin_import(wanted);
        EXPECT_TRUE(job.has_value());
        EXPECT_TRUE(job->add(page_of(wanted.base.value() + 1, count)).has_value());
        return job->commit("{}").value();
    }
    static std::vector<std::int64_t> ids(const Result<std::vector<Job>>& jobs) {
        std::vector<std::int64_t> result;
        for (const Job& job : jobs.value()) {
            result.push_back(static_cast<std::int64_t>(job.id));
        }
        return result;
    }
};

TEST_F(SpoolJobsTest, shouldStoreEverythingAboutAJob) {
    JobSpec wanted = spec(22117);
    wanted.source.inode = ~std::uint64_t{0};
    wanted.source.companion = "12:34:56";
    now_ns = 123'456;
    auto import_job = spool.begin_import(wanted);
    ASSERT_TRUE(import_job.has_value());
    const RecordPage page = page_of(22118, 5);
    ASSERT_TRUE(import_job->add(page).has_value());
    const auto committed = import_job->commit(R"({"rows":5})");
    ASSERT_TRUE(committed.has_value());
    const auto stored = spool.job(committed->id);
    ASSERT_TRUE(stored.has_value() && stored->has_value());
    for (const Job& job : {*committed, **stored}) {
        EXPECT_EQ(job.id, import_job->id());
        EXPECT_EQ(job.spec.source, wanted.source);
        EXPECT_EQ(job.spec.layout, wanted.layout);
        EXPECT_EQ(job.spec.base, RecordNumber{22117});
        EXPECT_EQ(job.state, ImportState::ready);
        EXPECT_EQ(job.records, range(22118, 22122));
        EXPECT_EQ(job.frame_bytes, page.frames.size());
        EXPECT_EQ(job.created_ns, 123'456);
        EXPECT_EQ(job.import_report, R"({"rows":5})");
        EXPECT_EQ(job.content_sha256.size(), 64U);
    }
}

TEST_F(SpoolJobsTest, shouldHashTheFramesHoweverTheyAreCutIntoPages) {
    auto whole = spool.begin_import(spec());
    ASSERT_TRUE(whole->add(page_of(1, 20)).has_value());
    auto parts = spool.begin_import(spec());
    ASSERT_TRUE(parts->add(page_of(1, 7)).has_value());
    ASSERT_TRUE(parts->add(page_of(8, 13)).has_value());
    const Job a = whole->commit("").value();
    const Job b = parts->commit("").value();
    EXPECT_EQ(a.content_sha256, b.content_sha256);
    EXPECT_NE(a.content_sha256, import(spec(), 21).content_sha256);
}

TEST_F(SpoolJobsTest, shouldRefuseAJobWithoutRecords) {
    auto job = spool.begin_import(spec());
    const auto committed = job->commit("");
    ASSERT_FALSE(committed.has_value());
    EXPECT_EQ(committed.error().kind, FailureKind::input);
}

TEST_F(SpoolJobsTest, shouldShowAnImportInProgressAsSuch) {
    auto job = spool.begin_import(spec());
    const auto jobs = spool.jobs();
    ASSERT_EQ(jobs->size(), 1U);
    EXPECT_EQ(jobs->front().state, ImportState::importing);
    EXPECT_TRUE(jobs->front().records.empty());
    EXPECT_EQ(spool.find_by_source(spec()).value(), std::nullopt);
    EXPECT_TRUE(spool.find_by_path(spec().source.path).value().empty());
}

TEST_F(SpoolJobsTest, shouldRemoveAnImportThatIsGivenUp) {
    {
        auto job = spool.begin_import(spec());
        for (std::uint32_t first = 1; first < 700'000; first += 5000) {
            ASSERT_TRUE(job->add(page_of(first, 5000)).has_value());
        }
        EXPECT_NE(sql("SELECT count(*) FROM pages"), "0");
    }
    EXPECT_TRUE(spool.jobs().value().empty());
    EXPECT_EQ(sql("SELECT count(*) FROM pages"), "0");
}

TEST_F(SpoolJobsTest, shouldGiveUpTheOldImportWhenAnotherIsAssigned) {
    auto first = spool.begin_import(spec());
    const JobId kept = [&] {
        auto second = spool.begin_import(spec());
        *first = std::move(*second);
        return first->id();
    }();
    ASSERT_EQ(ids(spool.jobs()).size(), 1U);
    EXPECT_EQ(spool.jobs().value().front().id, kept);
}

TEST_F(SpoolJobsTest, shouldNeverUseAnIdAgain) {
    const JobId first = import(spec()).id;
    ASSERT_TRUE(spool.remove_job(first).has_value());
    EXPECT_GT(import(spec()).id, first);
}

TEST_F(SpoolJobsTest, shouldFindAJobByItsExactSource) {
    const Job job = import(spec());
    const auto found = [&](auto change) {
        JobSpec wanted = spec();
        change(wanted);
        return spool.find_by_source(wanted).value().has_value();
    };
    EXPECT_TRUE(found([](JobSpec&) {}));
    EXPECT_FALSE(found([](JobSpec& s) { s.source.path += "x"; }));
    EXPECT_FALSE(found([](JobSpec& s) { ++s.source.size_bytes; }));
    EXPECT_FALSE(found([](JobSpec& s) { ++s.source.modified_ns; }));
    EXPECT_FALSE(found([](JobSpec& s) { ++s.source.inode; }));
    EXPECT_FALSE(found([](JobSpec& s) { s.source.companion = "1"; }));
    EXPECT_FALSE(found([](JobSpec& s) { s.layout += " "; }));
    EXPECT_FALSE(found([](JobSpec& s) { s.base = RecordNumber{1}; }));
    const Job newer = import(spec());
    EXPECT_EQ(spool.find_by_source(spec()).value()->id, newer.id);
    EXPECT_NE(job.id, newer.id);
}

TEST_F(SpoolJobsTest, shouldFindReadyJobsByTheBytesOfTheirSource) {
    JobSpec wanted = spec();
    import(wanted);
    wanted.source_sha256 = std::string(64, 'a');
    const Job first = import(wanted);
    wanted.source.path = "/data/copy.csv";
    wanted.layout = "{}";
    import(wanted);
    const auto unfinished = spool.begin_import(wanted);
    EXPECT_EQ(first.spec.source_sha256, wanted.source_sha256);
    EXPECT_EQ(spool.job(first.id).value()->spec.source_sha256, wanted.source_sha256);
    EXPECT_THAT(ids(spool.find_by_source_bytes(wanted.source_sha256)), ElementsAre(2, 3));
    EXPECT_THAT(ids(spool.find_by_source_bytes(std::string(64, 'b'))), ElementsAre());
    EXPECT_THAT(ids(spool.find_by_source_bytes("")), ElementsAre()) << "unknown bytes are not the same bytes";
}

TEST_F(SpoolJobsTest, shouldFindJobsByContentOldestFirst) {
    const Job first = import(spec());
    JobSpec elsewhere = spec();
    elsewhere.source.path = "/data/copy.csv";
    import(elsewhere);
    import(spec(), 4);
    elsewhere.layout = "{}";
    import(elsewhere);
    EXPECT_THAT(ids(spool.find_by_content(first.content_sha256)), ElementsAre(1, 2, 4));
    EXPECT_THAT(ids(spool.find_by_path("/data/names.csv")), ElementsAre(1, 3));
    EXPECT_THAT(ids(spool.find_by_path("/data/copy.csv")), ElementsAre(2, 4));
}

TEST_F(SpoolJobsTest, shouldFollowASourceThatWasMoved) {
    const Job job = import(spec());
    const SourceFingerprint moved{"/new/names.csv", 1000, 78, 6, "c"};
    ASSERT_TRUE(spool.update_source(job.id, moved).has_value());
    EXPECT_EQ(spool.job(job.id).value()->spec.source, moved);
    EXPECT_EQ(spool.find_by_source(spec()).value(), std::nullopt);
}

TEST_F(SpoolJobsTest, shouldHaveNoJobUnderAnUnknownId) {
    EXPECT_EQ(spool.job(JobId{17}).value(), std::nullopt);
}

TEST_F(SpoolJobsTest, shouldNotRemoveAJobThatStandsInTheLedger) {
    const Job job = import(spec());
    ASSERT_TRUE(spool.begin_run(job.id, job.records, "{}").has_value());
    const auto removed = spool.remove_job(job.id);
    ASSERT_FALSE(removed.has_value());
    EXPECT_THAT(removed.error().message, HasSubstr("stands in the print ledger"));
    EXPECT_EQ(spool.job(job.id).value()->state, ImportState::ready);
}

TEST_F(SpoolJobsTest, shouldRefuseAJobRowThatCannotBe) {
    import(spec());
    sql("PRAGMA ignore_check_constraints = 1; UPDATE jobs SET records = 4294967296");
    const auto jobs = spool.jobs();
    ASSERT_FALSE(jobs.has_value());
    EXPECT_THAT(jobs.error().message, HasSubstr("job 1 cannot be read"));
}

} // namespace
} // namespace linefeed::spool
