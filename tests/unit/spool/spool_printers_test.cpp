// What the spool remembers of printers.
#include "spool_fixture.hpp"

#include <gmock/gmock.h>

namespace linefeed::spool {
namespace {

using testing::ElementsAre;

using SpoolPrintersTest = SpoolTest;

TEST_F(SpoolPrintersTest, shouldKeepWhichMachineStandsBehindTheNameOfAPrinter) {
    {
        Spool spool = open();
        EXPECT_EQ(spool.serial_number("line1").value(), "");
        ASSERT_TRUE(spool.write_serial_number("line1", "104711"));
        ASSERT_TRUE(spool.write_serial_number("line2", "7"));
        ASSERT_TRUE(spool.write_serial_number("line1", "104712"));
    }
    Spool spool = open();
    EXPECT_EQ(spool.serial_number("line1").value(), "104712");
    EXPECT_EQ(spool.serial_number("line2").value(), "7");
}

TEST_F(SpoolPrintersTest, shouldLearnWhichMachineAPrinterIsOnlyOnce) {
    Spool spool = open();
    EXPECT_EQ(spool.learn_serial_number("line1", "104711").value(), "104711");
    EXPECT_EQ(spool.learn_serial_number("line1", "7").value(), "104711") << "that takes an operator";
    EXPECT_EQ(spool.serial_number("line1").value(), "104711");
    EXPECT_EQ(spool.learn_serial_number("line0", "104711").value(), "104711");
    ASSERT_TRUE(spool.write_serial_number("line2", "7"));
    EXPECT_THAT(spool.printers_of_machine("104711").value(), ElementsAre("line0", "line1"));
    EXPECT_TRUE(spool.printers_of_machine("8").value().empty());
}

TEST_F(SpoolPrintersTest, shouldKeepWhatAPrinterHasToldAndAProbeHasFound) {
    const PrinterMemory probed{"104711", "JET3up", "V62.0.9.0", R"({"keeps_stop_at":false})", 4711};
    {
        Spool spool = open();
        EXPECT_EQ(spool.printer_memory("line1").value(), std::nullopt);
        ASSERT_TRUE(spool.write_printer_memory("line1", {"104711", "JET3up", "V62.0.9.0", {}, 0}));
        ASSERT_TRUE(spool.write_printer_memory("line1", probed));
        ASSERT_TRUE(spool.write_printer_memory("line2", {"7", "", "", {}, 0}));
    }
    Spool spool = open();
    EXPECT_EQ(spool.printer_memory("line1").value(), probed);
    EXPECT_EQ(spool.printer_memory("line2").value(), (PrinterMemory{"7", "", "", {}, 0}));
}

} // namespace
} // namespace linefeed::spool
