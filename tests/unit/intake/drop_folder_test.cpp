#include "drop_fixture.hpp"

#include <climits>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <thread>
#include <unistd.h>

namespace linefeed::intake {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
namespace fs = std::filesystem;

class DropFolderTest : public DropTest {};

/// Everything that does not depend on how changes are seen.
class AnyDropFolder : public DropTest, public testing::WithParamInterface<WatchMode> {
protected:
    void SetUp() override {
        DropTest::SetUp();
        settings.mode = GetParam();
    }
};

INSTANTIATE_TEST_SUITE_P(Modes, AnyDropFolder, testing::Values(WatchMode::inotify, WatchMode::poll),
                         [](const auto& mode) { return mode.param == WatchMode::poll ? "poll" : "inotify"; });

TEST_P(AnyDropFolder, shouldImportWhatLiesThereAndWhatComes) {
    drop("a.csv", "name\nA\n");
    drop("a.txt");
    start();
    EXPECT_EQ(folder->mode(), GetParam());
    run();
    drop("b.csv", "name\nB\nC\n");
    run_for(4s);
    EXPECT_THAT(events.lines, ElementsAre("a.csv: imported", "b.csv: imported"));
    EXPECT_THAT(names_in("done"), ElementsAre("a.csv", "b.csv"));
    EXPECT_THAT(names_in(""), ElementsAre("a.txt"));
    EXPECT_THAT(names_in("processing"), IsEmpty());
    const auto report = report_of("done/b.csv");
    EXPECT_EQ(report["verdict"], "imported");
    EXPECT_EQ(report["job"], 2);
    EXPECT_EQ(report["records"], 2);
    EXPECT_EQ(report["bytes"], 9);
    EXPECT_EQ(report["sha256"], "36ea8d0919c0f0d212ebaa646be707a29f0fa6531814b135dfdfcb1ff6adcd47");
    EXPECT_EQ(report["import"]["rows"], 2);
}

TEST_P(AnyDropFolder, shouldWaitUntilAFileIsQuiet) {
    start();
    drop("a.csv", "name\nA\n");
    run_for(1500ms);
    drop("a.csv", "name\nA\nB\n");
    run_for(1900ms);
    EXPECT_THAT(events.lines, IsEmpty());
    run_for(2s);
    ASSERT_THAT(events.reports, SizeIs(1));
    EXPECT_EQ(events.reports.front().records.count(), RecordCount{2});
}

TEST_P(AnyDropFolder, shouldTakeRenamedFilesAtOnceIfThatIsTheRule) {
    settings.settle.by = SettleBy::renaming;
    start();
    drop(".a.csv.part");
    run_for(1s);
    fs::rename(settings.folder / ".a.csv.part", settings.folder / "a.csv");
    run_for(1100ms);
    EXPECT_THAT(events.lines, ElementsAre("a.csv: imported"));
}

TEST_P(AnyDropFolder, shouldTakeAFileWhenItsMarkComesAndRemoveTheMark) {
    settings.settle.by = SettleBy::done_mark;
    start();
    drop("a.csv");
    run_for(20s);
    EXPECT_THAT(events.lines, IsEmpty());
    EXPECT_THAT(staying(), ElementsAre("a.csv: its .done is missing"));
    drop("a.csv.done", "");
    run_for(1100ms);
    EXPECT_THAT(events.lines, ElementsAre("a.csv: imported"));
    EXPECT_THAT(names_in(""), IsEmpty());
}

TEST_P(AnyDropFolder, shouldTakeAThousandSmallFiles) {
    settings.settle.by = SettleBy::renaming;
    for (int i = 0; i < 1000; ++i) {
        drop("f" + std::to_string(i) + ".csv", "name\nrecord " + std::to_string(i) + "\n");
    }
    start();
    run();
    EXPECT_THAT(events.reports, SizeIs(1000));
    EXPECT_EQ(jobs(), 1000U);
    EXPECT_THAT(names_in("done"), SizeIs(1000));
    EXPECT_THAT(names_in(""), IsEmpty());
}

TEST_P(AnyDropFolder, shouldReportTheSameContentInsteadOfImportingItAgain) {
    drop("a.csv");
    drop("b.csv");
    start();
    run();
    drop("a.csv");
    run_for(4s);
    EXPECT_THAT(events.lines, ElementsAre("a.csv: imported", "b.csv: duplicate", "a.csv: duplicate"));
    EXPECT_EQ(jobs(), 1U);
    EXPECT_THAT(names_in("done"), ElementsAre("a.csv", "a~2.csv", "b.csv"));
    const auto report = report_of("done/a~2.csv");
    EXPECT_EQ(report["name"], "a.csv");
    EXPECT_EQ(report["verdict"], "duplicate");
    EXPECT_EQ(report["job"], 1);
    EXPECT_THAT(std::string{report["reason"]}, HasSubstr("done/a.csv"));
}

TEST_P(AnyDropFolder, shouldKeepFilesOfOneNameApart) {
    settings.settle.by = SettleBy::renaming;
    start();
    for (int i = 0; i < 4; ++i) {
        drop("part", "name\n" + std::to_string(i) + (i == 2 ? "\x01" : "") + "\n");
        fs::rename(settings.folder / "part", settings.folder / "batch.csv");
        run_for(1100ms);
    }
    EXPECT_THAT(names_in("done"), ElementsAre("batch.csv", "batch~2.csv", "batch~4.csv"));
    EXPECT_THAT(names_in("failed"), ElementsAre("batch~3.csv"));
}

TEST_F(DropFolderTest, shouldHoldAFileThatIsOpenForWriting) {
    start();
    {
        std::ofstream file{settings.folder / "a.csv"};
        file << "name\nA\n" << std::flush;
        run_for(60s);
        EXPECT_THAT(events.lines, IsEmpty());
        EXPECT_THAT(events.notes, ElementsAre("a.csv: it is open for writing"));
        file << "B\n";
    }
    run_for(3s);
    ASSERT_THAT(events.reports, SizeIs(1));
    EXPECT_EQ(events.reports.front().records.count(), RecordCount{2});
}

TEST_F(DropFolderTest, shouldFindWhatHappenedWhileEventsWereLost) {
    settings.rescan = 24h;
    std::size_t most = 16384;
    std::ifstream{"/proc/sys/fs/inotify/max_queued_events"} >> most;
    start();
    run_for(200ms);
    drop("0");
    for (std::size_t i = 0; i < most; ++i) {
        fs::rename(settings.folder / std::to_string(i), settings.folder / std::to_string(i + 1));
    }
    drop("a.csv");
    run_for(5s);
    EXPECT_THAT(events.lines, ElementsAre("a.csv: imported"));
}

TEST_F(DropFolderTest, shouldNotComeToRestBeforeItHasLookedForWhatItMissed) {
    settings.rescan = 24h;
    std::size_t most = 16384;
    std::ifstream{"/proc/sys/fs/inotify/max_queued_events"} >> most;
    start();
    run();
    drop("0");
    for (std::size_t i = 0; i < most; ++i) {
        fs::rename(settings.folder / std::to_string(i), settings.folder / std::to_string(i + 1));
    }
    drop("a.csv");
    run();
    EXPECT_THAT(events.lines, ElementsAre("a.csv: imported"));
}

TEST_F(DropFolderTest, shouldHoldAnEmptyFileThatIsStillOpen) {
    start();
    {
        std::ofstream file{settings.folder / "a.csv"};
        run_for(60s);
        EXPECT_THAT(events.lines, IsEmpty());
        EXPECT_THAT(staying(), ElementsAre("a.csv: it is empty, and whoever made it has not closed it yet"));
        file << "name\nA\n";
    }
    run_for(3s);
    EXPECT_THAT(events.lines, ElementsAre("a.csv: imported"));
}

TEST_F(DropFolderTest, shouldTakeOthersWhileAFileChangesAndChanges) {
    drop("a.csv", "name\nA\n");
    start();
    bool others = false;
    events.on_step = [&](DropStep step) {
        if (step == DropStep::claimed && !others) {
            others = true;
            drop("b.csv", "name\nB\n");
            drop("c.csv", "name\nC\n");
        }
        if (step == DropStep::hashed) {
            std::ofstream{settings.folder / "processing/a.csv", std::ios::app} << "more\n";
        }
    };
    int busy = 0;
    for (const Instant end = now + 20s; now < end; ++busy) {
        const auto next = folder->step(now);
        ASSERT_TRUE(next.has_value());
        ASSERT_LT(busy, 1000) << "it is asked again and again while there is nothing to do";
        now = next->more ? now : std::max(now, next->at);
    }
    EXPECT_THAT(events.lines, ElementsAre("b.csv: imported", "c.csv: imported"));
    EXPECT_THAT(names_in("processing"), ElementsAre("a.csv"));
    events.on_step = {};
    run();
    EXPECT_THAT(names_in("done"), ElementsAre("a.csv", "b.csv", "c.csv"));
}

TEST_F(DropFolderTest, shouldNotTakeAFileForAnotherOnesReport) {
    settings.pattern = "*";
    settings.settle.by = SettleBy::renaming;
    drop("a.csv", "name\nA\n");
    start();
    bool changed = false;
    events.on_step = [&](DropStep step) {
        if (step == DropStep::hashed && !changed) {
            changed = true; // it has to wait, and the other goes before it
            std::ofstream{settings.folder / "processing/a.csv", std::ios::app} << "more\n";
            drop(".part", "name\nB\n");
            fs::rename(settings.folder / ".part", settings.folder / "a.csv.report.json");
        }
    };
    run_for(5s);
    EXPECT_THAT(events.lines, ElementsAre("a.csv.report.json: imported", "a.csv: imported"));
    EXPECT_EQ(report_of("done/a.csv")["name"], "a.csv");
    EXPECT_EQ(report_of("done/a.csv.report~2.json")["name"], "a.csv.report.json");
    EXPECT_TRUE(fs::exists(settings.folder / "done/a.csv.report~2.json"));
}

TEST_F(DropFolderTest, shouldNameTheRowsThatCannotBePrinted) {
    drop("a.csv", "name,code\nA,1\nB\nC,\x01\n");
    start();
    run();
    EXPECT_THAT(names_in("failed"), ElementsAre("a.csv"));
    const auto report = report_of("failed/a.csv");
    EXPECT_EQ(report["reason"], "2 of 3 rows cannot be printed; the first: line 3: 1 field instead of 2");
    EXPECT_EQ(report["job"], nullptr);
    EXPECT_EQ(report["sha256"].get<std::string>().size(), 64U);
    EXPECT_EQ(report["import"]["reported"][1]["line"], 4);
    EXPECT_EQ(report["import"]["reported"][1]["column"], "code");
    EXPECT_EQ(jobs(), 0U);
}

TEST_F(DropFolderTest, shouldLeaveBadRowsOutIfAsked) {
    settings.layout.skip_bad = true;
    drop("a.csv", "name,code\nA,1\nB\n");
    start();
    run();
    EXPECT_THAT(events.lines, ElementsAre("a.csv: imported"));
    EXPECT_THAT(report_of("done/a.csv")["reason"].get<std::string>(), HasSubstr("1 of 2 rows"));
}

TEST_F(DropFolderTest, shouldRejectWhatDoesNotFitTheLayout) {
    settings.layout.columns = {"code"};
    drop("a.csv");
    start();
    run();
    EXPECT_THAT(events.lines, ElementsAre("a.csv: failed"));
    EXPECT_THAT(events.reports.front().reason, HasSubstr("code"));
    EXPECT_THAT(events.reports.front().reason, testing::Not(HasSubstr("processing")));
}

TEST_F(DropFolderTest, shouldRejectAnEmptyFileAfterAWhile) {
    start();
    drop("a.csv", "");
    run_for(9s);
    EXPECT_THAT(events.lines, IsEmpty());
    run_for(2s);
    EXPECT_THAT(events.lines, ElementsAre("a.csv: failed"));
    EXPECT_EQ(events.reports.front().reason, "the file is empty");
}

TEST_F(DropFolderTest, shouldRejectAFileThatIsTooLargeUnread) {
    settings.max_bytes = 1'000'000'000;
    drop("huge.csv");
    fs::resize_file(settings.folder / "huge.csv", 1ULL << 42U); // a hole: it takes no place
    start();
    run();
    EXPECT_THAT(events.lines, ElementsAre("huge.csv: failed"));
    EXPECT_THAT(events.reports.front().reason, HasSubstr("4398046511104 bytes"));
}

TEST_F(DropFolderTest, shouldRejectAFileThatItMayNotRead) {
    drop("a.csv");
    fs::permissions(settings.folder / "a.csv", fs::perms::none);
    fs::permissions(directory, fs::perms::all);
    fs::permissions(settings.folder, fs::perms::all);
    const uid_t root = ::geteuid();
    const uid_t nobody = 65534;
    if (root == 0) {
        ASSERT_EQ(::seteuid(nobody), 0);
    }
    start();
    run();
    if (root == 0) {
        ASSERT_EQ(::seteuid(root), 0);
    }
    EXPECT_THAT(events.lines, ElementsAre("a.csv: failed"));
    EXPECT_EQ(events.reports.front().reason, "no permission to read it");
}

TEST_F(DropFolderTest, shouldHoldAFileThatItMayNotMove) {
    if (::geteuid() != 0) {
        GTEST_SKIP() << "only root can make a file that another may not move";
    }
    start();
    drop("a.csv");
    fs::permissions(directory, fs::perms::all);
    fs::permissions(settings.folder, fs::perms::all | fs::perms::sticky_bit);
    ASSERT_EQ(::seteuid(65534), 0);
    run_for(60s);
    ASSERT_EQ(::seteuid(0), 0);
    EXPECT_THAT(events.lines, IsEmpty());
    ASSERT_THAT(events.notes, SizeIs(1));
    EXPECT_THAT(events.notes.front(), HasSubstr("a.csv: it cannot be moved to processing/"));
    run_for(60s);
    EXPECT_THAT(events.lines, ElementsAre("a.csv: imported"));
}

TEST_F(DropFolderTest, shouldForgetFilesThatVanish) {
    start();
    drop("before.csv");
    run_for(1s);
    fs::remove(settings.folder / "before.csv");
    run_for(3s);
    events.on_step = [&](DropStep step) {
        if (step == DropStep::settled) {
            fs::remove(settings.folder / "between.csv");
        }
        if (step == DropStep::claimed) {
            fs::remove(settings.folder / "processing/behind.csv");
        }
        if (step == DropStep::hashed) {
            fs::remove(settings.folder / "processing/reading.csv");
        }
        if (step == DropStep::reported) {
            fs::remove(settings.folder / "processing/reported.csv");
        }
    };
    for (const char* const name : {"between.csv", "behind.csv", "reading.csv", "reported.csv"}) {
        drop(name, std::string{"name\n"} + name + "\n");
        run_for(6s);
    }
    EXPECT_THAT(events.lines, ElementsAre("reported.csv: imported"));
    EXPECT_EQ(jobs(), 1U);
    EXPECT_THAT(events.notes,
                ElementsAre("behind.csv: it has vanished from processing/",
                            "reading.csv: it was changed while it was read: it is read again when it is complete",
                            "reading.csv: it has vanished from processing/",
                            "reported.csv: it has vanished from processing/"));
}

TEST_F(DropFolderTest, shouldRejectWhatIsNoFileAndFollowNothing) {
    std::ofstream{directory / "secret.csv"} << "name\nsecret\n";
    fs::create_symlink(directory / "secret.csv", settings.folder / "link.csv");
    fs::create_symlink("nowhere", settings.folder / "dangling.csv");
    fs::create_symlink("loop.csv", settings.folder / "loop.csv");
    ASSERT_EQ(::mkfifo((settings.folder / "pipe.csv").c_str(), 0666), 0);
    const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string path = (settings.folder / "s.csv").string();
    ASSERT_LT(path.size(), sizeof address.sun_path);
    std::ranges::copy(path, address.sun_path);
    ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ::close(socket);
    start();
    run();
    EXPECT_THAT(names_in("failed"), ElementsAre("dangling.csv", "link.csv", "loop.csv", "pipe.csv", "s.csv"));
    EXPECT_THAT(report_of("failed/link.csv")["reason"].get<std::string>(), HasSubstr("symbolic link"));
    EXPECT_THAT(report_of("failed/pipe.csv")["reason"].get<std::string>(), HasSubstr("pipe"));
    EXPECT_TRUE(fs::is_symlink(settings.folder / "failed/link.csv"));
    EXPECT_TRUE(fs::exists(directory / "secret.csv"));
    EXPECT_EQ(jobs(), 0U);
}

TEST_F(DropFolderTest, shouldNotFollowALinkThatTakesThePlaceOfAFile) {
    std::ofstream{directory / "secret.csv"} << "name\nsecret\n";
    drop("a.csv");
    start();
    events.on_step = [&](DropStep step) {
        if (step == DropStep::settled) {
            fs::remove(settings.folder / "a.csv");
            fs::create_symlink(directory / "secret.csv", settings.folder / "a.csv");
        }
    };
    run();
    EXPECT_THAT(events.lines, ElementsAre("a.csv: failed"));
    EXPECT_EQ(jobs(), 0U);
}

TEST_F(DropFolderTest, shouldReadAgainWhatIsChangedWhileItIsRead) {
    int changes = 0;
    for (const DropStep moment : {DropStep::claimed, DropStep::hashed}) {
        const std::string name = "a" + std::to_string(static_cast<int>(moment)) + ".csv";
        drop(name, "name\n" + name + "\n");
        start();
        events.on_step = [&](DropStep step) {
            if (step == moment && changes++ < 3) {
                std::ofstream{settings.folder / "processing" / name, std::ios::app} << "more\n";
            }
        };
        run();
        ASSERT_FALSE(events.reports.empty());
        EXPECT_EQ(events.reports.back().verdict, DropVerdict::imported);
        EXPECT_EQ(events.reports.back().records.count().value(), moment == DropStep::claimed ? 2U : 4U);
        changes = 0;
    }
    EXPECT_EQ(jobs(), 2U);
}

TEST_F(DropFolderTest, shouldLeaveDirectoriesAndFilesWithSecondNames) {
    fs::create_directory(settings.folder / "dir.csv");
    std::ofstream{directory / "mine.csv"} << "name\nA\n";
    fs::create_hard_link(directory / "mine.csv", settings.folder / "hard.csv");
    start();
    run_for(60s);
    EXPECT_THAT(events.lines, IsEmpty());
    EXPECT_THAT(events.notes, SizeIs(2));
    EXPECT_THAT(staying(), ElementsAre("dir.csv: this is a directory", HasSubstr("hard.csv: it has 2 names")));
    fs::remove(directory / "mine.csv");
    run_for(60s);
    EXPECT_THAT(events.lines, ElementsAre("hard.csv: imported"));
}

TEST_F(DropFolderTest, shouldStandAnyName) {
    const std::vector<std::string> wild{"new\nline.csv",
                                        "tab\t\x1B[31m.csv",
                                        "\xFF\xFE.csv",
                                        "-rf ~.csv",
                                        "$(reboot).csv",
                                        "..csv",
                                        "a.csv.report.json",
                                        "a.csv",
                                        "done.csv",
                                        std::string(NAME_MAX - 4, 'n') + ".csv",
                                        std::string(NAME_MAX - 5, 'n') + ".csv"};
    settings.pattern = "[!.]*";
    for (std::size_t i = 0; i < wild.size(); ++i) {
        if (wild[i].front() != '.') {
            drop(wild[i], "name\n" + std::to_string(i) + "\n");
        }
    }
    drop(".lock", "name\nlock\n");
    drop(".report", "name\nreport\n");
    start();
    run();
    settings.pattern = ".*"; // hidden names too, if somebody asks for them
    drop("..csv", "name\ndots\n");
    start();
    run();
    EXPECT_THAT(names_in(""), IsEmpty());
    EXPECT_THAT(names_in("failed"), IsEmpty());
    EXPECT_EQ(jobs(), wild.size() + 2);
    for (const DropReport& report : events.reports) {
        EXPECT_TRUE(fs::exists(settings.folder / report.kept_as)) << report.kept_as;
        EXPECT_TRUE(report_of(report.kept_as).is_object()) << report.kept_as;
    }
}

TEST_F(DropFolderTest, shouldReadDatabasesAndLeaveThoseInUse) {
    settings.pattern = "*.sqlite";
    fs::rename(database("CREATE TABLE t (a TEXT); INSERT INTO t VALUES ('7')"), settings.folder / "a.sqlite");
    fs::rename(database("PRAGMA journal_mode = WAL; CREATE TABLE t (a TEXT); INSERT INTO t VALUES ('8')"),
               settings.folder / "b.sqlite");
    drop("c.sqlite", "name\nx\n");
    drop("c.sqlite-wal", "rows that are not in it yet");
    start();
    run();
    EXPECT_THAT(events.lines, ElementsAre("a.sqlite: imported", "b.sqlite: imported"));
    EXPECT_THAT(staying(), ElementsAre("c.sqlite: its -wal lies beside it: it is in use"));
    EXPECT_THAT(names_in("processing"), IsEmpty());
    EXPECT_THAT(names_in("done"), ElementsAre("a.sqlite", "b.sqlite"));
}

TEST_F(DropFolderTest, shouldTakeNoOtherPlaceForItsFolders) {
    EXPECT_EQ(DropFolder::open({.folder = directory / "missing"}, *batches, events).error().kind, FailureKind::usage);
    EXPECT_EQ(DropFolder::open({.folder = write("x")}, *batches, events).error().kind, FailureKind::usage);
    fs::create_directory(directory / "elsewhere");
    fs::create_directory_symlink(directory / "elsewhere", settings.folder / "done");
    EXPECT_EQ(DropFolder::open(settings, *batches, events).error().kind, FailureKind::usage);
    fs::remove(settings.folder / "done");
    drop("done", "");
    EXPECT_EQ(DropFolder::open(settings, *batches, events).error().kind, FailureKind::usage);
}

TEST_F(DropFolderTest, shouldBelongToOneProcess) {
    start();
    const auto second = DropFolder::open(settings, *batches, events);
    ASSERT_FALSE(second.has_value());
    EXPECT_THAT(second.error().message, HasSubstr("in use by another linefeed"));
}

TEST_F(DropFolderTest, shouldNotOverwriteWhatOthersPutIntoItsFolders) {
    drop("a.csv");
    start();
    events.on_step = [&](DropStep step) {
        if (step == DropStep::imported) {
            std::ofstream{settings.folder / "done/a.csv"} << "mine";
        }
    };
    run();
    EXPECT_THAT(names_in("done"), ElementsAre("a.csv", "a~2.csv"));
    EXPECT_EQ(fs::file_size(settings.folder / "done/a.csv"), 4U);
    EXPECT_EQ(report_of("done/a~2.csv")["kept_as"], "done/a~2.csv");
}

TEST_F(DropFolderTest, shouldFailWhenTheFolderIsRemoved) {
    settings.mode = WatchMode::poll;
    start();
    run_for(1s);
    fs::remove_all(settings.folder);
    now += 2s;
    const auto next = folder->step(now);
    ASSERT_FALSE(next.has_value());
    EXPECT_THAT(next.error().message, HasSubstr("removed"));
}

TEST_P(AnyDropFolder, shouldFailWhenOneOfItsFoldersIsNotWhereItWas) {
    for (const char* const inner : {"", "processing", "done", "failed"}) {
        start();
        run_for(1s);
        fs::rename(settings.folder / inner / "", directory / "elsewhere");
        now += 1min;
        auto next = folder->step(now);
        ASSERT_FALSE(next.has_value()) << inner;
        EXPECT_EQ(next.error().kind, FailureKind::storage);
        EXPECT_THAT(next.error().message, HasSubstr("removed"));
        fs::create_directory(settings.folder / inner);
        next = folder->step(now);
        ASSERT_FALSE(next.has_value()) << inner;
        EXPECT_THAT(next.error().message, HasSubstr("replaced"));
        start();
        drop("a.csv");
        run();
        EXPECT_THAT(events.lines, SizeIs(1)) << inner;
        EXPECT_THAT(names_in(""), IsEmpty());
        fs::remove_all(directory / "elsewhere");
        events.lines.clear();
    }
}

TEST_F(DropFolderTest, shouldKnowItsOwnJobWhenTheFileCouldNotBeMovedAtFirst) {
    drop("a.csv");
    start();
    bool once = false;
    events.on_step = [&](DropStep step) {
        if (step == DropStep::reported && !once) {
            once = true;
            std::ofstream{settings.folder / "done/a.csv"} << "mine";
        }
    };
    const auto failure = run();
    ASSERT_TRUE(failure);
    EXPECT_EQ(failure->kind, FailureKind::storage);
    EXPECT_THAT(names_in("processing"), ElementsAre("a.csv"));
    EXPECT_EQ(run(), std::nullopt);
    EXPECT_THAT(events.lines, ElementsAre("a.csv: imported", "a.csv: imported"));
    EXPECT_EQ(report_of("done/a~2.csv")["verdict"], "imported");
    EXPECT_EQ(jobs(), 1U);
}

TEST_F(DropFolderTest, shouldKeepAFileUntilItsReportIsWritten) {
    drop("a.csv", "name\n\x01\n");
    start();
    fs::create_directory(settings.folder / "failed/.report");
    EXPECT_EQ(run()->kind, FailureKind::storage);
    EXPECT_EQ(run()->kind, FailureKind::storage);
    EXPECT_THAT(events.lines, IsEmpty());
    EXPECT_THAT(names_in("processing"), ElementsAre("a.csv"));
    fs::remove(settings.folder / "failed/.report");
    EXPECT_EQ(run(), std::nullopt);
    EXPECT_THAT(events.lines, ElementsAre("a.csv: failed"));
    EXPECT_EQ(report_of("failed/a.csv")["verdict"], "failed");
}

TEST_F(DropFolderTest, shouldKeepAFileThatCannotBeOpenedForNow) {
    drop("a.csv");
    start();
    rlimit limit{};
    ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &limit), 0);
    events.on_step = [&](DropStep step) {
        const rlimit none{0, limit.rlim_max};
        if (step == DropStep::claimed) {
            ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
        }
    };
    const auto failure = run();
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &limit), 0);
    ASSERT_TRUE(failure);
    EXPECT_EQ(failure->kind, FailureKind::internal);
    EXPECT_THAT(failure->message, HasSubstr("processing/a.csv: Too many open files"));
    EXPECT_EQ(run(), std::nullopt);
    EXPECT_THAT(events.lines, ElementsAre("a.csv: imported"));
}

TEST_F(DropFolderTest, shouldNotJudgeAFileThatIsBeingWrittenAnew) {
    settings.settle.by = SettleBy::renaming;
    drop("a.csv", "name\nA\n");
    start();
    bool once = false;
    events.on_step = [&](DropStep step) {
        if (step == DropStep::hashed && !once) {
            once = true;
            fs::resize_file(settings.folder / "processing/a.csv", 0);
        }
    };
    run_for(1s);
    EXPECT_THAT(events.lines, IsEmpty());
    EXPECT_THAT(names_in("processing"), ElementsAre("a.csv"));
    std::ofstream{settings.folder / "processing/a.csv"} << "name\nB\nC\n";
    run_for(5s);
    ASSERT_THAT(events.lines, ElementsAre("a.csv: imported"));
    EXPECT_EQ(events.reports.front().records.count(), RecordCount{2});
}

TEST_F(DropFolderTest, shouldBreakOffALongFileAndTakeItUpAtTheNextStart) {
    std::string rows = "name\n";
    for (int i = 0; i < 100'000; ++i) {
        rows += "a name that is long enough to make this file last " + std::to_string(i) + "\n";
    }
    drop("a.csv", rows);
    start();
    events.break_off = true;
    const auto failure = run();
    ASSERT_TRUE(failure);
    EXPECT_EQ(failure->kind, FailureKind::stopped);
    EXPECT_EQ(jobs(), 0U);
    EXPECT_THAT(names_in("processing"), ElementsAre("a.csv"));
    events.break_off = false;
    start_anew();
    run();
    EXPECT_THAT(events.lines, ElementsAre("a.csv: imported"));
    EXPECT_GT(events.progress_calls, 2);
}

/// `linefeed print FOLDER/done/NAME` goes on with the job of the drop folder.
TEST_F(DropFolderTest, shouldMakeJobsThatAreFoundByTheFileInDone) {
    drop("a.csv");
    start();
    run();
    const auto source = fingerprint(settings.folder / "done/a.csv").value();
    const auto job = spool->find_by_source({source, canonical_json(settings.layout), {}}).value();
    ASSERT_TRUE(job);
    EXPECT_EQ(job->id, *events.reports.front().job);
}

TEST_F(DropFolderTest, shouldNotTakeTheMarkOfAnEarlierFileForThatOfTheNext) {
    settings.settle.by = SettleBy::done_mark;
    start();
    drop("a.csv.done", "");
    std::this_thread::sleep_for(20ms); // the kernel's clock of files is coarse
    drop("a.csv");
    run_for(60s);
    EXPECT_THAT(events.lines, IsEmpty());
    EXPECT_THAT(events.notes, ElementsAre("a.csv: its .done is older than its last change"));
}

/// Who drops may wait for nothing but that the name is free.
TEST_F(DropFolderTest, shouldLeaveTheMarkOfTheNextFile) {
    settings.settle.by = SettleBy::done_mark;
    drop("a.csv", "name\nA\n");
    drop("a.csv.done", "");
    start();
    bool next = false;
    events.on_step = [&](DropStep step) {
        if (step == DropStep::claimed && !next) {
            next = true;
            std::this_thread::sleep_for(20ms);
            drop("a.csv", "name\nB\n");
            drop("a.csv.done", "");
        }
    };
    run_for(3s);
    EXPECT_THAT(events.lines, ElementsAre("a.csv: imported", "a.csv: imported"));
    EXPECT_EQ(jobs(), 2U);
    EXPECT_THAT(names_in(""), IsEmpty());
}

/// What came while nobody was there to take it is told from what comes now, whenever it was written.
TEST_F(DropFolderTest, shouldTellWhatIsLeftOverFromBeforeTheStart) {
    const auto pause = [] { std::this_thread::sleep_for(std::chrono::milliseconds{30}); };
    drop("old.csv", "name\nA\n");
    std::ofstream{directory / "moved.csv"} << "name\nB\n";
    pause();
    settings.started_ns = std::chrono::system_clock::now().time_since_epoch() / std::chrono::nanoseconds{1};
    pause();
    drop("new.csv", "name\nC\n");
    std::filesystem::rename(directory / "moved.csv", settings.folder / "moved.csv");
    start();
    ASSERT_FALSE(run());
    EXPECT_THAT(events.left_over_names, ElementsAre("old.csv"));
    EXPECT_EQ(jobs(), 3U);
}

} // namespace
} // namespace linefeed::intake
