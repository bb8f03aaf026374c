#include "link/serial_port.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <linux/serial.h>
#include <string>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>
#include <utility>

namespace linefeed::link {

namespace {

constexpr std::array<std::uint32_t, 12> speeds{1200,  2400,   4800,   9600,   19200,  38400,
                                               57600, 115200, 230400, 460800, 500000, 921600};
constexpr std::array<speed_t, speeds.size()> speed_codes{B1200,  B2400,   B4800,   B9600,   B19200,  B38400,
                                                         B57600, B115200, B230400, B460800, B500000, B921600};

speed_t code_of(std::uint32_t baud) {
    return speed_codes.at(static_cast<std::size_t>(std::ranges::find(speeds, baud) - speeds.begin()));
}

/// Closes what is not released.
class Descriptor {
public:
    explicit Descriptor(int value)
        : value_(value) {}
    ~Descriptor() {
        if (value_ >= 0) {
            ::close(value_);
        }
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    [[nodiscard]] int get() const { return value_; }
    [[nodiscard]] int release() { return std::exchange(value_, -1); }

private:
    int value_;
};

Failure failed(const std::string& what) {
    return {FailureKind::unreachable, what};
}

Failure cannot_open(int error) {
    switch (error) {
    case ENOENT:
        return failed("there is no such device: is the adapter plugged in?");
    case EACCES:
        return failed("permission denied: put the user into the group dialout");
    case EBUSY:
        return failed("the port is in use by another program");
    default:
        return failed(std::string{"cannot open the port: "} + std::strerror(error));
    }
}

/// The printer's bytes as they are, 8N1; nobody's hanging up ends a line that has no modem. What others have left set
/// must not add bytes of its own (IXOFF), nor take any away.
bool set_up(int descriptor, const SerialAddress& address) {
    termios line{};
    if (::tcgetattr(descriptor, &line) != 0) {
        return false;
    }
    ::cfmakeraw(&line);
    line.c_iflag &= ~static_cast<tcflag_t>(IXOFF | IXANY | INPCK);
    line.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | PARENB | CMSPAR | CRTSCTS | HUPCL);
    line.c_cflag |= CLOCAL | CREAD | (address.flow == FlowControl::rtscts ? CRTSCTS : 0U);
    line.c_iflag |= IGNBRK;
    line.c_cc[VMIN] = 1;
    line.c_cc[VTIME] = 0;
    if (::cfsetspeed(&line, code_of(address.baud)) != 0 || ::tcsetattr(descriptor, TCSANOW, &line) != 0) {
        return false;
    }
    termios taken{}; // tcsetattr() is content if anything at all was set
    if (::tcgetattr(descriptor, &taken) != 0) {
        return false;
    }
    constexpr tcflag_t needed = CSIZE | CSTOPB | PARENB | CRTSCTS;
    errno = EINVAL;
    return ::cfgetospeed(&taken) == ::cfgetospeed(&line) && (taken.c_cflag & needed) == (line.c_cflag & needed) &&
           (taken.c_iflag & (IXON | IXOFF)) == 0;
}

/// Drivers gather bytes for up to 16 ms unless told otherwise. Not all can be told: udev rules do it for USB adapters.
void ask_for_low_latency(int descriptor) {
    serial_struct driver{};
    if (::ioctl(descriptor, TIOCGSERIAL, &driver) == 0) {
        driver.flags |= static_cast<int>(ASYNC_LOW_LATENCY);
        static_cast<void>(::ioctl(descriptor, TIOCSSERIAL, &driver));
    }
}

} // namespace

std::span<const std::uint32_t> serial_speeds() {
    return speeds;
}

double bytes_per_second(const SerialAddress& address) {
    constexpr double bits_per_byte = 10.0;
    return address.baud / bits_per_byte;
}

Result<int> open_serial(const SerialAddress& address) {
    Descriptor port{::open(address.device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)};
    if (port.get() < 0) {
        return cannot_open(errno);
    }
    if (::isatty(port.get()) == 0) {
        return failed("this is not a serial port");
    }
    // TIOCEXCL keeps others from opening it, but for root; the lock is what programs for serial lines ask each other
    // by.
    if (::flock(port.get(), LOCK_EX | LOCK_NB) != 0) {
        return cannot_open(EBUSY);
    }
    if (::ioctl(port.get(), TIOCEXCL) != 0 || !set_up(port.get(), address)) {
        return failed("cannot set the port to " + std::to_string(address.baud) + " baud" +
                      (address.flow == FlowControl::rtscts ? " with flow=rtscts" : "") + ": " + std::strerror(errno));
    }
    ask_for_low_latency(port.get());
    ::tcflush(port.get(), TCIFLUSH);
    return port.release();
}

int bytes_waiting(int descriptor) {
    int bytes = 0;
    return ::ioctl(descriptor, TIOCOUTQ, &bytes) == 0 ? bytes : 0;
}

void discard_waiting(int descriptor) {
    ::tcflush(descriptor, TCOFLUSH);
}

} // namespace linefeed::link
