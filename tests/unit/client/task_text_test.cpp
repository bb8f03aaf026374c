// What printers answer, for people: names and values, lists as tables, errors with what to do.
#include "client/task_text.hpp"

#include <gtest/gtest.h>

namespace linefeed::client {
namespace {

TEST(TaskText, shouldNameValuesAndLeaveOutTheNumbersOfWords) {
    EXPECT_EQ(task_text({{"nozzle", "open"}, {"nozzle_code", 2}, {"cover_open", false}, {"job", nullptr}}, {}),
              "nozzle      open\n"
              "cover open  no\n"
              "job         -\n");
}

TEST(TaskText, shouldKeepANumberThatStandsAlone) {
    EXPECT_EQ(task_text({{"bar_code", 2}}, {}), "bar code  2\n");
}

TEST(TaskText, shouldSayOfAnErrorWhatItMeansAndWhatToDo) {
    const Json error{{"code", 1223}, {"words", "1223, message"}, {"meaning", "all printed"}, {"advice", "next job"}};
    EXPECT_EQ(task_text({{"error", error}}, {}), "error  1223, message; all printed; next job\n");
}

TEST(TaskText, shouldShowAListAsATableWithoutEmptyColumns) {
    const Json rows = Json::array({{{"contact", "X4.9"}, {"on", true}, {"note", ""}, {"value", 12}},
                                   {{"contact", "X4.22"}, {"on", false}, {"value", nullptr}}});
    EXPECT_EQ(task_text({{"speed", 9}, {"inputs", rows}}, {}), "speed  9\n"
                                                               "CONTACT  ON   VALUE\n"
                                                               "X4.9     yes     12\n"
                                                               "X4.22    no\n");
}

TEST(TaskText, shouldShowAnswersDecodedAndAsTheyCame) {
    const Json answer{{"command", "=CM"}, {"what", "stop at"}, {"fields", {{"stop_at", 5}}}, {"raw", "^0=CM5"}};
    EXPECT_EQ(task_text({{"inquiry", "?CM"}, {"answers", Json::array({answer})}}, {}), "=CM      stop at\n"
                                                                                       "stop at  5\n"
                                                                                       "raw      ^0=CM5\n");
}

TEST(TaskText, shouldNotLetAPrinterCommandTheTerminal) {
    EXPECT_EQ(task_text({{"text", "a\x1B[2J"}}, {}), "text  a\\x1B[2J\n");
}

} // namespace
} // namespace linefeed::client
