// Files over lines and printers that misbehave: what arrives is right, or it is said what went wrong; never half a
// file.
#include "printer/file_transfer.hpp"
#include "support/peer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>

namespace linefeed::printer {
namespace {

using protocol::FileBlock;
using protocol::FileVerdict;
using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const std::string path = "FFSDISK\\Jobs\\Big.job";
const TransferOptions quick{.block_timeout = milliseconds{200}};

std::string some_bytes(std::size_t size) {
    std::string bytes;
    std::uint32_t state = 1;
    while (bytes.size() < size) {
        state = state * 1664525U + 1013904223U;
        bytes.push_back(static_cast<char>(state >> 24U));
    }
    return bytes;
}

std::string block(std::uint32_t number, std::string_view bytes) {
    std::string frame;
    protocol::append_message(frame, FileBlock::of(number, bytes));
    return frame;
}

std::string header(std::uint32_t blocks) {
    return "^0$FHFFSDISK\\\\Jobs\\\\Big.job\t" + std::to_string(blocks) + '\r';
}

std::string word(std::uint32_t number, FileVerdict verdict) {
    std::string frame;
    protocol::append_message(frame, protocol::FileAcknowledgement{number, verdict});
    return frame;
}

/// A printer that reacts to the frames one after the other with what it was given, and then is silent.
class ScriptedTest : public testing::Test {
protected:
    void react(std::vector<Peer::Reaction> reactions) {
        peer_.emplace([reactions = std::deque<Peer::Reaction>(reactions.begin(), reactions.end())](
                          std::string_view frame) mutable {
            if (reactions.empty() || frame.starts_with("^0$FH")) { // a header is not acknowledged
                return Peer::Reaction{};
            }
            Peer::Reaction next = reactions.front();
            reactions.pop_front();
            return next;
        });
        client_ = PrinterClient::connect(peer_->settings()).value();
    }
    /// The printer hears it, sooner or later.
    [[nodiscard]] bool hears(std::string_view words) {
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds{10};
        while (peer_->heard().find(words) == std::string::npos && std::chrono::steady_clock::now() < deadline) {
            std::this_thread::sleep_for(milliseconds{2});
        }
        return peer_->heard().find(words) != std::string::npos;
    }
    Result<std::string> get() { return download(*client_, path, quick); }

    std::optional<Peer> peer_;
    std::unique_ptr<PrinterClient> client_;
};

TEST(FileTransfer, shouldListAsTheManualShows) {
    RunningSimulator printer;
    const auto client = PrinterClient::connect(printer.settings()).value();
    EXPECT_THAT(list_files(*client, "FFSDISK\\Jobs").value(), ElementsAre(protocol::DirectoryEntry{"Jobs", true}));
    EXPECT_TRUE(list_files(*client, "FFSDISK\\Jobis").value().empty());
    const auto jobs = list_directory(*client, "FFSDISK\\Jobs").value();
    ASSERT_EQ(jobs.size(), 6U);
    EXPECT_EQ(jobs.front().name, "COUNTER.JOB");
    EXPECT_EQ(jobs.back().name, "LJ24 Test.job");
    EXPECT_EQ(list_files(*client, "FFSDISK\\Fonts\\ISO*.lft").value().size(), 9U);
}

TEST(FileTransfer, shouldPutAListOfManyBlocksTogether) {
    Peer printer{[](std::string_view) {
        std::string blocks;
        for (int i = 0; i < 3; ++i) {
            std::string frame;
            protocol::DirectoryBlock part{i == 2, std::vector<protocol::DirectoryEntry>(32, {"a.job", false})};
            protocol::append_message(frame, part, protocol::EscapeMode::backslash);
            blocks += frame;
        }
        return Peer::Reaction{blocks};
    }};
    const auto client = PrinterClient::connect(printer.settings()).value();
    EXPECT_EQ(list_files(*client, "FFSDISK\\Jobs*").value().size(), 96U);
}

TEST(FileTransfer, shouldAskInASecondWayWhereTheFirstTellsTheDirectoryOnly) {
    Peer printer{[](std::string_view frame) {
        return Peer::Reaction{frame.ends_with("Jobs\\\\*") ? "^0$DI1\t01\tA.job\r" : "^0$DI1\t01\t!Jobs\r"};
    }};
    const auto client = PrinterClient::connect(printer.settings()).value();
    EXPECT_THAT(list_directory(*client, "FFSDISK\\Jobs").value(),
                ElementsAre(protocol::DirectoryEntry{"A.job", false}));
}

TEST(FileTransfer, shouldSayThatNobodyAnswers) {
    Peer silent{[](std::string_view) { return Peer::Reaction{}; }};
    const auto client = PrinterClient::connect(silent.settings()).value();
    EXPECT_EQ(list_files(*client, "FFSDISK").error().kind, FailureKind::unreachable);
    EXPECT_EQ(list_directory(*client, "FFSDISK").error().kind, FailureKind::unreachable);
    EXPECT_EQ(remove_file(*client, path).error().kind, FailureKind::unreachable);
    EXPECT_EQ(download(*client, path, quick).error().kind, FailureKind::unreachable);
    EXPECT_EQ(upload(*client, path, "x", quick).error().kind, FailureKind::unreachable);
}

TEST(FileTransfer, shouldCarryAMegabyteUpAndDownThoughMostBlocksFail) {
    simulator::SimulatorSettings settings;
    settings.printer.block_errors = {60, 7};
    RunningSimulator printer{settings};
    const auto client = PrinterClient::connect(printer.settings()).value();
    const std::string bytes = some_bytes(std::size_t{1} << 20U);
    TransferProgress last;
    TransferOptions options;
    options.on_progress = [&last](const TransferProgress& progress) {
        last = progress;
        return true;
    };
    ASSERT_TRUE(upload(*client, path, bytes, options));
    EXPECT_EQ(last.blocks, 512U);
    EXPECT_GT(last.repeated, 400U);
    const auto back = download(*client, path, options);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_TRUE(*back == bytes);
    EXPECT_EQ(last.blocks, 512U);
    EXPECT_GT(last.repeated, 400U);
}

TEST(FileTransfer, shouldGiveUpABlockThatStaysDamaged) {
    simulator::SimulatorSettings settings;
    settings.printer.block_errors = {99, 7};
    RunningSimulator printer{settings};
    const auto client = PrinterClient::connect(printer.settings()).value();
    TransferOptions options;
    options.attempts = 5;
    const auto got = download(*client, "FFSDISK\\Jobs\\DM.JOB", options);
    ASSERT_FALSE(got);
    EXPECT_EQ(got.error().kind, FailureKind::input);
    EXPECT_THAT(got.error().message, HasSubstr("FFSDISK\\Jobs\\DM.JOB: block 1 came damaged 5 times"));
    const auto put = upload(*client, path, "content", options);
    ASSERT_FALSE(put);
    EXPECT_THAT(put.error().message, HasSubstr("refused block 1 5 times"));
    EXPECT_TRUE(list_files(*client, path).value().empty());
}

TEST(FileTransfer, shouldNotTellAMissingFileFromAnEmptyOne) {
    RunningSimulator printer;
    const auto client = PrinterClient::connect(printer.settings()).value();
    const FileSink none = [](std::string_view) -> Result<void> {
        ADD_FAILURE();
        return {};
    };
    EXPECT_EQ(download(*client, path, none, quick).value(), FileFound::empty_or_missing);
    ASSERT_TRUE(upload(*client, path, "", quick));
    EXPECT_EQ(list_files(*client, path).value().size(), 1U);
    EXPECT_EQ(download(*client, path, none, quick).value(), FileFound::empty_or_missing);
}

TEST(FileTransfer, shouldDeleteAndSayWhatItFound) {
    RunningSimulator printer;
    const auto client = PrinterClient::connect(printer.settings()).value();
    EXPECT_TRUE(remove_file(*client, "FFSDISK\\Jobs\\DM.JOB"));
    EXPECT_TRUE(list_files(*client, "FFSDISK\\Jobs\\DM.JOB").value().empty());
    EXPECT_THAT(remove_file(*client, "FFSDISK\\Jobs\\DM.JOB").error().message, HasSubstr("there is no such file"));
    EXPECT_THAT(remove_file(*client, "FFSDISK\\Jobs").error().message, HasSubstr("this is a directory"));
}

TEST(FileTransfer, shouldSayThatThePrinterHasNotDeleted) {
    Peer stubborn{[](std::string_view frame) {
        return Peer::Reaction{frame.starts_with("^0$RD") ? "^0$DI1\t01\tBig.job\r" : ""};
    }};
    const auto client = PrinterClient::connect(stubborn.settings()).value();
    EXPECT_EQ(remove_file(*client, path).error().kind, FailureKind::stopped);
}

TEST(FileTransfer, shouldRefuseWhatNoPrinterHolds) {
    RunningSimulator printer;
    const auto client = PrinterClient::connect(printer.settings()).value();
    EXPECT_EQ(upload(*client, path, std::string(max_file_bytes + 1, 'x')).error().kind, FailureKind::input);
    EXPECT_EQ(upload(*client, "D:\\x.job", "x").error().kind, FailureKind::stopped) << "the printer cancels it";
}

TEST_F(ScriptedTest, shouldTakeBlocksThatCountFromZero) {
    react({{header(2) + block(0, "one ")}, {block(1, "two")}, {}});
    EXPECT_EQ(get().value(), "one two");
    EXPECT_TRUE(hears("^0$FA0\t1\n"));
}

TEST_F(ScriptedTest, shouldAskAgainForABlockThatIsDamagedMisnumberedOrNoBlockAtAll) {
    FileBlock wrong_sum = FileBlock::of(1, "one ");
    wrong_sum.checksum ^= 1U;
    std::string damaged;
    protocol::append_message(damaged, wrong_sum);
    react({{header(2) + damaged}, {"^0$FT1\t5\tAXQ\r"}, {block(1, "one ")}, {block(3, "xxx")}, {block(2, "two")}, {}});
    EXPECT_EQ(get().value(), "one two");
    EXPECT_TRUE(hears("$FA1\t0\n^0$FA1\t0\n^0$FA1\t1\n^0$FA2\t0\n^0$FA2\t1\n"));
}

TEST_F(ScriptedTest, shouldAskForADamagedFirstBlockByItsOwnNumber) {
    FileBlock wrong_sum = FileBlock::of(0, "one ");
    wrong_sum.checksum ^= 1U;
    std::string damaged;
    protocol::append_message(damaged, wrong_sum);
    react({{header(2) + damaged}, {"^0$FT0\t5\tAXQ\r"}, {block(0, "one ")}, {block(1, "two")}, {}});
    EXPECT_EQ(get().value(), "one two");
    EXPECT_TRUE(hears("$FA0\t0\n^0$FA0\t0\n^0$FA0\t1\n^0$FA1\t1\n"));
}

TEST_F(ScriptedTest, shouldTakeABlockThatComesTwiceOnce) {
    react({{header(2) + block(1, "one ")}, {block(1, "one ")}, {block(2, "two")}, {}, {}});
    EXPECT_EQ(get().value(), "one two");
}

/// Each word about a repeated block may bring the next one twice, and so on.
TEST_F(ScriptedTest, shouldSayButOnceThatABlockHasComeAlready) {
    const std::string first = block(1, "one ");
    react({{header(2) + first}, {first + first + first}, {block(2, "two")}, {}});
    EXPECT_EQ(get().value(), "one two");
    EXPECT_TRUE(hears("$FA2\t1\n"));
    EXPECT_THAT(peer_->heard(), HasSubstr("\n^0$FA1\t1\n^0$FA1\t1\n^0$FA2\t1\n"));
}

TEST_F(ScriptedTest, shouldAskAgainWhereNothingComes) {
    react({{}, {header(2)}, {block(1, "one ")}, {}, {block(2, "two")}, {}});
    EXPECT_EQ(get().value(), "one two");
}

TEST_F(ScriptedTest, shouldGiveUpAPrinterThatFallsSilentInTheMiddle) {
    react({{header(3) + block(1, "one ")}});
    const auto got = get();
    ASSERT_FALSE(got);
    EXPECT_EQ(got.error().kind, FailureKind::unreachable);
    EXPECT_TRUE(hears("$FA2\t0\n^0$FA2\t0\n^0$FA2\t2\n"));
}

TEST_F(ScriptedTest, shouldNoticeThatTheLinkIsCutInTheMiddle) {
    react({{header(3) + block(1, "one ")}, {block(2, "two").substr(0, 9), true}});
    EXPECT_EQ(get().error().kind, FailureKind::unreachable);
    EXPECT_EQ(upload(*client_, path, "x", quick).error().kind, FailureKind::unreachable);
}

TEST_F(ScriptedTest, shouldSayThatThePrinterHasCancelled) {
    react({{header(3) + block(1, "one ")}, {word(2, FileVerdict::cancel)}});
    const auto got = get();
    ASSERT_FALSE(got);
    EXPECT_EQ(got.error().kind, FailureKind::stopped);
    EXPECT_THAT(peer_->heard(), Not(HasSubstr("\t2\n")));
}

TEST_F(ScriptedTest, shouldNotBelieveTooManyBlocks) {
    react({{header(4'000'000'000)}, {}});
    EXPECT_EQ(get().error().kind, FailureKind::input);
}

TEST_F(ScriptedTest, shouldCancelWhenItCannotKeepWhatComes) {
    react({{header(3) + block(1, "one ")}, {}, {}});
    const auto got = download(
        *client_, path,
        [](std::string_view) -> Result<void> {
            return Failure{FailureKind::storage, "disk full"};
        },
        quick);
    EXPECT_EQ(got.error().message, "disk full");
    EXPECT_TRUE(hears("^0$FA1\t2\n"));
}

TEST_F(ScriptedTest, shouldCancelWhenItIsToldTo) {
    react({{header(3) + block(1, "one ")}, {}, {}});
    TransferOptions options = quick;
    options.on_progress = [](const TransferProgress&) { return false; };
    EXPECT_EQ(download(*client_, path, options).error().kind, FailureKind::stopped);
    react({{word(1, FileVerdict::ok)}, {}, {}});
    EXPECT_EQ(upload(*client_, path, some_bytes(5000), options).error().kind, FailureKind::stopped);
    EXPECT_TRUE(hears("^0$FA2\t2\n"));
}

TEST_F(ScriptedTest, shouldSendABlockAgainOnlyIfItIsToldTo) {
    react({{word(1, FileVerdict::send_again)}, {word(0, FileVerdict::ok) + word(1, FileVerdict::ok)}});
    ASSERT_TRUE(upload(*client_, path, "content", quick));
    const std::string sent = block(1, "content").substr(0, block(1, "content").size() - 1) + '\n';
    EXPECT_TRUE(hears("Big.job\t1\n" + sent + sent));
}

TEST_F(ScriptedTest, shouldCountFromZeroWhereThePrinterWantsThat) {
    react({{word(0, FileVerdict::send_again)}, {word(0, FileVerdict::ok)}, {word(1, FileVerdict::ok)}});
    ASSERT_TRUE(upload(*client_, path, some_bytes(2049), quick));
    EXPECT_TRUE(hears("^0$FT0\t"));
}

TEST_F(ScriptedTest, shouldBeginTheFileAnewWhereAWordIsLost) {
    react({{word(1, FileVerdict::ok)}, {}, {word(1, FileVerdict::ok)}, {word(2, FileVerdict::ok)}});
    ASSERT_TRUE(upload(*client_, path, some_bytes(2049), quick));
    const std::string heard = peer_->heard();
    EXPECT_NE(heard.find("^0$FH"), heard.rfind("^0$FH"));
}

/// A word now and then gets lost in a long transfer; as long as it comes further each time that is no reason to end.
TEST_F(ScriptedTest, shouldGoOnWithAnUploadThatComesFurtherEachTime) {
    const auto ok = [](std::uint32_t number) { return Peer::Reaction{word(number, FileVerdict::ok)}; };
    react({{}, ok(1), {}, ok(1), ok(2), {}, ok(1), ok(2), ok(3)});
    EXPECT_TRUE(upload(*client_, path, some_bytes(5000), quick));
}

TEST_F(ScriptedTest, shouldGiveUpAnUploadThatIsNotAnswered) {
    react({{word(1, FileVerdict::ok)}});
    EXPECT_EQ(upload(*client_, path, some_bytes(5000), quick).error().kind, FailureKind::unreachable);
    EXPECT_TRUE(hears("\t2\n")) << "cancelled";
}

} // namespace
} // namespace linefeed::printer
