// Mail records as the printer reads them.
#include "protocol/mail_record.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace linefeed::protocol {
namespace {

using namespace std::string_view_literals;
using testing::ElementsAre;
using testing::IsEmpty;

MailRecord parsed(std::string_view text, EscapeMode escapes = EscapeMode::backslash) {
    const auto record = parse_mail_record(text, escapes);
    EXPECT_TRUE(record) << text;
    return record.value_or(MailRecord{});
}

TEST(MailRecordParser, shouldReadTheExamplesOfTheManual) {
    EXPECT_EQ(parsed("17\tMiss\tJane\tMiller\t{ho2r3}"),
              (MailRecord{RecordNumber{17}, {"Miss", "Jane", "Miller"}, {true, Orientation::degrees_180, 3}}));
    EXPECT_EQ(parsed("0\t111\t(8 3 FF81FF)"), (MailRecord{RecordNumber{0}, {"111", "(8 3 FF81FF)"}, {}}));
    EXPECT_EQ(parsed("0\ttext2\ttext3\t{r21}"), (MailRecord{RecordNumber{0}, {"text2", "text3"}, {.repetitions = 21}}));
    EXPECT_EQ(parsed("22119\tMail\xE4nder"), (MailRecord{RecordNumber{22119}, {"Mail\xE4nder"}, {}}));
}

TEST(MailRecordParser, shouldKeepEmptyFields) {
    EXPECT_THAT(parsed("1").fields, IsEmpty());
    EXPECT_THAT(parsed("1\t").fields, ElementsAre(""));
    EXPECT_THAT(parsed("1\t\tb\t").fields, ElementsAre("", "b", ""));
}

TEST(MailRecordParser, shouldDemandANumberWithoutLeadingZeros) {
    EXPECT_EQ(parsed("0\tx").number, RecordNumber{0});
    EXPECT_EQ(parsed("4294967295\tx").number, RecordNumber::max());
    for (const char* const text :
         {"", "\tx", "00\tx", "017\tx", "4294967296\tx", "-1\tx", "+1\tx", " 1\tx", "1 \tx", "1x\tx", "x"}) {
        EXPECT_EQ(parse_mail_record(text, EscapeMode::backslash), std::nullopt) << text;
    }
}

TEST(MailRecordParser, shouldObeyAPropertyBlockOnlyAsTheLastElement) {
    EXPECT_EQ(parsed("1\t{h}\tx"), (MailRecord{RecordNumber{1}, {"{h}", "x"}, {}}));
    EXPECT_EQ(parsed("1\tx{h}"), (MailRecord{RecordNumber{1}, {"x{h}"}, {}}));
    EXPECT_EQ(parsed("1\tx\t{hello}"), (MailRecord{RecordNumber{1}, {"x", "{hello}"}, {}}));
    EXPECT_EQ(parsed("1\tx\t{}"), (MailRecord{RecordNumber{1}, {"x"}, {}}));
    EXPECT_EQ(parsed("1\t{h}"), (MailRecord{RecordNumber{1}, {}, {.mirrored = true}}));
    EXPECT_EQ(parsed("1\t{h}\t"), (MailRecord{RecordNumber{1}, {"{h}", ""}, {}}));
}

TEST(MailRecordParser, shouldUndoEscapesOnlyWhereTheFirmwareKnowsThem) {
    EXPECT_THAT(parsed("1\ta\\^b\t\\\\").fields, ElementsAre("a^b", "\\"));
    EXPECT_THAT(parsed("1\ta\\\\b", EscapeMode::none).fields, ElementsAre("a\\\\b"));
}

TEST(MailRecordParser, shouldShowNulAsABlank) {
    EXPECT_THAT(parsed("1\ta\0b"sv).fields, ElementsAre("a b"));
}

TEST(MailRecordParser, shouldDropWhatThePrinterTruncates) {
    const std::string record = "1\t" + std::string(2046, 'x');
    EXPECT_THAT(parsed(record).fields, ElementsAre(std::string(2046, 'x')));
    EXPECT_EQ(parsed(record + "yz\t{h}"), parsed(record));
}

TEST(MailRecordParser, shouldTakeNoMoreThan255Fields) {
    std::string record = "1";
    for (int field = 0; field < 300; ++field) {
        record += "\tf";
    }
    EXPECT_EQ(parsed(record).fields.size(), 255U);
}

TEST(MailRecordParser, shouldReadBackWhatTheEncoderWrites) {
    const MailRecordEncoder encoder{{Charset::latin1}, EscapeMode::backslash, {.orientation = Orientation::degrees_90}};
    std::string out;
    const std::vector<std::string_view> fields{"a^b\\", "", "{h}"};
    ASSERT_TRUE(encoder.append(out, RecordNumber{5}, fields).has_value());
    const auto text = std::string_view{out}.substr(5, out.size() - 6);
    EXPECT_EQ(parsed(text),
              (MailRecord{RecordNumber{5}, {"a^b\\", "", "{h}"}, {.orientation = Orientation::degrees_90}}));
}

} // namespace
} // namespace linefeed::protocol
