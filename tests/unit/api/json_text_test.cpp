// Texts of any bytes as JSON, and the bodies of requests.
#include "api/json_text.hpp"

#include <gtest/gtest.h>

namespace linefeed::api {
namespace {

TEST(JsonText, BytesThatAreNoUtf8AreShown) {
    EXPECT_EQ(visible("Müller\n"), "Müller\n");
    EXPECT_EQ(visible("a\xFF"
                      "b\xC3"),
              "a\\xFFb\\xC3");
    EXPECT_EQ(visible("\xED\xA0\x80"), "\\xED\\xA0\\x80") << "half a surrogate pair";
    EXPECT_EQ(visible(std::string_view{"\0", 1}), std::string(1, '\0'));
    EXPECT_EQ(visible_ascii("^0\\\r\xE4"), "^0\\x5C\\x0D\\xE4");
    std::string all;
    for (int c = 0; c < 256; ++c) {
        all += static_cast<char>(c);
    }
    EXPECT_NO_THROW(dump(Json(visible(all))));
}

TEST(JsonText, TimesAreUtcWithMilliseconds) {
    EXPECT_EQ(rfc3339(0), "1970-01-01T00:00:00.000Z");
    EXPECT_EQ(rfc3339(1'795'000'000'123'456'789), "2026-11-18T11:06:40.123Z");
}

TEST(JsonText, OnlyObjectsAreObjects) {
    EXPECT_EQ(parsed_object(R"({"a":1})")["a"], 1);
    for (const std::string text : {"", "[]", "5", "{", "{\"a\":\"\xFF\"}"}) {
        EXPECT_TRUE(parsed_object(text).is_null()) << text;
    }
}

TEST(BodyReader, GivesWhatIsThere) {
    auto body = BodyReader::parse(R"({"text":"ä","flag":true,"number":-5})");
    ASSERT_TRUE(body);
    EXPECT_EQ(body->text("text"), "ä");
    EXPECT_EQ(body->flag("flag"), true);
    EXPECT_EQ(body->number("number", -5, 5), -5);
    EXPECT_EQ(body->text("absent"), std::nullopt);
    EXPECT_TRUE(body->finish());
    EXPECT_TRUE(BodyReader::parse("")->finish());
}

TEST(BodyReader, RefusesWhatIsNoObjectOrSaysTwoThings) {
    for (const std::string text :
         {"[]", "5", "{", "{}x", R"({"a":1,"a":1})", R"({"a":{"b":1,"b":2}})", "{\"a\":\"\xFF\"}"}) {
        const auto body = BodyReader::parse(text);
        ASSERT_FALSE(body) << text;
        EXPECT_EQ(body.error().type, ProblemType::malformed);
    }
    EXPECT_TRUE(BodyReader::parse(R"({"a":{"b":1},"b":2,"c":[{"d":1},{"d":1}]})"));
}

TEST(BodyReader, NamesTheFirstThingThatIsWrong) {
    const auto wrong = [](std::string_view text, auto&& read) {
        auto body = BodyReader::parse(text);
        read(*body);
        const auto right = body->finish();
        return right ? std::string{} : right.error().detail;
    };
    EXPECT_EQ(wrong(R"({"x":1})", [](BodyReader& b) { static_cast<void>(b.text("x")); }), "\"x\" must be a text");
    EXPECT_EQ(wrong(R"({"x":"1"})", [](BodyReader& b) { static_cast<void>(b.number("x", 1, 9)); }),
              "\"x\" must be a whole number from 1 to 9");
    EXPECT_EQ(wrong(R"({"x":1})", [](BodyReader& b) { static_cast<void>(b.flag("x")); }),
              "\"x\" must be true or false");
    EXPECT_EQ(wrong(R"({"y":1})", [](BodyReader& b) { static_cast<void>(b.text("x")); }),
              "there is no member \"y\" here");
    EXPECT_NE(wrong("{}", [](BodyReader& b) { static_cast<void>(b.required_text("x")); }), "");
    EXPECT_NE(wrong(R"({"x":""})", [](BodyReader& b) { static_cast<void>(b.required_text("x")); }), "");
    EXPECT_NE(wrong("{}", [](BodyReader& b) { static_cast<void>(b.required_number("x", 1, 2)); }), "");
    EXPECT_NE(wrong("{}", [](BodyReader& b) { static_cast<void>(b.required_flag("x")); }), "");
    for (const std::string number : {"0", "10", "1.5", "1e0", "true", "18446744073709551615", "-9223372036854775808"}) {
        EXPECT_NE(wrong("{\"x\":" + number + '}', [](BodyReader& b) { static_cast<void>(b.number("x", 1, 9)); }), "")
            << number;
    }
}

} // namespace
} // namespace linefeed::api
