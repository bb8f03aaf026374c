// Files: the configuration, and the table that it names.
#include "texts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <unistd.h>

namespace linefeed::config {
namespace {

using testing::ElementsAre;
using testing::EndsWith;

class Load : public testing::Test {
protected:
    Load() {
        std::string pattern = (std::filesystem::temp_directory_path() / "linefeed-config-XXXXXX").string();
        directory_ = ::mkdtemp(pattern.data());
    }
    ~Load() override { std::filesystem::remove_all(directory_); }

    std::filesystem::path write(const std::string& name, const std::string& text) {
        std::ofstream{directory_ / name, std::ios::binary} << text;
        return directory_ / name;
    }
    std::vector<std::string> refusals(const std::filesystem::path& file) {
        const auto settings = load(file, {});
        return settings ? std::vector<std::string>{} : lines_of(settings.error());
    }

    std::filesystem::path directory_;
};

TEST_F(Load, shouldReadTheTableBesideTheConfiguration) {
    write("e.yaml", "errors: {7: {meaning: m, advice: a, policy: stop}}\n");
    const auto settings = load(write("l.yaml", "errors: e.yaml\n"), {});
    ASSERT_TRUE(settings);
    ASSERT_EQ(settings->errors.entries.size(), 1U);
    EXPECT_EQ(settings->errors.entries.front().meaning, "m");
}

TEST_F(Load, shouldTellWhatIsWrongWithBothFiles) {
    const auto table = write("e.yaml", "errors: {7: {meaning: m}}\n");
    const auto file = write("l.yaml", "errors: e.yaml\nx: 1\n");
    EXPECT_THAT(refusals(file),
                ElementsAre(testing::StartsWith(file.string() + ":2:1: x: unknown key"),
                            table.string() + ":1:13: errors.7.advice: missing: this key must be there",
                            table.string() + ":1:13: errors.7.policy: missing: this key must be there"));
}

TEST_F(Load, shouldRefuseFilesThatCannotBeRead) {
    EXPECT_THAT(refusals(directory_ / "none.yaml"),
                ElementsAre((directory_ / "none.yaml").string() + ": No such file or directory"));
    EXPECT_THAT(refusals(directory_), ElementsAre(directory_.string() + ": not a file"));
    EXPECT_THAT(refusals("/dev/zero"), ElementsAre("/dev/zero: not a file"));
    EXPECT_THAT(refusals(write("l.yaml", "errors: none.yaml\n")),
                ElementsAre(EndsWith("l.yaml:1:9: errors: cannot read \"" + (directory_ / "none.yaml").string() +
                                     "\": No such file or directory")));
    EXPECT_THAT(refusals(write("big.yaml", std::string(max_file_bytes + 5, '#'))),
                ElementsAre(EndsWith("big.yaml: larger than 1024 KiB")));
}

TEST_F(Load, shouldCountThePoliciesOfTableAndPrinterTogether) {
    std::string table = "errors:\n";
    for (int number = 1; number <= 16; ++number) {
        table += "  " + std::to_string(number) + ": {meaning: m, advice: a, policy: acknowledge}\n";
    }
    write("e.yaml", table);
    const std::string printer = "errors: e.yaml\nprinters:\n  p:\n    address: tcp://h\n";
    EXPECT_THAT(refusals(write("good.yaml", printer + "    errors: {16: stop, 17: acknowledge}\n")),
                testing::IsEmpty());
    EXPECT_THAT(
        refusals(write("bad.yaml", printer + "    errors: {17: acknowledge}\n")),
        ElementsAre(EndsWith("bad.yaml:5:13: printers.p.errors: with the table of error numbers, 17 numbers would "
                             "be acknowledged; at most 16")));
    write("e.yaml", table + "  17: {meaning: m, advice: a, policy: acknowledge}\n");
    EXPECT_THAT(refusals(write("bad.yaml", printer)),
                ElementsAre(testing::HasSubstr(":3:3: printers.p: with the table")));
}

} // namespace
} // namespace linefeed::config
