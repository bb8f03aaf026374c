// Opening a serial line, on pseudo-terminals: raw bytes both ways, for one program at a time.
#include "link/serial_port.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fcntl.h>
#include <poll.h>
#include <string>
#include <termios.h>
#include <unistd.h>

namespace linefeed::link {
namespace {

class Terminal {
public:
    Terminal() {
        if (::grantpt(master_) != 0 || ::unlockpt(master_) != 0) {
            ADD_FAILURE() << "no pseudo-terminal";
        }
    }
    ~Terminal() { ::close(master_); }
    Terminal(const Terminal&) = delete;
    Terminal& operator=(const Terminal&) = delete;

    [[nodiscard]] SerialAddress address(std::uint32_t baud = 115200) const {
        std::array<char, 128> name{};
        EXPECT_EQ(::ptsname_r(master_, name.data(), name.size()), 0);
        return {.device = name.data(), .baud = baud, .flow = FlowControl::rtscts};
    }
    [[nodiscard]] int master() const { return master_; }

private:
    int master_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
};

std::string read_from(int descriptor) {
    pollfd ready{descriptor, POLLIN, 0};
    constexpr int patience_ms = 5000;
    std::array<char, 256> bytes{};
    const auto size = ::poll(&ready, 1, patience_ms) == 1 ? ::read(descriptor, bytes.data(), bytes.size()) : 0;
    return {bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0))};
}

TEST(SerialPort, shouldCarryBytesAsTheyAre) {
    const Terminal terminal;
    const int port = open_serial(terminal.address()).value();
    const std::string out = "^0=MR1\tA\x03\x11\x13\x7F\xFF\r";
    ASSERT_EQ(::write(port, out.data(), out.size()), static_cast<ssize_t>(out.size()));
    EXPECT_EQ(read_from(terminal.master()), out);
    const std::string in = "^0=RS2\t6\t0\t0\t0\r\n";
    ASSERT_EQ(::write(terminal.master(), in.data(), in.size()), static_cast<ssize_t>(in.size()));
    EXPECT_EQ(read_from(port), in);
    ::close(port);
}

TEST(SerialPort, shouldSetTheLineUp) {
    const Terminal terminal;
    const int port = open_serial(terminal.address(9600)).value();
    termios line{};
    ASSERT_EQ(::tcgetattr(port, &line), 0);
    EXPECT_EQ(::cfgetospeed(&line), static_cast<speed_t>(B9600));
    EXPECT_EQ(::cfgetispeed(&line), static_cast<speed_t>(B9600));
    EXPECT_EQ(line.c_cflag & static_cast<tcflag_t>(CSIZE), static_cast<tcflag_t>(CS8));
    EXPECT_EQ(line.c_cflag & static_cast<tcflag_t>(PARENB | CSTOPB), 0U);
    EXPECT_NE(line.c_cflag & static_cast<tcflag_t>(CLOCAL), 0U);
    EXPECT_NE(::fcntl(port, F_GETFD) & FD_CLOEXEC, 0);
    EXPECT_NE(::fcntl(port, F_GETFL) & O_NONBLOCK, 0);
    ::close(port);
}

/// XON and XOFF are bytes like any other, and the port must not send some of its own.
TEST(SerialPort, shouldUndoWhatOthersHaveSet) {
    const Terminal terminal;
    const int keeper = ::open(terminal.address().device.c_str(), O_RDWR | O_NOCTTY);
    termios left{};
    ASSERT_EQ(::tcgetattr(keeper, &left), 0);
    left.c_iflag |= IXON | IXOFF | IXANY | INPCK | ISTRIP | ICRNL;
    left.c_cflag |= CSTOPB | CMSPAR;
    ASSERT_EQ(::tcsetattr(keeper, TCSANOW, &left), 0);
    const int port = open_serial(terminal.address()).value();
    termios line{};
    ASSERT_EQ(::tcgetattr(port, &line), 0);
    EXPECT_EQ(line.c_iflag & static_cast<tcflag_t>(IXON | IXOFF | IXANY | INPCK | ISTRIP | ICRNL), 0U);
    EXPECT_EQ(line.c_cflag & static_cast<tcflag_t>(CSTOPB | CMSPAR), 0U);
    ::close(port);
    ::close(keeper);
}

TEST(SerialPort, shouldBeOpenForOneAtATime) {
    const Terminal terminal;
    const int port = open_serial(terminal.address()).value();
    const auto second = open_serial(terminal.address());
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().kind, FailureKind::unreachable);
    EXPECT_EQ(second.error().message, "the port is in use by another program");
    ::close(port);
    const auto third = open_serial(terminal.address());
    ASSERT_TRUE(third) << third.error().message;
    ::close(*third);
}

TEST(SerialPort, shouldForgetWhatHadComeInBefore) {
    const Terminal terminal;
    const int keeper = ::open(terminal.address().device.c_str(), O_RDWR | O_NOCTTY);
    const std::string old = "^0=SM256\t0\t7\t0\t1\r";
    ASSERT_EQ(::write(terminal.master(), old.data(), old.size()), static_cast<ssize_t>(old.size()));
    const int port = open_serial(terminal.address()).value();
    std::array<char, 64> bytes{};
    EXPECT_EQ(::read(port, bytes.data(), bytes.size()), -1);
    EXPECT_EQ(errno, EAGAIN);
    ::close(port);
    ::close(keeper);
}

TEST(SerialPort, shouldSayWhyItCannotBeOpened) {
    const auto missing = open_serial({.device = "/dev/no-such-port"});
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().message, "there is no such device: is the adapter plugged in?");
    const auto file = open_serial({.device = "/dev/null"});
    ASSERT_FALSE(file);
    EXPECT_EQ(file.error().message, "this is not a serial port");
}

TEST(SerialPort, shouldTellHowFastItIs) {
    EXPECT_DOUBLE_EQ(bytes_per_second({.device = "/dev/x", .baud = 9600}), 960.0);
    EXPECT_DOUBLE_EQ(bytes_per_second({.device = "/dev/x", .baud = 115200}), 11520.0);
}

} // namespace
} // namespace linefeed::link
