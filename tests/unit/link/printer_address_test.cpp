// Printer addresses as people type them, good and bad.
#include "link/printer_address.hpp"

#include <gtest/gtest.h>

namespace linefeed::link {
namespace {

PrinterAddress read(const char* text) {
    return parse_printer_address(text).value();
}

TEST(PrinterAddress, shouldReadHostAndPort) {
    EXPECT_EQ(read("tcp://192.168.1.20:3002"), (PrinterAddress{"192.168.1.20", 3002}));
    EXPECT_EQ(read("tcp://jet-4.line:65535"), (PrinterAddress{"jet-4.line", 65535}));
    EXPECT_EQ(read("tcp://printer:1/"), (PrinterAddress{"printer", 1}));
}

TEST(PrinterAddress, shouldTakeThePrintersUsualPortIfNoneIsGiven) {
    EXPECT_EQ(read("tcp://printer"), (PrinterAddress{"printer", 3000}));
    EXPECT_EQ(read("tcp://[::1]"), (PrinterAddress{"::1", 3000}));
}

TEST(PrinterAddress, shouldReadIpv6InBrackets) {
    EXPECT_EQ(read("tcp://[fe80::1]:2201"), (PrinterAddress{"fe80::1", 2201}));
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
              "\"printer:3000\" is not a printer address: expected tcp://HOST:PORT, e.g. tcp://192.168.1.20:3000");
}

TEST(PrinterAddress, shouldWriteWhatItReads) {
    for (const char* text : {"tcp://192.168.1.20:3002", "tcp://[fe80::1]:2201"}) {
        EXPECT_EQ(to_string(parse_printer_address(text).value()), text);
    }
}

TEST(PrinterAddress, shouldResolveNumericAddresses) {
    const auto endpoints = resolve({"127.0.0.1", 4711});
    ASSERT_TRUE(endpoints);
    ASSERT_EQ(endpoints->size(), 1U);
    EXPECT_EQ(endpoints->front().address().to_string(), "127.0.0.1");
    EXPECT_EQ(endpoints->front().port(), 4711);
}

TEST(PrinterAddress, shouldNameAHostThatCannotBeFound) {
    const auto endpoints = resolve({"no-such-host.invalid", 3000});
    ASSERT_FALSE(endpoints);
    EXPECT_EQ(endpoints.error().kind, FailureKind::unreachable);
    EXPECT_TRUE(endpoints.error().message.starts_with("tcp://no-such-host.invalid:3000: cannot find the host"))
        << endpoints.error().message;
}

} // namespace
} // namespace linefeed::link
