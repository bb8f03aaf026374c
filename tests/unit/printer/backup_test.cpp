// A printer's files in a folder and back, also when it breaks off, when the folder was tampered with, or is not the
// printer's.
#include "printer/backup.hpp"
#include "printer/local_file.hpp"
#include "support/peer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>

namespace linefeed::printer {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

const OnBackup go_on = [](const BackupProgress&) { return true; };

/// Files in memory, and a failure when so many were read.
class MemoryFiles : public PrinterFiles {
public:
    Result<protocol::VersionInfo> identity() override {
        protocol::VersionInfo info;
        info.type = "JET3up";
        info.serial_number = serial_number;
        return info;
    }
    Result<std::string> loaded_job() override { return std::string{"\\FFSDISK\\Jobs\\A.job"}; }
    Result<std::vector<protocol::DirectoryEntry>> list(const std::string& directory) override {
        std::vector<protocol::DirectoryEntry> entries;
        for (const auto& [path, bytes] : files) {
            if (path.substr(0, path.rfind('\\')) == directory) {
                entries.push_back({path.substr(path.rfind('\\') + 1), false});
            }
        }
        if (directory == "FFSDISK\\Jobs") {
            entries.push_back({"Sub", true});
        }
        return entries;
    }
    Result<std::string> read(const std::string& path) override {
        if (reads_left-- == 0) {
            return Failure{FailureKind::unreachable, "cut"};
        }
        ++reads;
        return files.contains(path) ? files[path] : std::string{};
    }
    Result<bool> exists(const std::string& path) override { return files.contains(path); }
    Result<void> write(const std::string& path, std::string_view bytes) override {
        files[path] = corrupting ? "?" : std::string{bytes};
        ++writes;
        return {};
    }

    std::map<std::string, std::string> files{{"FFSDISK\\Jobs\\A.job", "job A"},
                                             {"FFSDISK\\Jobs\\empty.job", ""},
                                             {"FFSDISK\\Jobs\\Sub\\B.job", "job B"},
                                             {"FFSDISK\\Fonts\\..x%\xF6.lft", std::string("\0\r\n^\\", 5)}};
    std::string serial_number = "104711";
    int reads_left = -1;
    int reads = 0;
    int writes = 0;
    bool corrupting = false;
};

class BackupTest : public testing::Test {
protected:
    BackupTest() {
        std::string pattern = testing::TempDir() + "linefeed-XXXXXX";
        scratch_ = ::mkdtemp(pattern.data());
        folder_ = scratch_ / "backup";
    }
    ~BackupTest() override { fs::remove_all(scratch_); }

    fs::path scratch_;
    fs::path folder_;
    MemoryFiles printer_;
};

TEST_F(BackupTest, shouldSaveAndRestoreASimulatedPrinter) {
    RunningSimulator simulated;
    const auto client = PrinterClient::connect(simulated.settings()).value();
    ConversationFiles files{*client};
    const auto report = back_up(files, folder_, go_on);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->manifest.files.size(), 15U);
    EXPECT_EQ(report->manifest.printer.serial_number, "104711");
    EXPECT_EQ(check_backup(folder_).value(), report->manifest);

    const std::string job = "FFSDISK\\Jobs\\DM.JOB";
    const std::string before = files.read(job).value();
    ASSERT_TRUE(remove_file(*client, job));
    ASSERT_TRUE(files.write("FFSDISK\\Fonts\\ISO1_5x5.lft", "spoilt"));
    const auto restored = restore(files, folder_);
    ASSERT_TRUE(restored) << restored.error().message;
    EXPECT_EQ(restored->written, 2U);
    EXPECT_EQ(restored->alike, 13U);
    EXPECT_EQ(files.read(job).value(), before);
}

TEST_F(BackupTest, shouldHoldEveryFileByteForByteWhateverItsName) {
    const auto saved = printer_.files;
    ASSERT_TRUE(back_up(printer_, folder_, go_on));
    printer_.files.clear();
    const auto restored = restore(printer_, folder_);
    ASSERT_TRUE(restored) << restored.error().message;
    EXPECT_EQ(printer_.files, saved);
}

TEST_F(BackupTest, shouldGoOnWhereItBrokeOff) {
    printer_.files.erase("FFSDISK\\Fonts\\..x%\xF6.lft");
    printer_.reads_left = 1;
    ASSERT_EQ(back_up(printer_, folder_, go_on).error().kind, FailureKind::unreachable);
    EXPECT_FALSE(fs::exists(folder_ / manifest_name));
    std::ofstream{folder_ / partial_name, std::ios::app} << "{\"path\": \"torn";
    printer_.reads_left = -1;
    printer_.reads = 0;
    const auto report = back_up(printer_, folder_, go_on);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->taken_before, 1U);
    EXPECT_EQ(printer_.reads, 2);
    EXPECT_EQ(check_backup(folder_)->files.size(), 3U);
    EXPECT_FALSE(fs::exists(folder_ / partial_name));
    EXPECT_EQ(back_up(printer_, folder_, go_on).error().kind, FailureKind::usage) << "it is whole";
}

TEST_F(BackupTest, shouldBeBrokenOffOnRequest) {
    EXPECT_EQ(back_up(printer_, folder_, [](const BackupProgress&) { return false; }).error().kind,
              FailureKind::stopped);
    printer_.serial_number = "other";
    EXPECT_THAT(back_up(printer_, folder_, go_on).error().message,
                HasSubstr("beginning of a backup of JET3up no. 104711"));
}

TEST_F(BackupTest, shouldSaveAFileAgainThatIsNotWhatItWas) {
    printer_.reads_left = 1;
    ASSERT_FALSE(back_up(printer_, folder_, go_on));
    std::ofstream{folder_ / saved_as("FFSDISK\\Jobs\\A.job")} << "spoilt";
    printer_.reads_left = -1;
    EXPECT_EQ(back_up(printer_, folder_, go_on)->taken_before, 0U);
}

TEST_F(BackupTest, shouldBeginAnewWhereNothingOfTheFirstRunIsThere) {
    fs::create_directories(folder_);
    std::ofstream{folder_ / partial_name} << "{";
    EXPECT_TRUE(back_up(printer_, folder_, go_on));
}

TEST_F(BackupTest, shouldRefuseNamesThatLeadElsewhere) {
    for (const char* const name : {"FFSDISK\\Fonts\\..", "FFSDISK\\Fonts\\a/b", "FFSDISK\\Fonts\\a\tb"}) {
        printer_.files[name] = "x";
        EXPECT_THAT(back_up(printer_, folder_, go_on).error().message, HasSubstr("no name of a file")) << name;
        printer_.files.erase(name);
    }
}

TEST_F(BackupTest, shouldRefuseAPrinterWithoutFiles) {
    printer_.files.clear();
    EXPECT_EQ(back_up(printer_, folder_, go_on).error().kind, FailureKind::input);
}

TEST_F(BackupTest, shouldSayThatTheFolderCannotBeWritten) {
    std::ofstream{folder_} << "a file";
    EXPECT_EQ(back_up(printer_, folder_, go_on).error().kind, FailureKind::storage);
}

class RestoreTest : public BackupTest {
protected:
    RestoreTest() {
        printer_.files.erase("FFSDISK\\Fonts\\..x%\xF6.lft");
        EXPECT_TRUE(back_up(printer_, folder_, go_on));
    }
    void expect_refused(FailureKind kind, std::string_view words, const RestoreOptions& options = {}) {
        printer_.writes = 0;
        printer_.files.clear();
        const auto restored = restore(printer_, folder_, options);
        ASSERT_FALSE(restored);
        EXPECT_EQ(restored.error().kind, kind);
        EXPECT_THAT(restored.error().message, HasSubstr(std::string{words}));
        EXPECT_EQ(printer_.writes, 0);
    }
    void replace_in_manifest(const std::string& what, const std::string& with) {
        std::string text = read_file(folder_ / manifest_name, 100000).value();
        text.replace(text.find(what), what.size(), with);
        std::ofstream{folder_ / manifest_name} << text;
    }
};

TEST_F(RestoreTest, shouldWriteOnlyWhatDiffers) {
    printer_.files["FFSDISK\\Jobs\\A.job"] = "changed";
    printer_.files["FFSDISK\\Jobs\\new.job"] = "new";
    const auto restored = restore(printer_, folder_).value();
    EXPECT_EQ(restored.written, 1U);
    EXPECT_EQ(restored.alike, 1U);
    EXPECT_THAT(restored.skipped, ElementsAre("FFSDISK\\Jobs\\empty.job"));
    EXPECT_EQ(printer_.files["FFSDISK\\Jobs\\A.job"], "job A");
    EXPECT_EQ(printer_.files["FFSDISK\\Jobs\\new.job"], "new");
}

TEST_F(RestoreTest, shouldMakeEmptyFilesWhereThereAreNone) {
    printer_.files.clear();
    EXPECT_EQ(restore(printer_, folder_)->written, 3U);
    EXPECT_TRUE(printer_.files.contains("FFSDISK\\Jobs\\empty.job"));
}

TEST_F(RestoreTest, shouldWriteNothingUnlessTheWholeBackupIsSound) {
    std::ofstream{folder_ / saved_as("FFSDISK\\Jobs\\Sub\\B.job")} << "job C";
    expect_refused(FailureKind::input, "not the file that was saved");
    fs::remove(folder_ / saved_as("FFSDISK\\Jobs\\Sub\\B.job"));
    expect_refused(FailureKind::input, "Sub/B.job");
}

TEST_F(RestoreTest, shouldRefuseAManifestThatIsNone) {
    replace_in_manifest("\"path\": \"FFSDISK\\\\Jobs\\\\A.job", "\"path\": \""
                                                                "..\\\\..\\\\A.job");
    expect_refused(FailureKind::input, "none of the printer's directories");
    replace_in_manifest("..\\\\..\\\\A.job", "FFSDISK\\\\Jobs\\\\empty.job");
    expect_refused(FailureKind::input, "twice");
    replace_in_manifest("\"linefeed_backup\": 1", "\"linefeed_backup\": 2");
    expect_refused(FailureKind::input, "does not know: 2");
    std::ofstream{folder_ / manifest_name} << "[]";
    expect_refused(FailureKind::input, "is none");
    std::ofstream{folder_ / manifest_name} << R"({"linefeed_backup": 1})";
    expect_refused(FailureKind::input, "no list of files");
    std::ofstream{folder_ / manifest_name} << R"({"linefeed_backup": 1, "files": [{}]})";
    expect_refused(FailureKind::input, "without path, size or sha256");
    std::ofstream{folder_ / manifest_name} << R"({"linefeed_backup": 1, "printer": 1})";
    expect_refused(FailureKind::input, "names no printer");
    fs::remove(folder_ / manifest_name);
    expect_refused(FailureKind::input, "manifest.json");
}

TEST_F(RestoreTest, shouldAskBeforeItWritesToAnotherPrinter) {
    printer_.serial_number = "104712";
    expect_refused(FailureKind::usage, "of JET3up no. 104711, this is JET3up no. 104712");
    RestoreOptions options;
    options.other_printer = true;
    EXPECT_TRUE(restore(printer_, folder_, options));
}

TEST_F(RestoreTest, shouldNoticeThatThePrinterDoesNotGiveBackWhatWasWritten) {
    printer_.files.clear();
    printer_.corrupting = true;
    EXPECT_THAT(restore(printer_, folder_).error().message, HasSubstr("does not give back"));
}

TEST_F(RestoreTest, shouldBeBrokenOffOnRequestAndGoOn) {
    printer_.files.clear();
    RestoreOptions options;
    options.on_progress = [](const BackupProgress& progress) { return progress.files < 1; };
    EXPECT_EQ(restore(printer_, folder_, options).error().kind, FailureKind::stopped);
    const auto restored = restore(printer_, folder_).value();
    EXPECT_EQ(restored.alike, 1U);
    EXPECT_EQ(restored.written, 2U);
}

} // namespace
} // namespace linefeed::printer
