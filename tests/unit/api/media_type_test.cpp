// What a client accepts: the range that names the type most exactly decides.
#include "api/media_type.hpp"

#include <gtest/gtest.h>

namespace linefeed::api {
namespace {

TEST(MediaType, IsReadWithoutParametersAndCase) {
    EXPECT_EQ(media_type_of("Text/CSV; charset=utf-8"), "text/csv");
    EXPECT_EQ(media_type_of("  application/json"), "application/json");
    EXPECT_EQ(media_type_of(""), "");
    EXPECT_EQ(media_type_of(" ; x"), "");
}

TEST(MediaType, AcceptTakesWhatItNames) {
    for (const std::string accept :
         {"", " ", "*/*", "application/json", "text/html, application/*;q=0.2", "APPLICATION/JSON ; v=1",
          "*/*;q=0, application/json", "application/*;q=0.0, application/json;q=0.1"}) {
        EXPECT_TRUE(accepts(accept, "application/json")) << accept;
    }
    for (const std::string accept :
         {"text/html", "application/json;q=0", "application/json; q=0.000, */*", "application/*;q=0, */*", "*/*;q=0",
          "application/jso", "application", ",", "json"}) {
        EXPECT_FALSE(accepts(accept, "application/json")) << accept;
    }
    EXPECT_TRUE(accepts("text/plain;version=0.0.4;q=0.5", "text/plain; version=0.0.4; charset=utf-8"));
}

} // namespace
} // namespace linefeed::api
