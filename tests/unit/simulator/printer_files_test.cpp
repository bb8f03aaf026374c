// Files and directories of the printer (protocol, section 8): listings, transfers both ways, retries, cancelling.
#include "printer_fixture.hpp"
#include "protocol/messages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

namespace linefeed::simulator::test {
namespace {

using protocol::FileAcknowledgement;
using protocol::FileBlock;
using protocol::FileVerdict;
using protocol::Message;
using ::testing::StartsWith;

/// A client that speaks in messages.
class FileClient {
public:
    explicit FileClient(Printer& printer, protocol::EscapeMode escapes = protocol::EscapeMode::backslash)
        : printer_(printer)
        , escapes_(escapes) {}

    std::vector<Message> send(const Message& message) {
        std::string bytes;
        protocol::append_any_message(bytes, message, escapes_);
        const std::string replies = printer_.send(bytes);
        protocol::FrameDecoder decoder{escapes_};
        std::string_view rest = replies;
        std::vector<Message> messages;
        for (auto result = decoder.next(rest); !std::holds_alternative<std::monostate>(result);
             result = decoder.next(rest)) {
            messages.push_back(protocol::parse_message(std::get<protocol::Frame>(result), escapes_));
        }
        return messages;
    }

    /// The file, block by block as the manual has it; damaged blocks are asked for again.
    std::string download(const std::string& path) {
        auto replies = send(protocol::FileRequest{path});
        const auto header = std::get<protocol::FileHeader>(replies.at(0));
        std::string bytes;
        std::uint32_t taken = 0;
        while (taken < header.blocks) {
            const auto& block = std::get<FileBlock>(replies.back());
            const bool good = block.intact() && block.number == taken + 1;
            retries += good ? 0 : 1;
            bytes += good ? block.bytes : "";
            taken += good ? 1 : 0;
            replies = send(FileAcknowledgement{block.number, good ? FileVerdict::ok : FileVerdict::send_again});
        }
        EXPECT_TRUE(replies.empty()) << "nothing follows the last block";
        return bytes;
    }

    /// The printer's last word.
    FileVerdict upload(const std::string& path, const std::string& bytes) {
        const auto blocks = static_cast<std::uint32_t>(std::max<std::size_t>(1, (bytes.size() + 2047) / 2048));
        EXPECT_TRUE(send(protocol::FileHeader{path, blocks}).empty()) << "not acknowledged";
        for (std::uint32_t number = 1; number <= blocks;) {
            const auto replies = send(FileBlock::of(number, std::string_view{bytes}.substr((number - 1) * 2048, 2048)));
            const auto word = std::get<FileAcknowledgement>(replies.at(0));
            EXPECT_EQ(word.number, number);
            if (word.verdict == FileVerdict::cancel) {
                return FileVerdict::cancel;
            }
            number += word.verdict == FileVerdict::ok ? 1 : 0;
            retries += word.verdict == FileVerdict::ok ? 0 : 1;
        }
        return FileVerdict::ok;
    }

    unsigned retries = 0;

private:
    Printer& printer_;
    protocol::EscapeMode escapes_;
};

std::string content(std::size_t bytes) {
    std::string made;
    for (std::size_t i = 0; i < bytes; ++i) {
        made.push_back(static_cast<char>(i * i + i / 251));
    }
    return made;
}

TEST(PrinterDirectories, shouldAnswerTheManualsExamples) {
    for (const char* profile : {"jet3", "jet3up", "jet2neo"}) {
        PrinterSettings settings;
        settings.profile = *protocol::profile_by_name(profile);
        Printer printer{settings};
        EXPECT_EQ(printer.send("^0$RDFFSDISK\\Jobs\r"), "^0$DI1\t01\t!Jobs\r");
        EXPECT_EQ(printer.send("^0$RDFFSDISK\\Jobis\r"), "^0$DI1\t00\r");
        EXPECT_EQ(printer.send("^0$RDFFSDISK\\Jobs*\r"),
                  "^0$DI1\t06\tCOUNTER.JOB\tDATE.JOB\tDM.JOB\tTestprint.job\tLINIE.job\tLJ24 Test.job\r");
        EXPECT_EQ(printer.send("^0$RDFFSDISK\\Fonts\\ISO*.lft\r"),
                  "^0$DI1\t09\tISO1_5x5.lft\tISO1_7x5.lft\tISO1_9x7.lft\tISO1_12x8.lft\tISO1_14x10.lft\t"
                  "ISO1_16x10.lft\tISO1_24x18.lft\tISO1_32x20.lft\tISO1_5x7flue.lft\r");
    }
}

TEST(PrinterDirectories, shouldKnowTheDevicesOfItsFamily) {
    const auto exists = [](const char* profile, const std::string& path) {
        PrinterSettings settings;
        settings.profile = *protocol::profile_by_name(profile);
        Printer printer{settings};
        return printer.send("^0$RD" + path + "\r").starts_with("^0$DI1\t01\t!");
    };
    EXPECT_TRUE(exists("jet3", "Storage Card\\LJ3\\Graphics"));
    EXPECT_FALSE(exists("jet3up", "Storage Card\\LJ3\\Graphics"));
    EXPECT_TRUE(exists("jet3up", "USB-Stick\\LJ3\\Fonts"));
    EXPECT_FALSE(exists("jet3up", "USB-Stick\\LJet2neo\\Fonts"));
    EXPECT_TRUE(exists("jet2neo", "USB-Stick\\LJet2neo\\Jobs"));
    EXPECT_TRUE(exists("jet2neo", "FFSDISK"));
}

TEST(PrinterDirectories, shouldListInBlocksOf32) {
    Printer printer;
    FileClient client{printer};
    for (int i = 0; i < 33; ++i) {
        client.upload("FFSDISK\\Graphics\\g" + std::to_string(i) + ".bmp", "x");
    }
    protocol::DirectoryListing listing;
    const auto blocks = client.send(protocol::DirectoryRequest{"FFSDISK\\Graphics\\*"});
    ASSERT_EQ(blocks.size(), 2U);
    EXPECT_FALSE(listing.add(std::get<protocol::DirectoryBlock>(blocks[0])));
    EXPECT_TRUE(listing.add(std::get<protocol::DirectoryBlock>(blocks[1])));
    EXPECT_EQ(listing.entries().size(), 33U);
    EXPECT_EQ(listing.entries().back().name, "g32.bmp");
}

TEST(PrinterFiles, shouldComeBackAsTheyWere) {
    Printer printer;
    FileClient client{printer};
    for (const std::size_t size : {1U, 2047U, 2048U, 2049U, 10000U}) {
        ASSERT_EQ(client.upload("FFSDISK\\Jobs\\a b^\\c.job", "?"), FileVerdict::cancel) << "no such directory";
        ASSERT_EQ(client.upload("FFSDISK\\Jobs\\a b^.job", content(size)), FileVerdict::ok);
        EXPECT_EQ(client.download("\\ffsdisk\\JOBS\\A B^.JOB"), content(size)) << size;
    }
    EXPECT_EQ(client.retries, 0U);
}

TEST(PrinterFiles, shouldComeBackAsTheyWereInSpiteOfBlockErrors) {
    PrinterSettings settings;
    settings.block_errors = {30, 7};
    Printer printer{settings};
    FileClient client{printer};
    const std::string megabyte = content(1U << 20U);
    ASSERT_EQ(client.upload("USB-Stick\\LJ3\\Jobs\\big.job", megabyte), FileVerdict::ok);
    EXPECT_EQ(client.download("USB-Stick\\LJ3\\Jobs\\big.job"), megabyte);
    EXPECT_GT(client.retries, 200U);
    EXPECT_LT(client.retries, 700U);
}

TEST(PrinterFiles, shouldAnswerAlikeForAMissingAndAnEmptyFile) {
    Printer printer;
    FileClient client{printer};
    ASSERT_EQ(client.upload("FFSDISK\\Jobs\\empty.job", ""), FileVerdict::ok);
    EXPECT_EQ(printer.send("^0$RDFFSDISK\\Jobs\\empty.job\r"), "^0$DI1\t01\tempty.job\r");
    EXPECT_EQ(printer.send("^0$RFFFSDISK\\Jobs\\empty.job\r"), "^0$FHFFSDISK\\Jobs\\empty.job\t0\r");
    EXPECT_EQ(printer.send("^0$RFFFSDISK\\Jobs\\none.job\r"), "^0$FHFFSDISK\\Jobs\\none.job\t0\r");
}

TEST(PrinterFiles, shouldBeDeletedFromTheDefaultDirectoriesOnly) {
    Printer printer;
    EXPECT_EQ(printer.send("^0$DFFFSDISK\\Jobs\\dm.job\r"), "");
    EXPECT_EQ(printer.send("^0$RDFFSDISK\\Jobs\\DM.JOB\r"), "^0$DI1\t00\r");
    EXPECT_EQ(printer.send("^0$DFFFSDISK\\Jobs\r^0$DFFFSDISK\\Jobs\\*\r^0$DFC:\\DATE.JOB\r"), "");
    EXPECT_THAT(printer.send("^0$RDFFSDISK\\Jobs*\r"), StartsWith("^0$DI1\t05\t"));
}

TEST(PrinterFiles, shouldAskAgainForABlockThatIsNotRight) {
    Printer printer;
    EXPECT_EQ(printer.send("^0$FHFFSDISK\\Jobs\\x.job\t2\r^0$FT1\t132\tIBAC\r"), "^0$FA1\t0\r") << "wrong sum";
    EXPECT_EQ(printer.send("^0$FT1\t131\tIBAZ\r"), "^0$FA1\t0\r") << "no nibbles";
    EXPECT_EQ(printer.send("^0$FT2\t131\tIBAC\r"), "^0$FA1\t0\r") << "out of order";
    EXPECT_EQ(printer.send("^0$FT1\t131\tIBAC\r"), "^0$FA1\t1\r");
    EXPECT_EQ(printer.send("^0$FT1\t131\tIBAC\r"), "^0$FA1\t1\r") << "sent again because the word was lost";
    EXPECT_EQ(printer.send("^0$FT2\t1\tAB\r"), "^0$FA2\t1\r");
    EXPECT_EQ(printer.send("^0$RFFFSDISK\\Jobs\\x.job\r"), "^0$FHFFSDISK\\Jobs\\x.job\t1\r^0$FT1\t132\tIBACAB\r");
    EXPECT_EQ(printer.send("^0$FT1\t9\tIBAZ\r"), "") << "no transfer is under way";
    EXPECT_EQ(printer.send("^0$FT1\t131\tIBAC\r"), "^0$FA1\t2\r");
}

TEST(PrinterFiles, shouldSayAgainHowAnUploadEnded) {
    Printer printer;
    printer.send("^0$FHFFSDISK\\Jobs\\x.job\t2\r^0$FT1\t131\tIBAC\r");
    EXPECT_EQ(printer.send("^0$FT2\t1\tAB\r"), "^0$FA2\t1\r");
    EXPECT_EQ(printer.send("^0$FT2\t1\tAB\r"), "^0$FA2\t1\r") << "the word on the last block was lost";
    EXPECT_EQ(printer.send("^0$FT2\t2\tAB\r"), "^0$FA2\t0\r") << "again, and damaged";
    EXPECT_EQ(printer.send("^0$FT1\t131\tIBAC\r"), "^0$FA1\t2\r") << "an earlier one has no header";
    EXPECT_EQ(printer.send("^0$FT2\t1\tAB\r", 2), "^0$FA2\t2\r") << "another client has no header";
    EXPECT_THAT(printer.send("^0$RFFFSDISK\\Jobs\\x.job\r"), StartsWith("^0$FHFFSDISK\\Jobs\\x.job\t1\r^0$FT1\t132\t"))
        << "stored once";

    printer.send("^0$FHC:\\x.job\t1\r");
    EXPECT_EQ(printer.send("^0$FT1\t1\tAB\r"), "^0$FA1\t2\r");
    EXPECT_EQ(printer.send("^0$FT1\t1\tAB\r"), "^0$FA1\t2\r") << "refused stays refused";

    printer.send("^0$FHFFSDISK\\Jobs\\x.job\t1\r^0$FT1\t1\tAB\r^0$FHFFSDISK\\Jobs\\y.job\t0\r");
    EXPECT_EQ(printer.send("^0$FT1\t1\tAB\r"), "^0$FA1\t2\r") << "another header ends that";
}

TEST(PrinterFiles, shouldTakeBlocksCountedFrom0) {
    Printer printer;
    EXPECT_EQ(printer.send("^0$FHFFSDISK\\Jobs\\x.job\t2\r^0$FT0\t131\tIBAC\r^0$FT1\t1\tAB\r"),
              "^0$FA0\t1\r^0$FA1\t1\r");
    EXPECT_THAT(printer.send("^0$RFFFSDISK\\Jobs\\x.job\r"), StartsWith("^0$FHFFSDISK\\Jobs\\x.job\t1\r^0$FT1\t132\t"));
}

TEST(PrinterFiles, shouldBeCancelledByEitherSide) {
    Printer printer;
    FileClient client{printer};
    printer.send("^0$FHFFSDISK\\Jobs\\x.job\t2\r^0$FT1\t131\tIBAC\r^0$FA1\t2\r");
    EXPECT_EQ(printer.send("^0$FT2\t1\tAB\r"), "^0$FA2\t2\r") << "the host has cancelled";
    EXPECT_EQ(printer.send("^0$RDFFSDISK\\Jobs\\x.job\r"), "^0$DI1\t00\r") << "half a file is none";

    printer.send("^0$RFFFSDISK\\Fonts\\ISO1_5x5.lft\r^0$FA1\t2\r");
    EXPECT_EQ(printer.send("^0$FA1\t0\r"), "");

    printer.model.expect(Trouble::cancelled_transfer, 1);
    EXPECT_EQ(client.upload("FFSDISK\\Jobs\\x.job", "x"), FileVerdict::cancel);
    printer.model.expect(Trouble::cancelled_transfer, 1);
    EXPECT_EQ(printer.send("^0$RFFFSDISK\\Jobs\\DATE.JOB\r^0$FA1\t0\r").substr(0, 6), "^0$FHF");
    EXPECT_EQ(printer.send("^0$FA1\t0\r"), "");
}

TEST(PrinterFiles, shouldBeRefusedWithoutRoom) {
    Printer printer;
    FileClient client{printer};
    ASSERT_EQ(client.upload("FFSDISK\\Jobs\\a.job", content(20U << 20U)), FileVerdict::ok);
    EXPECT_EQ(printer.send("^0?DS\r"), "^0=DS4096\r");
    EXPECT_EQ(client.upload("FFSDISK\\Jobs\\b.job", content(5U << 20U)), FileVerdict::cancel);
    EXPECT_EQ(printer.send("^0$FHFFSDISK\\Jobs\\c.job\t4000000\r^0$FT1\t0\t\r"), "^0$FA1\t2\r");
    printer.send("^0$DFFFSDISK\\Jobs\\a.job\r");
    EXPECT_EQ(printer.send("^0?DS\r"), "^0=DS24576\r");
}

TEST(PrinterFiles, shouldBeTransferredForEachClientOfItsOwnEvenInStandby) {
    PrinterSettings settings;
    settings.power_up = PowerUpState::standby;
    Printer printer{settings};
    EXPECT_EQ(printer.send("^0$FHFFSDISK\\Jobs\\x.job\t1\r", 1), "");
    EXPECT_EQ(printer.send("^0$FT1\t131\tIBAC\r", 2), "^0$FA1\t2\r");
    EXPECT_EQ(printer.send("^0$FT1\t131\tIBAC\r", 1), "^0$FA1\t1\r");
    printer.send("^0$FHFFSDISK\\Jobs\\y.job\t1\r", 1);
    printer.model.disconnected(ConnectionId{1});
    EXPECT_EQ(printer.send("^0$FT1\t131\tIBAC\r", 1), "^0$FA1\t2\r");
}

TEST(PrinterFiles, shouldBeGoneWithTheStick) {
    Printer printer;
    FileClient client{printer};
    client.upload("USB-Stick\\LJ3\\Jobs\\x.job", "x");
    printer.model.set_stick(false);
    EXPECT_EQ(printer.send("^0$RDUSB-Stick\\LJ3\\Jobs\r"), "^0$DI1\t00\r");
    EXPECT_EQ(printer.send("^0$RFUSB-Stick\\LJ3\\Jobs\\x.job\r"), "^0$FHUSB-Stick\\LJ3\\Jobs\\x.job\t0\r");
    EXPECT_EQ(client.upload("USB-Stick\\LJ3\\Jobs\\y.job", "y"), FileVerdict::cancel);
    printer.model.set_stick(true);
    EXPECT_EQ(client.download("USB-Stick\\LJ3\\Jobs\\x.job"), "x");
}

} // namespace
} // namespace linefeed::simulator::test
