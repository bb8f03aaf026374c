// An import whose first records are printed before the last are there: what is durable when, what stays of it when it
// is broken off, and what it takes to go on.
#include "spool_fixture.hpp"

#include <gmock/gmock.h>

namespace linefeed::spool {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class JobImportTest : public SpoolTest {
protected:
    /// Records 1-20 imported and durable, 1-5 granted to a run; then broken off.
    static JobId break_off(Spool& spool) {
        auto import = spool.begin_import(spec()).value();
        add_pages(import, 1, 20);
        import.flush().value();
        const RunId run = spool.begin_run(import.id(), range(1, 1000), "{}").value();
        append(spool, import.id(), {{LedgerKind::intent, run, range(1, 5), {}}}).value();
        return import.id();
    }
    /// In pages of 10.
    static void add_pages(JobImport& import, std::uint32_t first, std::uint32_t last) {
        for (std::uint32_t number = first; number <= last; number += 10) {
            import.add(page_of(number, std::min(10U, last + 1 - number))).value();
        }
    }
    static Job unfinished(Spool& spool) {
        const auto jobs = spool.unfinished_jobs().value();
        EXPECT_EQ(jobs.size(), 1U);
        return jobs.at(0);
    }
};

TEST_F(JobImportTest, shouldBeReadableAndPrintableAsFarAsItIsFlushed) {
    Spool spool = open();
    auto import = spool.begin_import(spec()).value();
    EXPECT_TRUE(import.durable().empty());
    import.flush().value();
    EXPECT_TRUE(import.durable().empty()) << "nothing was added";
    add_pages(import, 1, 20);
    EXPECT_EQ(import.added(), RecordCount{20});
    EXPECT_TRUE(import.durable().empty()) << "it waits for more";
    EXPECT_FALSE(spool.ledger_state(import.id())) << "there is nothing to print yet";
    import.flush().value();
    EXPECT_EQ(import.durable(), range(1, 20));
    EXPECT_EQ(spool.job(import.id()).value()->records, range(1, 20));
    EXPECT_EQ(spool.job(import.id()).value()->state, ImportState::importing);
    EXPECT_EQ(spool.read_page(import.id(), RecordNumber{15}).value().range(), range(11, 20));

    const RunId run = spool.begin_run(import.id(), range(1, 1000), "{}").value();
    EXPECT_TRUE(append(spool, import.id(), {{LedgerKind::intent, run, range(1, 20), {}}}));
    EXPECT_FALSE(append(spool, import.id(), {{LedgerKind::intent, run, range(21, 21), {}}})) << "it is not there yet";
    add_pages(import, 21, 30);
    const Job job = import.commit("{}").value();
    EXPECT_EQ(job.records, range(1, 30));
    EXPECT_TRUE(append(spool, import.id(), {{LedgerKind::intent, run, range(21, 30), {}}}));
    EXPECT_FALSE(spool.begin_run(import.id(), range(1, 1000), "{}")) << "the job is complete: it has 30 records";
    EXPECT_THAT(spool.unfinished_jobs().value(), IsEmpty());
}

TEST_F(JobImportTest, shouldVanishWhenItIsBrokenOffBeforeAnythingWasPrinted) {
    Spool spool = open();
    {
        auto import = spool.begin_import(spec()).value();
        add_pages(import, 1, 20);
        import.flush().value();
    }
    EXPECT_THAT(spool.jobs().value(), IsEmpty());
    EXPECT_EQ(sql("SELECT count(*) FROM pages"), "0");
}

TEST_F(JobImportTest, shouldStayWhenItIsBrokenOffBehindTheFirstIntent) {
    JobId id{};
    {
        Spool spool = open();
        id = break_off(spool);
        EXPECT_EQ(unfinished(spool).id, id);
    }
    Spool spool = open(); // after a crash as well
    const Job job = unfinished(spool);
    EXPECT_EQ(job.id, id);
    EXPECT_EQ(job.records, range(1, 20));
    EXPECT_EQ(spool.find_by_source(spec()).value(), std::nullopt) << "it is not ready";
    EXPECT_EQ(spool.ledger_state(id).value().ranges(RecordState::open), std::vector{range(1, 5)});
}

TEST_F(JobImportTest, shouldGoOnWhenAllPagesComeOnceMore) {
    Spool spool = open();
    const JobId id = break_off(spool);
    const Job whole = [] {
        Job job;
        job.spec = spec();
        return job;
    }();
    auto import = spool.resume_import(unfinished(spool), whole.spec.source).value();
    EXPECT_EQ(import.durable(), range(1, 20)) << "they may be printed at once";
    EXPECT_EQ(import.added(), RecordCount{});
    import.add(page_of(1, 7)).value(); // other pages than before
    import.add(page_of(8, 17)).value();
    EXPECT_EQ(import.durable(), range(1, 20));
    import.flush().value();
    EXPECT_EQ(import.durable(), range(1, 24));
    add_pages(import, 25, 50);
    const Job job = import.commit("{}").value();
    EXPECT_EQ(job.id, id);
    EXPECT_EQ(job.records, range(1, 50));
    EXPECT_EQ(spool.read_page(id, RecordNumber{22}).value().slice(range(22, 22)), page_of(22, 1).frames);

    Spool other_spool = Spool::open(directory / "other.db", {[] { return 1; }, {}}).value();
    EXPECT_EQ(job.content_sha256, make_job(other_spool, 50).content_sha256) << "as if it had come in one go";
    EXPECT_EQ(job.frame_bytes, page_of(1, 50).frames.size());
}

TEST_F(JobImportTest, shouldRefuseRecordsThatAreNotThoseOfBefore) {
    Spool spool = open();
    break_off(spool);
    for (const std::uint32_t changed : {1U, 9U, 10U, 11U, 20U}) {
        auto import = spool.resume_import(unfinished(spool), spec().source).value();
        RecordPage page = page_of(1, 30);
        const std::size_t in_text = page.ends[changed - 1] - 2; // its last digit
        page.frames[in_text] = 'x';
        const auto added = import.add(page);
        ASSERT_FALSE(added) << changed;
        EXPECT_EQ(added.error().kind, FailureKind::input);
        EXPECT_THAT(added.error().message, HasSubstr("are not those that were imported from it before"));
        EXPECT_FALSE(import.flush());
        EXPECT_FALSE(import.commit("{}"));
    }
    EXPECT_EQ(unfinished(spool).records, range(1, 20));
}

TEST_F(JobImportTest, shouldTakeAnotherRecordBehindThoseOfBefore) {
    Spool spool = open();
    break_off(spool);
    auto import = spool.resume_import(unfinished(spool), spec().source).value();
    RecordPage page = page_of(1, 21);
    page.frames[page.frames.size() - 2] = 'x';
    EXPECT_TRUE(import.add(page));
    EXPECT_TRUE(import.commit("{}"));
}

TEST_F(JobImportTest, shouldRefuseFewerRecordsThanBefore) {
    Spool spool = open();
    break_off(spool);
    auto import = spool.resume_import(unfinished(spool), spec().source).value();
    import.add(page_of(1, 19)).value();
    const auto job = import.commit("{}");
    ASSERT_FALSE(job);
    EXPECT_EQ(job.error().kind, FailureKind::input);
    EXPECT_THAT(job.error().message, HasSubstr("gives only 19 records, of which 20 were imported from it before"));
}

TEST_F(JobImportTest, shouldBeStoppedAtABadRowAndGoOnWithTheMendedFile) {
    JobId id{};
    {
        Spool spool = open();
        auto import = spool.begin_import(spec()).value();
        id = import.id();
        add_pages(import, 1, 20);
        import.flush().value();
        const RunId run = spool.begin_run(id, range(1, 1000), "{}").value();
        append(spool, id, {{LedgerKind::intent, run, range(1, 5), {}}}).value();
        add_pages(import, 21, 25);
        const Job stopped = import.stop(R"({"bad_rows":1})").value();
        EXPECT_EQ(stopped.state, ImportState::stopped);
        EXPECT_EQ(stopped.records, range(1, 25));
    }
    Spool spool = open();
    const Job stopped = unfinished(spool);
    EXPECT_EQ(stopped.state, ImportState::stopped);
    EXPECT_EQ(stopped.import_report, R"({"bad_rows":1})");
    SourceFingerprint mended = spec().source;
    mended.size_bytes = 2000;
    auto import = spool.resume_import(stopped, mended).value();
    add_pages(import, 1, 40);
    import.flush().value();
    EXPECT_EQ(unfinished(spool).state, ImportState::importing);
    EXPECT_EQ(unfinished(spool).spec.source, mended);
    EXPECT_EQ(import.commit("{}").value().records, range(1, 40));
}

TEST_F(JobImportTest, shouldNotBeStoppedBeforeItsFirstRecord) {
    Spool spool = open();
    auto import = spool.begin_import(spec()).value();
    const auto stopped = import.stop("{}");
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().kind, FailureKind::input);
}

TEST_F(JobImportTest, shouldKeepTheWalSmallWhenItIsFlushedRecordByRecord) {
    Spool spool = open();
    auto import = spool.begin_import(spec()).value();
    for (std::uint32_t number = 1; number <= 1000; ++number) {
        import.add(page_of(number, 1)).value();
        import.flush().value();
    }
    EXPECT_EQ(import.durable(), range(1, 1000));
    EXPECT_LT(std::filesystem::file_size(path.string() + "-wal"), 8U * 1024 * 1024);
}

TEST_F(JobImportTest, shouldKeepTwoImportsApart) {
    Spool spool = open();
    auto one = spool.begin_import(spec()).value();
    auto other = spool.begin_import(spec(100)).value();
    add_pages(one, 1, 10);
    add_pages(other, 101, 120);
    one.flush().value();
    EXPECT_TRUE(other.durable().empty());
    other = std::move(one); // what it held goes
    EXPECT_EQ(spool.jobs().value().size(), 2U) << "until the moved-from one goes";
    other.commit("{}").value();
}

} // namespace
} // namespace linefeed::spool
