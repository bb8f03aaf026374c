// Paths as people write them and as the printer wants them.
#include "printer/printer_path.hpp"

#include <gtest/gtest.h>

namespace linefeed::printer {
namespace {

using protocol::EscapeMode;

std::string made(std::string_view text) {
    return printer_path(text, EscapeMode::backslash).value();
}
bool refused(std::string_view text, EscapeMode escapes = EscapeMode::backslash) {
    const auto path = printer_path(text, escapes);
    return !path && path.error().kind == FailureKind::usage;
}

TEST(PrinterPath, shouldTakePathsAsPeopleWriteThem) {
    EXPECT_EQ(made("FFSDISK\\Jobs\\A b.job"), "FFSDISK\\Jobs\\A b.job");
    EXPECT_EQ(made("\\FFSDISK\\Jobs\\"), "FFSDISK\\Jobs");
    EXPECT_EQ(made("FFSDISK/Fonts/ISO*.lft"), "FFSDISK\\Fonts\\ISO*.lft");
    EXPECT_EQ(made("FFSDISK\\Jobs\\Größe €.job"), "FFSDISK\\Jobs\\Gr\xF6\xDF"
                                                  "e \x80.job");
}

TEST(PrinterPath, shouldRefuseWhatIsNoPath) {
    EXPECT_TRUE(refused(""));
    EXPECT_TRUE(refused("\\"));
    EXPECT_TRUE(refused("a\tb"));
    EXPECT_TRUE(refused("a\rb"));
    EXPECT_TRUE(refused(std::string_view{"a\0b", 3}));
    EXPECT_TRUE(refused("a\x7f"));
    EXPECT_TRUE(refused("FFSDISK\\..\\x"));
    EXPECT_TRUE(refused("./x"));
    EXPECT_TRUE(refused("\xff"));
    EXPECT_TRUE(refused("日本"));
    EXPECT_TRUE(refused(std::string(261, 'x')));
    EXPECT_TRUE(refused("a^b", EscapeMode::none));
    EXPECT_FALSE(refused("a^b"));
    EXPECT_FALSE(refused("FFSDISK\\Jobs", EscapeMode::none));
}

TEST(PrinterPath, shouldGiveEveryNameOfAPrinterBack) {
    for (int byte = 0x20; byte < 0x100; ++byte) {
        if (byte == 0x7F || byte == '/' || byte == '\\') {
            continue;
        }
        const std::string name = std::string{"x"} + static_cast<char>(byte);
        EXPECT_EQ(made(path_text(name)), name) << byte;
    }
}

TEST(PrinterPath, shouldNameOneFile) {
    EXPECT_FALSE(printer_file("FFSDISK\\Jobs\\*.job", EscapeMode::backslash));
    EXPECT_EQ(printer_job("A.job", EscapeMode::backslash).value(), "FFSDISK\\Jobs\\A.job");
    EXPECT_EQ(printer_job("USB-Stick\\LJ3\\Jobs\\A.job", EscapeMode::backslash).value(), "USB-Stick\\LJ3\\Jobs\\A.job");
    EXPECT_FALSE(printer_job("A*", EscapeMode::backslash));
}

TEST(PrinterPath, shouldKnowTheSameFile) {
    EXPECT_TRUE(same_path("\\FFSDISK\\JOBS\\a.job", "FFSDISK\\Jobs\\A.JOB"));
    EXPECT_FALSE(same_path("FFSDISK\\Jobs\\A.job", "FFSDISK\\Jobs\\B.job"));
}

TEST(PrinterPath, shouldKnowTheDefaultDirectories) {
    EXPECT_TRUE(in_default_directory("FFSDISK\\Jobs\\A.job"));
    EXPECT_TRUE(in_default_directory("\\usb-stick\\LJet2neo\\fonts\\A.lft"));
    EXPECT_FALSE(in_default_directory("FFSDISK\\Jobs"));
    EXPECT_FALSE(in_default_directory("FFSDISK\\Jobs\\"));
    EXPECT_FALSE(in_default_directory("FFSDISK\\Jobsen\\A.job"));
    EXPECT_FALSE(in_default_directory("Windows\\A.job"));
}

} // namespace
} // namespace linefeed::printer
