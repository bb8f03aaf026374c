#include "intake/columns.hpp"

#include <gmock/gmock.h>

namespace linefeed::intake {
namespace {

using testing::ElementsAre;

const SameName exactly = [](std::string_view wanted, std::string_view column) { return wanted == column; };

Result<std::vector<std::size_t>> choose_of(const std::vector<std::string>& wanted,
                                           const std::vector<std::string>& names) {
    return choose(wanted, names, names.size(), exactly);
}

TEST(Columns, shouldChooseAllIfNoneIsAskedFor) {
    EXPECT_THAT(choose_of({}, {"a", "b"}).value(), ElementsAre(0, 1));
}

TEST(Columns, shouldChooseByNameInTheOrderAskedFor) {
    EXPECT_THAT(choose_of({"c", "a", "c"}, {"a", "b", "c"}).value(), ElementsAre(2, 0, 2));
}

TEST(Columns, shouldChooseByNumberFromOne) {
    EXPECT_THAT(choose_of({"3", "1"}, {"a", "b", "c"}).value(), ElementsAre(2, 0));
    EXPECT_THAT(choose({"2"}, {}, 2, exactly).value(), ElementsAre(1));
}

TEST(Columns, shouldPreferANameToANumber) {
    EXPECT_THAT(choose_of({"2"}, {"2", "1"}).value(), ElementsAre(0));
}

TEST(Columns, shouldNameTheColumnsThatExist) {
    for (const char* wanted : {"d", "0", "4", "-1", "1x", "", "99999999999999999999"}) {
        const auto chosen = choose_of({wanted}, {"a", "b", "c"});
        ASSERT_FALSE(chosen.has_value()) << wanted;
        EXPECT_EQ(chosen.error(), (Failure{FailureKind::usage, "there is no column \"" + std::string{wanted} +
                                                                   R"(", there are "a", "b", "c")"}));
    }
    EXPECT_EQ(choose({"name"}, {}, 3, exactly).error().message,
              "there is no column \"name\", there are 3 without names: choose by number, from 1");
}

TEST(Columns, shouldRefuseANameThatSeveralColumnsHaveOnlyIfItIsChosen) {
    EXPECT_THAT(choose_of({"b"}, {"a", "b", "a"}).value(), ElementsAre(1));
    EXPECT_THAT(choose_of({}, {"a", "b", "a"}).value(), ElementsAre(0, 1, 2));
    EXPECT_THAT(choose_of({"3"}, {"a", "b", "a"}).value(), ElementsAre(2));
    EXPECT_EQ(choose_of({"a"}, {"a", "b", "a"}).error(),
              (Failure{FailureKind::usage, "more than one column is called \"a\": choose by number, from 1"}));
}

TEST(Columns, shouldCutALongList) {
    const std::vector<std::string> names(23, "n");
    EXPECT_TRUE(quoted_list(names).ends_with(R"("n", "n" and 3 more)"));
    EXPECT_EQ(quoted_list({}), "");
}

} // namespace
} // namespace linefeed::intake
