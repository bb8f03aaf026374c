#include "spool_fixture.hpp"

#include <gmock/gmock.h>

namespace linefeed::spool {
namespace {

using testing::HasSubstr;
using SpoolPagesTest = SpoolTest;

TEST_F(SpoolPagesTest, shouldReadEachRecordFromItsPage) {
    Spool spool = open();
    const Job job = make_job(spool, 95, 22117);
    for (std::uint32_t number = 22118; number <= 22212; ++number) {
        const auto page = spool.read_page(job.id, RecordNumber{number});
        ASSERT_TRUE(page.has_value()) << page.error().message;
        ASSERT_TRUE(page->range().contains(RecordNumber{number}));
        EXPECT_EQ(page->first.value() % 10, 8U);
        EXPECT_EQ(page->slice(range(number, number)), page_of(number, 1).frames);
    }
}

TEST_F(SpoolPagesTest, shouldSayThatThereIsNoSuchRecord) {
    Spool spool = open();
    const Job job = make_job(spool, 95, 100);
    for (const std::uint32_t number : {0U, 100U, 196U, 4294967295U}) {
        const auto page = spool.read_page(job.id, RecordNumber{number});
        ASSERT_FALSE(page.has_value());
        EXPECT_THAT(page.error().message, HasSubstr("job 1 has no record " + std::to_string(number)));
    }
    EXPECT_FALSE(spool.read_page(JobId{2}, RecordNumber{101}).has_value());
}

TEST_F(SpoolPagesTest, shouldKeepJobsApart) {
    Spool spool = open();
    const Job a = make_job(spool, 10, 0);
    const Job b = make_job(spool, 10, 10);
    EXPECT_FALSE(spool.read_page(a.id, RecordNumber{11}).has_value());
    EXPECT_FALSE(spool.read_page(b.id, RecordNumber{10}).has_value());
}

TEST_F(SpoolPagesTest, shouldTellWhetherRecordsHoldEscapes) {
    Spool spool = open();
    const Job plain = make_job(spool, 95);
    auto import = spool.begin_import(spec());
    ASSERT_TRUE(import->add(page_of(1, 10)).has_value());
    RecordPage page = page_of(11, 2);
    page.frames.insert(page.frames.size() - 1, "\\^");
    page.ends.back() += 2;
    ASSERT_TRUE(import->add(page).has_value());
    const Job escaped = import->commit("{}").value();
    EXPECT_FALSE(spool.has_escapes(plain.id).value());
    EXPECT_TRUE(spool.has_escapes(escaped.id).value());
}

TEST_F(SpoolPagesTest, shouldTakeRecordsUpToTheLastNumber) {
    Spool spool = open();
    const Job job = make_job(spool, 10, RecordNumber::max().value() - 10);
    EXPECT_EQ(job.records.last(), RecordNumber::max());
    EXPECT_EQ(spool.read_page(job.id, RecordNumber::max()).value().range(), job.records);
}

TEST_F(SpoolPagesTest, shouldReadWhatWasWrittenInSeveralTransactions) {
    Spool spool = open();
    auto import = spool.begin_import(spec());
    constexpr std::uint32_t per_page = 5000;
    constexpr std::uint32_t pages = 150; // about 15 MB
    for (std::uint32_t page = 0; page < pages; ++page) {
        ASSERT_TRUE(import->add(page_of(page * per_page + 1, per_page)).has_value());
    }
    const Job job = import->commit("{}").value();
    EXPECT_EQ(job.records, range(1, pages * per_page));
    for (std::uint32_t page = 0; page < pages; ++page) {
        const auto read = spool.read_page(job.id, RecordNumber{page * per_page + 1});
        ASSERT_TRUE(read.has_value());
        const RecordPage written = page_of(page * per_page + 1, per_page);
        EXPECT_EQ(read->first, written.first);
        EXPECT_EQ(read->ends, written.ends);
        EXPECT_EQ(read->frames, written.frames);
    }
    // The WAL did not grow with the import.
    EXPECT_LT(std::filesystem::file_size(path.string() + "-wal"), 12U * 1024 * 1024);
}

class DamagedPage : public SpoolTest, public testing::WithParamInterface<const char*> {};

TEST_P(DamagedPage, shouldBeDetectedWhenItIsRead) {
    Spool spool = open();
    const Job job = make_job(spool, 20);
    ASSERT_TRUE(spool.read_page(job.id, RecordNumber{15}).has_value());
    ASSERT_THAT(sql(GetParam()), testing::Not(HasSubstr("error")));
    const auto page = spool.read_page(job.id, RecordNumber{15});
    ASSERT_FALSE(page.has_value());
    EXPECT_EQ(page.error().kind, FailureKind::storage);
    EXPECT_TRUE(spool.read_page(job.id, RecordNumber{5}).has_value()); // the other page is as it was
}

INSTANTIATE_TEST_SUITE_P(
    Spool, DamagedPage,
    testing::Values(
        "UPDATE pages SET frames = CAST(replace(CAST(frames AS TEXT), 'name 15', 'name 51') AS BLOB) WHERE first = 11",
        "UPDATE pages SET ends = zeroblob(length(ends)) WHERE first = 11",
        "UPDATE pages SET ends = substr(ends, 1, 36) WHERE first = 11",
        "UPDATE pages SET crc = crc + 1 WHERE first = 11", "UPDATE pages SET records = 9 WHERE first = 11",
        "UPDATE pages SET first = 12 WHERE first = 11", "DELETE FROM pages WHERE first = 11",
        "UPDATE pages SET frames = (SELECT frames FROM pages WHERE first = 1) WHERE first = 11"));

TEST_F(SpoolPagesTest, shouldAbortOnAPageThatDoesNotFollow) {
    Spool spool = open();
    auto import = spool.begin_import(spec());
    ASSERT_TRUE(import->add(page_of(1, 5)).has_value());
    EXPECT_DEATH(static_cast<void>(import->add(page_of(7, 5))), "page.first");
    EXPECT_DEATH(static_cast<void>(import->add(RecordPage{RecordNumber{6}, {}, {}})), "is_consistent");
}

} // namespace
} // namespace linefeed::spool
