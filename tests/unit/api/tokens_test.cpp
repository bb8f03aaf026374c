// The file of tokens: what it may say, who may read it, and that only the token itself opens anything.
#include "api/tokens.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace linefeed::api {
namespace {

Result<Tokens> parsed(std::string_view text) {
    return Tokens::parse(text, "/etc/linefeed/tokens");
}

TEST(Tokens, ANewTokenOpensWithItsRoleAndNothingElseDoes) {
    const auto viewer = make_token("mes", Role::viewer);
    const auto operates = make_token("panel-2", Role::operator_);
    ASSERT_TRUE(viewer && operates);
    const auto tokens = parsed("# tokens\n\n" + viewer->line + "\r\n  " + operates->line);
    ASSERT_TRUE(tokens) << tokens.error().message;
    EXPECT_EQ(tokens->size(), 2U);
    ASSERT_NE(tokens->find(viewer->token), nullptr);
    EXPECT_EQ(tokens->find(viewer->token)->name, "mes");
    EXPECT_EQ(tokens->find(viewer->token)->role, Role::viewer);
    EXPECT_EQ(tokens->find(operates->token)->role, Role::operator_);
    EXPECT_EQ(tokens->find(""), nullptr);
    EXPECT_EQ(tokens->find(viewer->token.substr(1)), nullptr);
    EXPECT_EQ(tokens->find(viewer->line), nullptr);
}

TEST(Tokens, TheTokenIsLongRandomAndNotInTheLine) {
    const auto one = make_token("a", Role::viewer);
    const auto two = make_token("a", Role::viewer);
    ASSERT_TRUE(one && two);
    EXPECT_NE(one->token, two->token);
    EXPECT_EQ(one->token.size(), std::string_view{"linefeed_"}.size() + 64);
    EXPECT_EQ(one->line.find(one->token), std::string::npos);
    EXPECT_TRUE(one->line.starts_with("a viewer sha256:"));
}

TEST(Tokens, ANameThatWouldBreakTheLineIsRefused) {
    for (const std::string name : {"", "a b", "a\nb", "#a", "ä", "../x/"}) {
        EXPECT_FALSE(make_token(name, Role::viewer)) << name;
    }
    EXPECT_FALSE(make_token(std::string(65, 'a'), Role::viewer));
    EXPECT_TRUE(make_token(std::string(64, 'a'), Role::viewer));
}

TEST(Tokens, EveryWrongLineIsNamed) {
    const std::string hash = "sha256:" + std::string(64, 'a');
    for (const std::string& line : std::vector<std::string>{
             "mes", "mes viewer", "mes admin " + hash, "m/s viewer " + hash,
             "mes viewer sha256:" + std::string(63, 'a'), "mes viewer sha256:" + std::string(63, 'a') + "g",
             "mes viewer scrypt:" + std::string(64, 'a'), "mes viewer " + hash + " more",
             "mes viewer " + hash + "\nmes operator sha256:" + std::string(64, 'b')}) {
        const auto tokens = parsed("# first\n" + line);
        ASSERT_FALSE(tokens) << line;
        EXPECT_EQ(tokens.error().kind, FailureKind::usage);
        EXPECT_TRUE(tokens.error().message.starts_with("/etc/linefeed/tokens:2: ") ||
                    tokens.error().message.starts_with("/etc/linefeed/tokens:3: "))
            << tokens.error().message;
    }
}

TEST(Tokens, ThereAreOnlySoMany) {
    std::string text;
    for (std::size_t k = 0; k < Tokens::max_tokens; ++k) {
        text += "t" + std::to_string(k) + " viewer sha256:" + std::string(64, '0') + '\n';
    }
    EXPECT_TRUE(parsed(text));
    EXPECT_FALSE(parsed(text + "one-more viewer sha256:" + std::string(64, '0')));
}

class TokenFile : public testing::Test {
protected:
    void SetUp() override {
        std::filesystem::create_directories(directory_);
        std::ofstream{file_} << make_token("mes", Role::viewer)->line << '\n';
    }
    void TearDown() override { std::filesystem::remove_all(directory_); }
    [[nodiscard]] bool usable_with(unsigned mode) const {
        std::filesystem::permissions(file_, static_cast<std::filesystem::perms>(mode));
        return Tokens::load(file_).has_value();
    }

    const std::filesystem::path directory_ =
        std::filesystem::temp_directory_path() / ("linefeed_tokens_" + std::to_string(::getpid()));
    const std::filesystem::path file_ = directory_ / "tokens";
};

TEST_F(TokenFile, IsUsedOnlyIfOthersCannotReadItAndTheGroupCannotWriteIt) {
    EXPECT_TRUE(usable_with(0600));
    EXPECT_TRUE(usable_with(0640));
    EXPECT_FALSE(usable_with(0644));
    EXPECT_FALSE(usable_with(0660));
    EXPECT_FALSE(usable_with(0602));
    EXPECT_FALSE(usable_with(0601));
}

TEST_F(TokenFile, MustBeAFileOfAReasonableSize) {
    EXPECT_FALSE(Tokens::load(directory_ / "nothing"));
    EXPECT_FALSE(Tokens::load("/dev/null"));
    std::filesystem::permissions(file_, static_cast<std::filesystem::perms>(0600));
    std::ofstream{file_} << std::string(Tokens::max_bytes + 1, '\n');
    EXPECT_FALSE(Tokens::load(file_));
}

} // namespace
} // namespace linefeed::api
