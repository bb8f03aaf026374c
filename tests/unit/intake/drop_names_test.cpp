#include "intake/drop_names.hpp"

#include <gtest/gtest.h>

namespace linefeed::intake {
namespace {

TEST(DropNames, shouldKnowBatchesByThePattern) {
    EXPECT_TRUE(is_batch_name("a.csv", "*.csv"));
    EXPECT_TRUE(is_batch_name("a\nb.csv", "*.csv"));
    EXPECT_TRUE(is_batch_name("\xFF.csv", "*.csv"));
    EXPECT_TRUE(is_batch_name("-rf.csv", "*"));
    EXPECT_FALSE(is_batch_name("a.csv.part", "*.csv"));
    EXPECT_FALSE(is_batch_name(".a.csv", "*.csv")) << "hidden names are those of unfinished copies";
    EXPECT_FALSE(is_batch_name("a.csv.done", "*"));
    for (const char* const name : {"a.db-wal", "a.db-shm", "a.db-journal"}) {
        EXPECT_FALSE(is_batch_name(name, "*")) << name;
    }
}

TEST(DropNames, shouldKnowWhatAMarkSpeaksOf) {
    EXPECT_EQ(marked_name("a.csv.done"), "a.csv");
    EXPECT_EQ(marked_name("a.csv"), "");
    EXPECT_EQ(marked_name(".done"), "");
}

TEST(DropNames, shouldNumberNamesThatAreTaken) {
    EXPECT_EQ(kept_name("a.csv", 1), "a.csv");
    EXPECT_EQ(kept_name("a.csv", 2), "a~2.csv");
    EXPECT_EQ(kept_name("a.b.csv", 30), "a.b~30.csv");
    EXPECT_EQ(kept_name("noext", 2), "noext~2");
    EXPECT_EQ(kept_name(".csv", 2), ".csv~2");
    EXPECT_EQ(kept_name("a." + std::string(16, 'x'), 2), "a." + std::string(16, 'x') + "~2");
}

TEST(DropNames, shouldLeaveRoomForTheReport) {
    const std::string longest = std::string(251, 'n') + ".csv";
    for (const unsigned attempt : {1U, 2U, 999'999U}) {
        const std::string kept = kept_name(longest, attempt);
        EXPECT_EQ(kept.size() + report_ending.size(), 255U);
        EXPECT_TRUE(kept.ends_with(".csv"));
    }
    std::string umlauts;
    while (umlauts.size() < 250) {
        umlauts += "ü";
    }
    const std::string kept = kept_name("x" + umlauts + ".csv", 1);
    EXPECT_EQ(kept.size(), 243U);
    EXPECT_EQ(kept_name(umlauts + ".csv", 1).size(), 242U) << "cut between two characters";
    EXPECT_EQ(kept_name(std::string(255, '\x80'), 1).size(), 1U) << "no characters at all";
}

} // namespace
} // namespace linefeed::intake
