// Lists of words, and what was probably meant.
#include "config/names.hpp"

#include <gtest/gtest.h>

namespace linefeed::config {
namespace {

TEST(Names, shouldListWords) {
    EXPECT_EQ(one_of({}), "");
    EXPECT_EQ(one_of({"a"}), "a");
    EXPECT_EQ(one_of({"a", "b"}), "a or b");
    EXPECT_EQ(one_of({"a", "b", "c"}), "a, b or c");
}

TEST(Names, shouldFindWhatWasMeant) {
    const std::vector<std::string> words{"address", "poll_min", "poll_max", "queue"};
    EXPECT_EQ(nearest("adress", words), "address");
    EXPECT_EQ(nearest("addrses", words), "address") << "neighbours swapped";
    EXPECT_EQ(nearest("Address", words), "address");
    EXPECT_EQ(nearest("poll-min", words), "poll_min");
    EXPECT_EQ(nearest("poll_mix", words), "") << "two are equally near";
    EXPECT_EQ(nearest("colour", words), "");
    EXPECT_EQ(nearest("q", words), "");
    EXPECT_EQ(nearest("", words), "");
    EXPECT_EQ(nearest(std::string(1000, 'a'), {std::string(1000, 'a')}), "");
    EXPECT_EQ(nearest("abc", {std::string(200, 'a'), "abd"}), "abd");
    EXPECT_EQ(did_you_mean("qeue", words), "; did you mean \"queue\"?");
    EXPECT_EQ(did_you_mean("colour", words), "");
}

TEST(Names, shouldMakeTheWordOfAVariable) {
    EXPECT_EQ(variable_word("line-1_a.b"), "LINE_1_A_B");
    EXPECT_EQ(variable_word("AZaz09"), "AZAZ09");
}

} // namespace
} // namespace linefeed::config
