// The property block of mail records: h, oX and rN, each at most once.
#include "protocol/record_properties.hpp"

#include <gtest/gtest.h>

namespace linefeed::protocol {
namespace {

std::string written(const RecordProperties& properties) {
    std::string out;
    append_properties(out, properties);
    return out;
}

TEST(RecordProperties, shouldBeWrittenAsInTheManual) {
    EXPECT_EQ(written({.mirrored = true, .orientation = Orientation::degrees_180, .repetitions = 3}), "{ho2r3}");
    EXPECT_EQ(written({.repetitions = 21}), "{r21}");
    EXPECT_EQ(written({.orientation = Orientation::degrees_0}), "{o0}");
    EXPECT_EQ(written({.mirrored = true}), "{h}");
    EXPECT_EQ(written({}), "{}");
}

TEST(RecordProperties, shouldBeEmptyOnlyWithoutAny) {
    EXPECT_TRUE(RecordProperties{}.empty());
    EXPECT_FALSE(RecordProperties{.mirrored = true}.empty());
    EXPECT_FALSE(RecordProperties{.orientation = Orientation::degrees_0}.empty());
    EXPECT_FALSE(RecordProperties{.repetitions = 0}.empty());
}

TEST(RecordProperties, shouldBeReadInAnyOrder) {
    const RecordProperties all{.mirrored = true, .orientation = Orientation::degrees_180, .repetitions = 3};
    for (const char* const text : {"{ho2r3}", "{hr3o2}", "{o2hr3}", "{o2r3h}", "{r3ho2}", "{r3o2h}"}) {
        EXPECT_EQ(read_properties(text), all) << text;
    }
    EXPECT_EQ(read_properties("{}"), RecordProperties{});
    EXPECT_EQ(read_properties("{o3}"), RecordProperties{.orientation = Orientation::degrees_270});
    EXPECT_EQ(read_properties("{o1}"), RecordProperties{.orientation = Orientation::degrees_90});
    EXPECT_EQ(read_properties("{r4294967295}"), RecordProperties{.repetitions = 4294967295U});
}

TEST(RecordProperties, shouldTakeTooLargeARepetitionForTheLargest) {
    EXPECT_EQ(read_properties("{r99999999999999999999h}"),
              (RecordProperties{.mirrored = true, .repetitions = 4294967295U}));
}

TEST(RecordProperties, shouldNotBeReadFromOtherText) {
    for (const char* const text :
         {"",    "{",    "}",    "h",   "{h",   "h}",    " {h}", "{h} ", "{hh}",   "{o1o2}", "{r1r2}",
          "{o}", "{o4}", "{o/}", "{r}", "{rh}", "{r-1}", "{x}",  "{H}",  "{h,o1}", "{{h}}",  "{h }"}) {
        EXPECT_EQ(read_properties(text), std::nullopt) << text;
    }
}

} // namespace
} // namespace linefeed::protocol
