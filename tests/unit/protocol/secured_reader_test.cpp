// What each frame of the printer says in a secured transmission.
#include "protocol/crc32.hpp"
#include "protocol/secured_reader.hpp"

#include <gtest/gtest.h>

namespace linefeed::protocol {
namespace {

using Word = SecuredReader::Word;

class SecuredReaderTest : public testing::Test {
protected:
    SecuredReaderTest() {
        line_.add({.kind = SecuredLine::Kind::inquiry, .what = Parameter::SM, .bytes = "^0?SM\r"});
        static_cast<void>(line_.begin());
    }
    Word read(std::string raw) {
        const auto group = raw[2] == '!' ? Group::action : Group::parameter;
        return reader_.read({.group = group, .payload = std::string_view{raw}.substr(3), .raw = raw}, line_);
    }
    Word announced(const std::string& raw, std::uint32_t difference = 0) {
        EXPECT_EQ(read("^0=NR" + std::to_string(crc32(raw) + difference)), Word::announcement);
        return read(raw);
    }

    SecuredLine line_{{.bytes_per_second = 11520, .crc = true}};
    SecuredReader reader_;
};

TEST_F(SecuredReaderTest, shouldBelieveAnAnnouncementOnce) {
    const std::string answer = "^0=SM256\t0\t1\t0\t1\t7";
    EXPECT_EQ(announced(answer), Word::proven);
    EXPECT_EQ(read(answer), Word::bare);
    EXPECT_EQ(announced(answer, 1), Word::damaged);
    EXPECT_EQ(read("^0=NRx"), Word::announcement);
    EXPECT_EQ(read(answer), Word::bare);
}

/// `!EM` echoes the announcement, too; what comes behind it is none the better for that.
TEST_F(SecuredReaderTest, shouldNotTakeAnEchoOfOurAnnouncementForThePrinters) {
    static_cast<void>(line_.announced(Instant{}));
    const std::string ours = "^0=NR" + std::to_string(line_.announced_sum());
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(read(ours), Word::announcement);
        EXPECT_EQ(read("^0=SM256\t0\t1\t0\t1\t7"), Word::bare);
    }
    EXPECT_TRUE(reader_.unsecured());
}

TEST_F(SecuredReaderTest, shouldTakeOneDamagedByteOfOkForOk) {
    for (const char* word : {"^0!OK", "^0!OK  ", "^0!OX", "^0!\x01K", "^0=OK"}) {
        EXPECT_EQ(read(word), Word::right) << word;
    }
    for (const char* word : {"^0!XX", "^0=OX", "^0!OKK", "^0!O", "^0!"}) {
        EXPECT_EQ(read(word), Word::bare) << word;
    }
    EXPECT_EQ(read("^0=FC"), Word::refused);
}

TEST_F(SecuredReaderTest, shouldTakeAnAnnouncedFrameForWhatItIs) {
    EXPECT_EQ(announced("^0!OK"), Word::proven) << "a line of a script may look like it";
    EXPECT_EQ(announced("^0=FC"), Word::proven);
}

TEST_F(SecuredReaderTest, shouldBelieveStandbyUntilSomethingWasSecured) {
    const std::string standby = "^0=RS0\t1\t0\t0\t0";
    const std::string ready = "^0=RS2\t5\t0\t0\t0";
    EXPECT_EQ(read(standby), Word::standby);
    EXPECT_EQ(read(ready), Word::bare);
    EXPECT_EQ(announced(standby, 1), Word::damaged);
    EXPECT_EQ(read("^0!OK"), Word::right);
    EXPECT_EQ(read(standby), Word::bare) << "noise may have made it";
    reader_.forget();
    EXPECT_EQ(read(standby), Word::standby);
}

TEST_F(SecuredReaderTest, shouldNoticeAPrinterThatKnowsNoCrc32) {
    const std::string answer = "^0=SM256\t0\t1\t0\t1\t7";
    for (const char* other : {"^0=CC1\t2", "^0!XX", "^0!SM", "^0=", "^0=RSx"}) {
        EXPECT_EQ(read(other), Word::bare) << other;
    }
    EXPECT_EQ(read(answer), Word::bare);
    EXPECT_EQ(read(answer), Word::bare);
    EXPECT_FALSE(reader_.unsecured()) << "their announcements may have got lost";
    EXPECT_EQ(read(answer), Word::bare);
    EXPECT_TRUE(reader_.unsecured());
    EXPECT_EQ(announced(answer), Word::proven);
    EXPECT_FALSE(reader_.unsecured());
    for (int i = 0; i < 5; ++i) {
        EXPECT_EQ(read(answer), Word::bare);
    }
    EXPECT_FALSE(reader_.unsecured()) << "it knows it";
}

} // namespace
} // namespace linefeed::protocol
