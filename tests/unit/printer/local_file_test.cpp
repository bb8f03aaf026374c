// A file on this side: whole under its name, or not there.
#include "printer/local_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sys/resource.h>

namespace linefeed::printer {
namespace {

namespace fs = std::filesystem;
using Existing = NewFile::Existing;

class LocalFileTest : public testing::Test {
protected:
    LocalFileTest() {
        std::string pattern = testing::TempDir() + "linefeed-XXXXXX";
        folder_ = ::mkdtemp(pattern.data());
    }
    ~LocalFileTest() override { fs::remove_all(folder_); }

    [[nodiscard]] std::size_t entries() const {
        return static_cast<std::size_t>(std::distance(fs::directory_iterator{folder_}, fs::directory_iterator{}));
    }
    fs::path folder_;
};

TEST_F(LocalFileTest, shouldHaveItsNameOnlyWhenItIsWhole) {
    auto file = NewFile::create(folder_ / "a.job", Existing::refuse).value();
    ASSERT_TRUE(file.write("half"));
    EXPECT_FALSE(fs::exists(folder_ / "a.job"));
    ASSERT_TRUE(file.write(" and half"));
    ASSERT_TRUE(file.commit());
    EXPECT_EQ(read_file(folder_ / "a.job", 100).value(), "half and half");
    EXPECT_EQ(entries(), 1U);
}

TEST_F(LocalFileTest, shouldLeaveNothingBehindUnlessItIsCommitted) {
    {
        auto file = NewFile::create(folder_ / "a.job", Existing::replace).value();
        ASSERT_TRUE(file.write("half"));
    }
    EXPECT_EQ(entries(), 0U);
}

TEST_F(LocalFileTest, shouldReplaceOnlyIfAsked) {
    std::ofstream{folder_ / "a.job"} << "old";
    EXPECT_EQ(NewFile::create(folder_ / "a.job", Existing::refuse).error().kind, FailureKind::usage);
    auto file = NewFile::create(folder_ / "a.job", Existing::replace).value();
    ASSERT_TRUE(file.write("new"));
    EXPECT_EQ(read_file(folder_ / "a.job", 100).value(), "old");
    ASSERT_TRUE(file.commit());
    EXPECT_EQ(read_file(folder_ / "a.job", 100).value(), "new");
}

TEST_F(LocalFileTest, shouldNotReplaceWhatHasAppearedMeanwhile) {
    auto file = NewFile::create(folder_ / "a.job", Existing::refuse).value();
    std::ofstream{folder_ / "a.job"} << "other";
    ASSERT_TRUE(file.write("mine"));
    EXPECT_EQ(file.commit().error().kind, FailureKind::usage);
    EXPECT_EQ(read_file(folder_ / "a.job", 100).value(), "other");
}

TEST_F(LocalFileTest, shouldReplaceNothingButFiles) {
    fs::create_directory(folder_ / "directory");
    EXPECT_EQ(NewFile::create(folder_ / "directory", Existing::replace).error().kind, FailureKind::usage);
}

TEST_F(LocalFileTest, shouldSayWhyItCannotBeWritten) {
    EXPECT_EQ(NewFile::create(folder_ / "none" / "a.job", Existing::refuse).error().kind, FailureKind::storage);
    {
        auto file = NewFile::create(folder_ / "a.job", Existing::refuse).value();
        rlimit before{};
        ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
        std::signal(SIGXFSZ, SIG_IGN);
        rlimit small = before;
        small.rlim_cur = 1000;
        ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
        const auto written = file.write(std::string(2000, 'x'));
        ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
        ASSERT_FALSE(written);
        EXPECT_EQ(written.error().kind, FailureKind::storage);
    }
    EXPECT_EQ(entries(), 0U);
}

TEST_F(LocalFileTest, shouldReadRegularFilesOfABearableSize) {
    std::ofstream{folder_ / "a"} << "12345";
    EXPECT_EQ(read_file(folder_ / "a", 5).value(), "12345");
    EXPECT_THAT(read_file(folder_ / "a", 4).error().message, testing::HasSubstr("more than 4 bytes"));
    EXPECT_EQ(read_file(folder_, 5).error().kind, FailureKind::input);
    EXPECT_EQ(read_file(folder_ / "none", 5).error().kind, FailureKind::input);
    EXPECT_EQ(read_file("/dev/zero", 5).error().kind, FailureKind::input);
}

TEST(Sha256, shouldAgreeWithTheStandard) {
    EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

} // namespace
} // namespace linefeed::printer
