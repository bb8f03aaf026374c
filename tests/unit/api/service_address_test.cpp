// Where the service is.
#include "api/service_address.hpp"

#include <gtest/gtest.h>

namespace linefeed::api {
namespace {

TEST(ServiceAddress, IsASocketOrAHost) {
    EXPECT_EQ(parse_service_address("/run/x.sock").value(), (ServiceAddress{"/run/x.sock", "", 0}));
    EXPECT_EQ(parse_service_address("unix:/run/x.sock").value(), (ServiceAddress{"/run/x.sock", "", 0}));
    EXPECT_EQ(parse_service_address("tcp://host:3000").value(), (ServiceAddress{"", "host", 3000}));
    EXPECT_EQ(parse_service_address("tcp://host").value(), (ServiceAddress{"", "host", 8631}));
    EXPECT_EQ(parse_service_address("tcp://[::1]").value(), (ServiceAddress{"", "::1", 8631}));
    EXPECT_EQ(parse_service_address("tcp://[::1]:80").value(), (ServiceAddress{"", "::1", 80}));
    for (const std::string text :
         {"", "run/x.sock", "http://host", "tcp://", "tcp://host:0", "tcp://host:x", "unix:x"}) {
        EXPECT_FALSE(parse_service_address(text)) << text;
    }
    EXPECT_EQ(to_string(ServiceAddress{"", "::1", 80}), "tcp://[::1]:80");
    EXPECT_EQ(to_string(ServiceAddress{"/run/x.sock", "", 0}), "/run/x.sock");
}

} // namespace
} // namespace linefeed::api
