// The table of error numbers.
#include "config/error_table.hpp"
#include "texts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace linefeed::config {
namespace {

using testing::ElementsAre;

std::vector<std::string> refusals(std::string_view text) {
    const auto table = parse_error_table(text, "e.yaml");
    return table ? std::vector<std::string>{} : lines_of(table.error());
}

TEST(ErrorTable, shouldFindNumbersAsTheFirmwareSendsThem) {
    const auto table = parse_error_table("errors:\n  51001: {meaning: double trigger, advice: look, policy: stop}\n  "
                                         "16828217: {meaning: m, advice: a, policy: report}\n",
                                         "e.yaml");
    ASSERT_TRUE(table);
    EXPECT_EQ(table->unlisted, ErrorPolicy::report);
    EXPECT_EQ(table->find({51001}), &table->entries[0]);
    EXPECT_EQ(table->find({151045945}), &table->entries[1]) << "with bit 24, the number as documented goes first";
    EXPECT_EQ(table->find({(1 << 24) | 51001}), &table->entries[1]);
    EXPECT_EQ(table->find({5043}), nullptr);
}

TEST(ErrorTable, shouldFindANumberWithoutBit24) {
    const auto table = parse_error_table("errors: {51001: {meaning: m, advice: a, policy: stop}}\n", "e.yaml");
    ASSERT_TRUE(table);
    EXPECT_EQ(table->find({151045945}), &table->entries[0]);
    Settings settings;
    settings.errors = *table;
    PrinterSettings printer;
    EXPECT_EQ(settings.policy(printer, {151045945}), ErrorPolicy::stop);
    printer.errors[51001] = ErrorPolicy::report;
    EXPECT_EQ(settings.policy(printer, {151045945}), ErrorPolicy::report);
}

TEST(ErrorTable, shouldNeverAcknowledgeWhatItDoesNotKnow) {
    EXPECT_THAT(refusals("unlisted: acknowledge\n"),
                ElementsAre("e.yaml:1:11: unlisted: expected report or stop, found \"acknowledge\""));
    EXPECT_THAT(refusals("unlisted: stop\n"), testing::IsEmpty());
}

TEST(ErrorTable, shouldRefuseWithPlaces) {
    EXPECT_THAT(refusals("errors:\n  5043: {meaning: m, policy: halt}\n  x: {}\n  5043: {}\n"),
                ElementsAre("e.yaml:2:9: errors.5043.advice: missing: this key must be there",
                            "e.yaml:2:30: errors.5043.policy: expected report, acknowledge or stop, found \"halt\"",
                            "e.yaml:3:3: errors.x: expected an error number from 1 to 33554431 as key, found \"x\"",
                            "e.yaml:4:3: errors.5043: doubled key: it stands in line 2 already"));
    EXPECT_THAT(refusals(""), ElementsAre("e.yaml: the file is empty"));
}

} // namespace
} // namespace linefeed::config
