// Files and directories: blocks, checksums, verdicts, listings.
#include "parsing.hpp"

#include <string>

namespace linefeed::protocol {
namespace {

TEST(FileBlock, shouldCarryAnyByteUnderItsChecksum) {
    std::string all;
    for (int byte = 0; byte < 256; ++byte) {
        all.push_back(static_cast<char>(byte));
    }
    const FileBlock block = FileBlock::of(7, all);
    EXPECT_EQ(block.checksum, 255 * 256 / 2 % 256);
    const auto back = parsed_as<FileBlock>(encoded(block));
    EXPECT_EQ(back, block);
    EXPECT_TRUE(back.intact());
    EXPECT_EQ(parsed_as<FileBlock>(encoded(FileBlock::of(1, std::string(2048, '\xFF')))).bytes.size(), 2048U);
}

TEST(FileBlock, shouldBeEmptyForAnEmptyFile) {
    EXPECT_EQ(encoded(FileBlock::of(1, "")), "^0$FT1\t0\t\r");
    EXPECT_EQ(parsed_as<FileBlock>("^0$FT1\t0\t\r"), FileBlock::of(1, ""));
    EXPECT_EQ(parsed_as<FileBlock>("^0$FT1\t0\r"), FileBlock::of(1, ""));
}

TEST(FileBlock, shouldNoticeDamage) {
    EXPECT_FALSE(parsed_as<FileBlock>("^0$FT1\t2\tAB\r").intact());
    EXPECT_EQ(reason("^0$FT1\t1\tAQ\r"), "$FT: parameter 3 is not a block of nibbles: \"AQ\"");
    EXPECT_EQ(reason("^0$FT1\t1\tABA\r"), "$FT: parameter 3 is not a block of nibbles: \"ABA\"");
    EXPECT_EQ(reason("^0$FT1\t256\tAB\r"), "$FT: parameter 2 is not a checksum: \"256\"");
    EXPECT_EQ(reason("^0$FT1\t0\t" + std::string(4098, 'A') + "\r").substr(0, 51),
              "$FT: parameter 3 is not a block of nibbles: \"AAAAAA");
}

TEST(FileAcknowledgement, shouldKnowThreeVerdicts) {
    EXPECT_EQ(parsed_as<FileAcknowledgement>("^0$FA3\t0\r"), (FileAcknowledgement{3, FileVerdict::send_again}));
    EXPECT_EQ(encoded(FileAcknowledgement{3, FileVerdict::cancel}), "^0$FA3\t2\r");
    EXPECT_EQ(reason("^0$FA3\t3\r"), "$FA: parameter 2 is not 0, 1 or 2: \"3\"");
    EXPECT_EQ(to_string(FileVerdict::send_again), "send again");
    EXPECT_EQ(to_string(FileVerdict::ok), "ok");
    EXPECT_EQ(to_string(FileVerdict::cancel), "cancel the transfer");
    EXPECT_DEATH(static_cast<void>(to_string(FileVerdict{3})), "FileVerdict");
}

TEST(FileHeader, shouldSayThatAFileCannotBeOpened) {
    EXPECT_EQ(parsed_as<FileHeader>("^0$FHFFSDISK\\Jobs\\no.job\t0\r"), (FileHeader{"FFSDISK\\Jobs\\no.job", 0}));
    EXPECT_EQ(encoded(FileHeader{"A\\b.job", 3}, EscapeMode::none), "^0$FHA\\b.job\t3\r");
    EXPECT_EQ(reason("^0$FHA\\b.job\r"), "$FH: parameter 2 is missing: a number of blocks");
}

TEST(DirectoryBlock, shouldReadItsEntriesAndNoMore) {
    const auto block = parsed_as<DirectoryBlock>("^0$DI0\t2\t!Jobs\ta b\\^.job\texcess\r");
    EXPECT_EQ(block, (DirectoryBlock{false, {{"Jobs", true}, {"a b^.job", false}}}));
    EXPECT_EQ(reason("^0$DI1\t2\tone.job\r"), "$DI: parameter 4 is missing: an entry")
        << "a line without CRC32 may have cut it: files are not taken for gone";
    EXPECT_EQ(reason("^0$DI1\t1\t!\r"), "$DI: parameter 3 is missing: an entry") << "a directory without a name";
    EXPECT_EQ(reason("^0$DI1\t33\r"), "$DI: parameter 2 is not a number of entries: \"33\"");
    EXPECT_EQ(reason("^0$DI2\t0\r"), "$DI: parameter 1 is not 0 or 1: \"2\"");
}

TEST(DirectoryListing, shouldGoOnUntilTheLastBlock) {
    DirectoryListing listing;
    EXPECT_FALSE(listing.add({false, std::vector<DirectoryEntry>(32, {"a", false})}));
    EXPECT_TRUE(listing.add({true, {{"b", false}}}));
    EXPECT_EQ(listing.entries().size(), 33U);
    EXPECT_EQ(listing.entries().back().name, "b");
}

TEST(DirectoryListing, shouldHaveAnEnd) {
    DirectoryListing listing;
    std::size_t blocks = 1;
    while (!listing.add({false, std::vector<DirectoryEntry>(32, {"a", false})})) {
        ++blocks;
    }
    EXPECT_EQ(blocks * 32, DirectoryListing::max_entries);
}

} // namespace
} // namespace linefeed::protocol
