// A crash at every step of every kind of file: the next start finds out from the disk alone what is to be done, and no
// batch is lost or comes twice.
#include "drop_fixture.hpp"

namespace linefeed::intake {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

struct Crash {};

constexpr std::array<DropStep, 6> steps{DropStep::settled,  DropStep::claimed,  DropStep::hashed,
                                        DropStep::imported, DropStep::reported, DropStep::moved};

class DropCrashTest : public DropTest {
protected:
    void SetUp() override {
        DropTest::SetUp();
        settings.settle.by = SettleBy::renaming;
    }
    /// Crashes at the `at`-th step that is reached, from 0, starts anew and runs to the end. False if so many steps are
    /// not reached.
    bool crash_and_recover(int at) {
        int reached = 0;
        bool crashed = false;
        events.on_step = [&](DropStep) {
            if (reached++ == at && !crashed) {
                crashed = true;
                throw Crash{};
            }
        };
        start();
        try {
            run();
        } catch (const Crash&) {
        }
        start_anew();
        EXPECT_EQ(run(), std::nullopt);
        return crashed;
    }
    void clean() {
        folder.reset();
        batches.reset();
        spool.reset();
        std::filesystem::remove_all(directory);
        events = {};
        SetUp();
    }
    std::vector<std::string> records() {
        std::vector<std::string> all;
        for (const spool::Job& job : spool->jobs().value()) {
            EXPECT_EQ(job.state, spool::ImportState::ready);
            const RecordPage page = spool->read_page(job.id, job.records.first()).value();
            all.emplace_back(page.frames);
        }
        return all;
    }
};

TEST_F(DropCrashTest, shouldNeitherLoseNorDoubleABatch) {
    int at = 0;
    for (bool crashed = true; crashed; ++at) {
        SCOPED_TRACE("crash at step " + std::to_string(at));
        drop("a.csv", "name\nA\n");
        drop("bad.csv", "name\n\x01\n");
        drop("copy of a.csv", "name\nA\n");
        drop("same records as a.csv", "name\r\nA\r\n");
        drop("z.csv", "name\nZ\n");
        crashed = crash_and_recover(at);
        EXPECT_THAT(records(), ElementsAre("^0=MR1\tA\r", "^0=MR1\tZ\r"));
        EXPECT_THAT(names_in(""), IsEmpty());
        EXPECT_THAT(names_in("processing"), IsEmpty());
        EXPECT_THAT(names_in("done"), ElementsAre("a.csv", "copy of a.csv", "same records as a.csv", "z.csv"));
        EXPECT_THAT(names_in("failed"), ElementsAre("bad.csv"));
        EXPECT_EQ(report_of("done/a.csv")["verdict"], "imported");
        EXPECT_EQ(report_of("done/copy of a.csv")["verdict"], "duplicate");
        EXPECT_EQ(report_of("done/same records as a.csv")["verdict"], "duplicate");
        EXPECT_EQ(report_of("done/z.csv")["verdict"], "imported");
        EXPECT_EQ(report_of("failed/bad.csv")["verdict"], "failed");
        std::size_t told = 0;
        for (const DropReport& report : events.reports) {
            told += report.name == "a.csv" ? 1U : 0U;
        }
        EXPECT_GE(told, 1U) << "told perhaps twice, never not at all";
        clean();
    }
    // Five files, but that which is bad or known reaches as many steps as the others.
    EXPECT_EQ(at, static_cast<int>(5 * steps.size()) + 1);
}

TEST_F(DropCrashTest, shouldNotLetAMarkSurviveItsFile) {
    settings.settle.by = SettleBy::done_mark;
    int at = 0;
    for (bool crashed = true; crashed; ++at) {
        SCOPED_TRACE("crash at step " + std::to_string(at));
        settings.settle.by = SettleBy::done_mark;
        drop("a.csv");
        drop("a.csv.done", "");
        crashed = crash_and_recover(at);
        EXPECT_THAT(names_in("done"), ElementsAre("a.csv"));
        EXPECT_THAT(names_in(""), IsEmpty());
        EXPECT_EQ(jobs(), 1U);
        clean();
    }
}

TEST_F(DropCrashTest, shouldKnowItsOwnJobAlsoIfTheLayoutIsAnotherNow) {
    drop("a.csv", "name,code\nA,1\n");
    start();
    events.on_step = [](DropStep step) {
        if (step == DropStep::imported) {
            throw Crash{};
        }
    };
    EXPECT_THROW(run(), Crash);
    events.on_step = {};
    settings.layout.columns = {"code"};
    start_anew();
    run();
    EXPECT_THAT(events.lines, ElementsAre("a.csv: imported"));
    EXPECT_EQ(jobs(), 1U);
}

TEST_F(DropCrashTest, shouldRemoveTheReportOfAnAttemptThatEndedOtherwise) {
    drop("a.csv", "name\nA\n");
    settings.layout.columns = {"code"};
    start();
    events.on_step = [](DropStep step) {
        if (step == DropStep::reported) {
            throw Crash{};
        }
    };
    EXPECT_THROW(run(), Crash);
    EXPECT_TRUE(report_of("failed/a.csv").is_object());
    events.on_step = {};
    settings.layout.columns.clear();
    start_anew();
    run();
    EXPECT_TRUE(report_of("done/a.csv").is_object());
    EXPECT_FALSE(report_of("failed/a.csv").is_object());
}

TEST_F(DropCrashTest, shouldKeepTheFileWhenTheStoreFails) {
    class FullStore final : public BatchStore {
    public:
        Result<std::optional<KnownBatch>> find(const spool::JobSpec&) override { return std::optional<KnownBatch>{}; }
        Result<BatchImport> import(RowSource&, const spool::JobSpec&, const ImportOptions&) override {
            return Failure{FailureKind::storage, "the disk is full"};
        }
    } full;
    drop("a.csv");
    folder.emplace(DropFolder::open(settings, full, events).value());
    EXPECT_EQ(run(), (Failure{FailureKind::storage, "the disk is full"}));
    EXPECT_EQ(run(), (Failure{FailureKind::storage, "the disk is full"})) << "it is tried again";
    EXPECT_THAT(names_in("processing"), ElementsAre("a.csv"));
    start_anew();
    EXPECT_EQ(run(), std::nullopt);
    EXPECT_THAT(names_in("done"), ElementsAre("a.csv"));
}

} // namespace
} // namespace linefeed::intake
