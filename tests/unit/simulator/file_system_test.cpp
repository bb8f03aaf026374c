// Masks and directories of the printer's memory.
#include "simulator/file_system.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace linefeed::simulator {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<std::string> names(const FileSystem& files, std::string_view path) {
    std::vector<std::string> out;
    for (const auto& entry : files.list(path)) {
        out.push_back((entry.is_directory ? "!" : "") + entry.name);
    }
    return out;
}

TEST(FileSystem, shouldMatchMasks) {
    for (const auto& [name, mask] :
         {std::pair{"Testprint.job", "*"}, std::pair{"Testprint.job", "*.JOB"}, std::pair{"Testprint.job", "test*"},
          std::pair{"Testprint.job", "*print*"}, std::pair{"Testprint.job", "T*t*.j?b"}, std::pair{"noext", "*.*"},
          std::pair{"aab", "*ab"}, std::pair{"", "*"}, std::pair{"", ""}, std::pair{"a*b", "a*b"}}) {
        EXPECT_TRUE(matches(name, mask)) << name << " " << mask;
    }
    for (const auto& [name, mask] :
         {std::pair{"Testprint.job", "*.bmp"}, std::pair{"Testprint.job", "test"}, std::pair{"Testprint.job", "?"},
          std::pair{"", "?"}, std::pair{"a", ""}, std::pair{"abc", "*b"}}) {
        EXPECT_FALSE(matches(name, mask)) << name << " " << mask;
    }
}

TEST(FileSystem, shouldListFromTheTopDown) {
    const FileSystem files{*protocol::profile_by_name("jet3")};
    EXPECT_THAT(names(files, "*"), ElementsAre("!FFSDISK", "!Storage Card", "!USB-Stick"));
    EXPECT_THAT(names(files, "\\FFSDISK\\"), ElementsAre("!FFSDISK"));
    EXPECT_THAT(names(files, "ffsdisk\\*"), ElementsAre("!Jobs", "!Fonts", "!Graphics"));
    EXPECT_THAT(names(files, "FFSDISK\\J*"), ElementsAre("!Jobs"));
    EXPECT_THAT(names(files, "Storage Card\\*"), ElementsAre("!LJ3"));
    EXPECT_THAT(names(files, "Storage Card\\LJ3\\*"), ElementsAre("!Jobs", "!Fonts", "!Graphics"));
    EXPECT_THAT(names(files, "FFSDISK\\Jobs\\D*"), ElementsAre("DATE.JOB", "DM.JOB"));
    EXPECT_THAT(names(files, "FFSDISK\\Jobs\\dm.job"), ElementsAre("DM.JOB"));
    EXPECT_THAT(names(files, "FFSDISK\\Graphics\\*"), IsEmpty());
    EXPECT_THAT(names(files, "FFSDISK\\Nowhere\\*"), IsEmpty());
    EXPECT_THAT(names(files, ""), IsEmpty());
}

TEST(FileSystem, shouldWriteIntoItsDirectoriesOnly) {
    FileSystem files{*protocol::profile_by_name("jet3up")};
    EXPECT_TRUE(files.write("\\FFSDISK\\Jobs\\New.job", "a"));
    EXPECT_TRUE(files.write("ffsdisk\\jobs\\NEW.JOB", "bb"));
    EXPECT_EQ(*files.read("FFSDISK\\Jobs\\New.job"), "bb") << "replaced";
    EXPECT_EQ(*files.read("New.job"), "bb") << "a name alone is that of a job";
    EXPECT_EQ(names(files, "FFSDISK\\Jobs\\*").size(), 7U);
    for (const char* const path : {"", "x.job", "FFSDISK\\x.job", "FFSDISK\\Jobs\\", "FFSDISK\\Jobs\\*.job",
                                   "FFSDISK\\Jobs\\deeper\\x.job", "C:\\x.job", "Storage Card\\LJ3\\Jobs\\x.job"}) {
        EXPECT_FALSE(files.write(path, "x")) << path;
    }
    EXPECT_EQ(files.free_kbyte(), 24575U);
    EXPECT_TRUE(files.remove("new.job"));
    EXPECT_FALSE(files.remove("new.job"));
    EXPECT_EQ(files.read("new.job"), nullptr);
}

TEST(FileSystem, shouldReplaceTheFilesThatItCameWith) {
    FileSystem files{*protocol::profile_by_name("jet3up")};
    EXPECT_TRUE(files.write("FFSDISK\\Jobs\\DM.JOB", "x")) << "shorter than before";
    EXPECT_EQ(*files.read("FFSDISK\\Jobs\\DM.JOB"), "x");
    EXPECT_EQ(files.free_kbyte(), 24576U);
    EXPECT_FALSE(files.write("FFSDISK\\Jobs\\DM.JOB", std::string(25U << 20U, 'x'))) << "no room";
    EXPECT_TRUE(files.remove("FFSDISK\\Fonts\\ISO1_7x5.lft"));
    EXPECT_EQ(files.free_kbyte(), 24581U);
}

} // namespace
} // namespace linefeed::simulator
