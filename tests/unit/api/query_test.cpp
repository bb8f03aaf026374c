// Parameters and numbers: read strictly or refused.
#include "api/query.hpp"
#include "api/url.hpp"

#include <gtest/gtest.h>

namespace linefeed::api {
namespace {

TEST(Query, DecodesEachParameterOnce) {
    const auto query = Query::parse("a=1&b=x%20y+z%C3%A4&c&&d=");
    ASSERT_TRUE(query);
    EXPECT_EQ(query->text("a"), "1");
    EXPECT_EQ(query->text("b"), "x y zä");
    ASSERT_NE(query->find("c"), nullptr);
    EXPECT_EQ(query->text("d"), "");
    EXPECT_EQ(query->find("e"), nullptr);
    EXPECT_TRUE(Query::parse(""));
}

TEST(Query, RefusesWhatItDoesNotUnderstand) {
    for (const std::string text : {"a=1&a=2", "a=%", "a=%1", "a=%1g", "%=1", "a=%00", "a=%zz"}) {
        const auto query = Query::parse(text);
        ASSERT_FALSE(query) << text;
        EXPECT_EQ(query.error().type, ProblemType::malformed);
    }
    std::string many;
    for (std::size_t k = 0; k < Query::max_parameters; ++k) {
        many += "p" + std::to_string(k) + "=1&";
    }
    EXPECT_TRUE(Query::parse(many));
    EXPECT_FALSE(Query::parse(many + "q=1"));
}

TEST(Query, NumbersAndFlagsKeepToTheirBounds) {
    const auto query =
        Query::parse("n=5&zero=0&plus=%2B5&lead=05&big=18446744073709551616&yes=true&no=false&bare&odd=1");
    ASSERT_TRUE(query);
    EXPECT_EQ(query->number("n", 1, 5, 9).value(), 5U);
    EXPECT_EQ(query->number("absent", 1, 5, 9).value(), 9U);
    EXPECT_FALSE(query->number("n", 6, 9, 9));
    EXPECT_FALSE(query->number("n", 1, 4, 9));
    EXPECT_EQ(query->number("zero", 0, 4, 9).value(), 0U);
    for (const std::string_view name : {"plus", "lead", "big", "bare"}) {
        EXPECT_FALSE(query->number(name, 0, 100, 0)) << name;
    }
    EXPECT_TRUE(query->flag("yes").value() && query->flag("bare").value());
    EXPECT_FALSE(query->flag("no").value() || query->flag("absent").value());
    EXPECT_FALSE(query->flag("odd"));
}

TEST(Query, RecordsAreANumberOrARange) {
    EXPECT_EQ(parse_records("7").value(), RecordRange::closed(RecordNumber{7}, RecordNumber{7}));
    EXPECT_EQ(parse_records("0-4294967295").value().count(), RecordCount{4294967296});
    for (const std::string text : {"", "-", "5-", "-5", "9-5", "1-2-3", "4294967296", "1 -2", "0x1", "1,2"}) {
        EXPECT_FALSE(parse_records(text)) << text;
    }
}

TEST(Query, WhatIsEncodedIsDecodedAgain) {
    std::string all;
    for (int c = 1; c < 256; ++c) {
        all += static_cast<char>(c);
    }
    const std::string encoded = url_encoded(all);
    EXPECT_EQ(encoded.find_first_of(" &=?#/+"), std::string::npos);
    EXPECT_EQ(percent_decoded(encoded, true), all);
    EXPECT_EQ(percent_decoded(encoded, false), all);
    EXPECT_EQ(percent_decoded("a+b", false), "a+b");
}

} // namespace
} // namespace linefeed::api
