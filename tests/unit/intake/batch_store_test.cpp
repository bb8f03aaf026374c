#include "intake/batch_store.hpp"
#include "intake_fixture.hpp"

namespace linefeed::intake {
namespace {

class BatchStoreTest : public IntakeTest {
protected:
    void SetUp() override {
        IntakeTest::SetUp();
        spool.emplace(spool::Spool::open(directory / "spool.db", {}).value());
        batches.emplace(*spool);
    }
    static spool::JobSpec spec(const std::string& name, char hash, const std::string& layout = "{}") {
        return {{"/in/done/" + name, 10, 20, 30, ""}, layout, {}, std::string(64, hash)};
    }
    BatchImport import(const std::string& content, const spool::JobSpec& spec) {
        auto rows = open_source(write(content), {}).value();
        return batches->import(*rows, spec, {}).value();
    }

    std::optional<spool::Spool> spool;
    std::optional<SpoolBatches> batches;
};

TEST_F(BatchStoreTest, shouldFindAJobByTheBytesOfItsFile) {
    EXPECT_FALSE(batches->find(spec("a", 'a')).value());
    const spool::Job job = *import("n\n1\n", spec("a", 'a')).job;
    const auto own = batches->find(spec("a", 'a')).value();
    EXPECT_EQ(own->job.id, job.id);
    EXPECT_TRUE(own->this_file);
    const auto other = batches->find(spec("b", 'a')).value();
    EXPECT_EQ(other->job.id, job.id);
    EXPECT_FALSE(other->this_file);
    EXPECT_FALSE(batches->find(spec("a", 'b')).value());
}

TEST_F(BatchStoreTest, shouldTakeTheSameBytesReadInAnotherWayInAnotherFolderForAnotherBatch) {
    import("n\n1\n", spec("a", 'a'));
    spool::JobSpec elsewhere = spec("a", 'a', R"({"columns":["n"]})");
    elsewhere.source.path = "/other/done/a";
    EXPECT_FALSE(batches->find(elsewhere).value());
    elsewhere.layout = "{}";
    EXPECT_TRUE(batches->find(elsewhere).value());
    elsewhere.base = RecordNumber{7};
    EXPECT_FALSE(batches->find(elsewhere).value());
}

TEST_F(BatchStoreTest, shouldKnowABatchOfTheSameFolderHoweverItWouldBeReadNow) {
    const spool::Job job = *import("n\n1\n", spec("a", 'a')).job;
    const auto other = batches->find(spec("b", 'a', R"({"columns":["n"]})")).value();
    ASSERT_TRUE(other);
    EXPECT_EQ(other->job.id, job.id);
    EXPECT_FALSE(other->this_file);
    EXPECT_TRUE(batches->find(spec("a", 'a', R"({"columns":["n"]})")).value()->this_file);
}

TEST_F(BatchStoreTest, shouldNotStoreTheSameRecordsFromOtherBytes) {
    const spool::Job job = *import("n\n1\n", spec("a", 'a')).job;
    const BatchImport again = import("n\r\n1\r\n", spec("b", 'b'));
    EXPECT_FALSE(again.job);
    ASSERT_TRUE(again.earlier);
    EXPECT_EQ(again.earlier->id, job.id);
    EXPECT_EQ(spool->jobs().value().size(), 1U);
    EXPECT_TRUE(import("n\n1\n2\n", spec("c", 'c')).job);
}

TEST_F(BatchStoreTest, shouldNotStoreTheSameRecordsOnceMoreForAnotherProfile) {
    const auto layout = [](const char* profile, const char* more) {
        return R"({"columns":[],"profile":")" + std::string{profile} + "\"" + more + "}";
    };
    const auto elsewhere = [](spool::JobSpec spec) {
        spec.source.path = "/other/done/b";
        return spec;
    };
    const spool::Job job = *import("n\n1\n", spec("a", 'a', layout("jet3up", ""))).job;
    const BatchImport again = import("n\n1\n", elsewhere(spec("b", 'a', layout("auto", ""))));
    ASSERT_TRUE(again.earlier);
    EXPECT_EQ(again.earlier->id, job.id);
    EXPECT_TRUE(import("n\n1\n", elsewhere(spec("b", 'a', layout("auto", ",\"header\":true")))).job)
        << "in another way, for another printer";
    const BatchImport same_folder = import("n\r\n1\r\n", spec("c", 'c', layout("jet3", ",\"header\":true")));
    ASSERT_TRUE(same_folder.earlier) << "a change of the layout is no reason to print a batch again";
    EXPECT_EQ(same_folder.earlier->id, job.id);
}

TEST_F(BatchStoreTest, shouldReadAnewWhatHasImages) {
    const std::string images = R"({"columns":[],"graphics":["n"]})";
    const spool::Job job = *import("n\n1\n", spec("a", 'a', images)).job;
    EXPECT_TRUE(batches->find(spec("a", 'a', images)).value()->this_file);
    EXPECT_FALSE(batches->find(spec("b", 'a', images)).value()) << "its images may be others";
    EXPECT_EQ(import("n\n1\n", spec("b", 'a', images)).earlier->id, job.id) << "they are not";
    EXPECT_TRUE(import("n\n2\n", spec("b", 'a', images)).job);
}

/// As after a crash between the import and the comparison.
TEST_F(BatchStoreTest, shouldCompareTheRecordsOfAJobThatItFinds) {
    const spool::Job job = *import("n\n1\n", spec("a", 'a')).job;
    auto rows = open_source(write("n\r\n1\r\n"), {}).value();
    const spool::Job second = *import_source(*rows, *spool, spec("b", 'b'), {}).value().job;
    const auto found = batches->find(spec("b", 'b')).value();
    EXPECT_EQ(found->job.id, job.id);
    EXPECT_FALSE(found->this_file);
    EXPECT_FALSE(spool->job(second.id).value());
}

/// Two folders, one thread that stores: the pages of both come in turn.
TEST_F(BatchStoreTest, shouldKeepOneOfTwoImportsThatOverlap) {
    auto rows = open_source(write("n\n1\n", "first.csv"), {}).value();
    ImportOptions options;
    std::optional<spool::Job> second;
    options.check_source = [&]() -> Result<void> {
        second = import("n\r\n1\r\n", spec("b", 'b')).job; // begun later, ready earlier
        return {};
    };
    const BatchImport first = batches->import(*rows, spec("a", 'a'), options).value();
    ASSERT_TRUE(second);
    EXPECT_FALSE(first.job);
    ASSERT_TRUE(first.earlier);
    EXPECT_EQ(first.earlier->id, second->id);
    EXPECT_EQ(spool->jobs().value().size(), 1U);
}

TEST_F(BatchStoreTest, shouldKeepAJobOfWhichSomethingIsPrinted) {
    import("n\n1\n", spec("a", 'a'));
    auto rows = open_source(write("n\r\n1\r\n"), {}).value();
    const spool::Job second = *import_source(*rows, *spool, spec("b", 'b'), {}).value().job;
    const spool::RunId run = spool->begin_run(second.id, second.records, "{}").value();
    const std::vector<spool::LedgerEntry> intent{{spool::LedgerKind::intent, run, second.records, "{}"}};
    ASSERT_TRUE(spool->append(second.id, intent).has_value());
    EXPECT_EQ(batches->find(spec("b", 'b')).value()->job.id, second.id);
}

TEST_F(BatchStoreTest, shouldReportBadRows) {
    const BatchImport bad = import("n\n\x01\n", spec("a", 'a'));
    EXPECT_FALSE(bad.job || bad.earlier);
    EXPECT_EQ(bad.report.bad_rows, 1U);
}

} // namespace
} // namespace linefeed::intake
