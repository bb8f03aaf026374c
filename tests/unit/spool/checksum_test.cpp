#include "spool/checksum.hpp"

#include <gtest/gtest.h>

namespace linefeed::spool {
namespace {

std::string hex_of(Sha256& sha) {
    const Sha256Digest digest = sha.finish();
    return to_hex({reinterpret_cast<const char*>(digest.data()), digest.size()});
}

TEST(Sha256, shouldGiveTheDigestOfThePublishedVector) {
    Sha256 sha;
    sha.update("abc");
    EXPECT_EQ(hex_of(sha), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Sha256, shouldNotDependOnHowTheBytesAreSplit) {
    Sha256 sha;
    sha.update("a");
    sha.update("");
    sha.update("bc");
    EXPECT_EQ(hex_of(sha), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(ToHex, shouldWriteTwoLowerCaseDigitsForEachByte) {
    EXPECT_EQ(to_hex(std::string_view{"\x00\x0F\xA0\xFF", 4}), "000fa0ff");
}

TEST(PageChecksum, shouldBeTheCrc32OfPlaceOffsetsAndFrames) {
    // crc32(b"3 17 " + b"ends" + b"frames") with zlib in another language.
    EXPECT_EQ(page_checksum(JobId{3}, RecordNumber{17}, "ends", "frames"), 0x9E4D0D0DU);
}

TEST(PageChecksum, shouldDifferForAPageInAnotherPlace) {
    const auto checksum = page_checksum(JobId{3}, RecordNumber{17}, "ends", "frames");
    EXPECT_NE(page_checksum(JobId{4}, RecordNumber{17}, "ends", "frames"), checksum);
    EXPECT_NE(page_checksum(JobId{3}, RecordNumber{18}, "ends", "frames"), checksum);
    EXPECT_NE(page_checksum(JobId{3}, RecordNumber{17}, "endz", "frames"), checksum);
    EXPECT_NE(page_checksum(JobId{3}, RecordNumber{17}, "ends", "framed"), checksum);
}

} // namespace
} // namespace linefeed::spool
