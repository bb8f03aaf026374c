// Printer addresses as people type them, good and bad.
#include "link/printer_address.hpp"

#include <gtest/gtest.h>

namespace linefeed::link {
namespace {

PrinterAddress read(const char* text) {
    return parse_printer_address(text).value();
}

TEST(PrinterAddress, shouldReadHostAndPort) {
    EXPECT_EQ(read("tcp://192.168.1.20:3002"), (PrinterAddress{TcpAddress{"192.168.1.20", 3002}}));
    EXPECT_EQ(read("tcp://jet-4.line:65535"), (PrinterAddress{TcpAddress{"jet-4.line", 65535}}));
    EXPECT_EQ(read("tcp://printer:1/"), (PrinterAddress{TcpAddress{"printer", 1}}));
}

TEST(PrinterAddress, shouldTakeThePrintersUsualPortIfNoneIsGiven) {
    EXPECT_EQ(read("tcp://printer"), (PrinterAddress{TcpAddress{"printer", 3000}}));
    EXPECT_EQ(read("tcp://[::1]"), (PrinterAddress{TcpAddress{"::1", 3000}}));
}

TEST(PrinterAddress, shouldReadIpv6InBrackets) {
    EXPECT_EQ(read("tcp://[fe80::1]:2201"), (PrinterAddress{TcpAddress{"fe80::1", 2201}}));
}

TEST(PrinterAddress, shouldRefuseWhatIsNoAddress) {
    for (const char* text :
         {"", "printer", "printer:3000", "http://printer:3000", "tcp://", "tcp://:3000", "tcp:///x", "tcp://a b:3000",
          "tcp://user@printer:3000", "tcp://printer:3000/path", "tcp://[::1", "tcp://[]:3000", "tcp://[::1]3000"}) {
        const auto address = parse_printer_address(text);
        ASSERT_FALSE(address) << text;
        EXPECT_EQ(address.error().kind, FailureKind::usage) << text;
    }
}

TEST(PrinterAddress, shouldRefuseWhatIsNoPort) {
    for (const char* text :
         {"tcp://printer:", "tcp://printer:0", "tcp://printer:65536", "tcp://printer:-1", "tcp://printer:+1",
          "tcp://printer:30x", "tcp://printer: 30", "tcp://printer:30:31", "tcp://[::1]:"}) {
        EXPECT_FALSE(parse_printer_address(text)) << text;
    }
}

TEST(PrinterAddress, shouldSayWhatItExpects) {
    const auto address = parse_printer_address("printer:3000");
    ASSERT_FALSE(address);
    EXPECT_EQ(address.error().message,
              "\"printer:3000\" is not a printer address: expected " + std::string{printer_address_forms});
}

TEST(PrinterAddress, shouldReadASerialLine) {
    EXPECT_EQ(read("serial:///dev/ttyUSB0?baud=9600&flow=none&crc=on"),
              (PrinterAddress{SerialAddress{"/dev/ttyUSB0", 9600, FlowControl::none}, true}));
    EXPECT_EQ(read("serial:///dev/serial/by-id/usb-FTDI"),
              (PrinterAddress{SerialAddress{"/dev/serial/by-id/usb-FTDI", 115200, FlowControl::rtscts}}));
    EXPECT_TRUE(read("tcp://printer?crc=on").crc);
    EXPECT_FALSE(read("tcp://printer?crc=off").crc);
}

TEST(PrinterAddress, shouldSayWhatIsWrongWithASerialLine) {
    const auto problem = [](const char* text) { return parse_printer_address(text).error().message; };
    EXPECT_NE(problem("serial://ttyUSB0").find("the device is an absolute path"), std::string::npos);
    EXPECT_NE(problem("serial:///dev/x?baud=9601").find("no speed of \"9601\" baud"), std::string::npos);
    EXPECT_NE(problem("serial:///dev/x?flow=xonxoff").find("flow is rtscts or none"), std::string::npos);
    EXPECT_NE(problem("serial:///dev/x?crc=1").find("crc is on or off"), std::string::npos);
    EXPECT_NE(problem("serial:///dev/x?parity=even").find("it has no option \"parity\""), std::string::npos);
    EXPECT_NE(problem("serial:///dev/x?baud=9600&baud=9600").find("\"baud\" is there twice"), std::string::npos);
    EXPECT_NE(problem("tcp://printer?baud=9600").find("it has no option \"baud\""), std::string::npos);
}

TEST(PrinterAddress, shouldWriteWhatItReads) {
    for (const char* text : {"tcp://192.168.1.20:3002", "tcp://[fe80::1]:2201", "tcp://printer:3000?crc=on",
                             "serial:///dev/ttyUSB0?baud=115200", "serial:///dev/ttyS1?baud=9600&flow=none&crc=on"}) {
        EXPECT_EQ(to_string(parse_printer_address(text).value()), text);
    }
}

TEST(PrinterAddress, shouldResolveNumericAddresses) {
    const auto endpoints = resolve(TcpAddress{"127.0.0.1", 4711});
    ASSERT_TRUE(endpoints);
    ASSERT_EQ(endpoints->size(), 1U);
    EXPECT_EQ(endpoints->front().address().to_string(), "127.0.0.1");
    EXPECT_EQ(endpoints->front().port(), 4711);
}

TEST(PrinterAddress, shouldNameAHostThatCannotBeFound) {
    const auto endpoints = resolve(TcpAddress{"no-such-host.invalid", 3000});
    ASSERT_FALSE(endpoints);
    EXPECT_EQ(endpoints.error().kind, FailureKind::unreachable);
    EXPECT_TRUE(endpoints.error().message.starts_with("tcp://no-such-host.invalid:3000: cannot find the host"))
        << endpoints.error().message;
}

} // namespace
} // namespace linefeed::link
