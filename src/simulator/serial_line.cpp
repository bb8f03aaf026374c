// Byte by byte, see serial_line.hpp.
#include "simulator/serial_line.hpp"

#include "simulator/random_draw.hpp"
#include "simulator/steady_instant.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>
#include <utility>

namespace linefeed::simulator {

namespace {

using boost::system::error_code;

/// Timers need not be finer: at 115200 baud eleven bytes arrive in it.
constexpr Duration beat = std::chrono::milliseconds{1};
/// How often to look whether somebody has opened a port that nobody has open.
constexpr Duration look_for_host = std::chrono::milliseconds{10};
constexpr Duration plugged_out = std::chrono::seconds{1};
constexpr std::size_t chunk = 4096;

} // namespace

SerialLine::SerialLine(boost::asio::io_context& io, ServerHandler& handler, ConnectionId id, SerialSettings settings,
                       protocol::EscapeMode escapes, Duration reply_delay)
    : handler_(handler)
    , id_(id)
    , settings_(std::move(settings))
    , reply_delay_(reply_delay)
    , byte_time_(std::chrono::duration_cast<Duration>(std::chrono::duration<double>{10.0 / settings_.baud}))
    , draw_(settings_.seed)
    , decoder_(escapes)
    , terminal_(io)
    , receive_timer_(io)
    , send_timer_(io)
    , plug_timer_(io) {}

SerialLine::~SerialLine() {
    close();
}

Result<void> SerialLine::open() {
    std::error_code error;
    if (std::filesystem::exists(std::filesystem::symlink_status(settings_.link, error)) &&
        !std::filesystem::is_symlink(settings_.link, error)) {
        return Failure{FailureKind::unreachable, settings_.link + " is there already, and is no link"};
    }
    return make_terminal();
}

Result<void> SerialLine::make_terminal() {
    const int master = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    std::array<char, 128> name{};
    if (master < 0 || ::grantpt(master) != 0 || ::unlockpt(master) != 0 ||
        ::ptsname_r(master, name.data(), name.size()) != 0) {
        if (master >= 0) {
            ::close(master);
        }
        return Failure{FailureKind::unreachable, std::string{"cannot make a terminal: "} + std::strerror(errno)};
    }
    terminal_.assign(master);
    // Raw from the first byte: a terminal would echo, and make line feeds of carriage returns.
    termios line{};
    if (::tcgetattr(master, &line) == 0) {
        ::cfmakeraw(&line);
        ::tcsetattr(master, TCSANOW, &line);
    }
    std::error_code failed;
    std::filesystem::remove(settings_.link, failed);
    std::filesystem::create_symlink(name.data(), settings_.link, failed);
    if (failed) {
        return Failure{FailureKind::unreachable, "cannot make the link " + settings_.link + ": " + failed.message()};
    }
    wait_for_host();
    return {};
}

/// A terminal that nobody has open is at its end for ever: there is nothing to wait for but time.
void SerialLine::wait_for_host() {
    receive_timer_.expires_after(look_for_host);
    receive_timer_.async_wait([this](const error_code& error) {
        if (!error && !closed_) {
            receiving_ = true;
            received_until_ = steady_now() - byte_time_; // a byte may be there by now
            receive();
        }
    });
}

void SerialLine::wait_for_bytes() {
    terminal_.async_wait(boost::asio::posix::stream_descriptor::wait_read, [this](const error_code& error) {
        if (error || closed_) {
            return;
        }
        receiving_ = true;
        received_until_ = steady_now();
        receive_timer_.expires_after(std::max(beat, byte_time_));
        receive_timer_.async_wait([this](const error_code& stopped) {
            if (!stopped && !closed_) {
                receive();
            }
        });
    });
}

void SerialLine::receive() {
    read_available();
    if (!receiving_ || closed_) {
        return; // it waits for something else
    }
    receive_timer_.expires_after(std::max(beat, byte_time_));
    receive_timer_.async_wait([this](const error_code& error) {
        if (!error && !closed_) {
            receive();
        }
    });
}

void SerialLine::read_available() {
    if (!receiving_ || closed_) {
        return;
    }
    const auto arrived = static_cast<std::size_t>((steady_now() - received_until_) / byte_time_);
    if (arrived == 0) {
        return;
    }
    std::array<char, chunk> bytes{};
    const ssize_t size = ::read(terminal_.native_handle(), bytes.data(), std::min(arrived, chunk));
    if (size > 0) {
        set_in_use(true);
        received_until_ += static_cast<Duration::rep>(size) * byte_time_;
        take(over_the_line({bytes.data(), static_cast<std::size_t>(size)}));
        return;
    }
    receiving_ = false;
    if (size < 0 && errno == EAGAIN) {
        set_in_use(true);
        wait_for_bytes();
    } else {
        set_in_use(false);
        wait_for_host();
    }
}

void SerialLine::take(std::string_view bytes) {
    const Instant now = steady_now();
    while (!closed_) {
        const auto result = decoder_.next(bytes);
        if (const auto* const frame = std::get_if<protocol::Frame>(&result)) {
            handler_.on_frame(id_, *frame, now);
        } else if (std::holds_alternative<protocol::FrameError>(result)) {
            handler_.on_damaged_bytes(id_);
        } else {
            return;
        }
    }
}

void SerialLine::send(std::string_view bytes) {
    if (closed_ || waiting_.size() + bytes.size() > max_waiting_bytes) {
        return;
    }
    waiting_ += bytes;
    if (!sending_) {
        sending_ = true;
        sent_until_ = std::max(sent_until_, steady_now() + reply_delay_);
        wait_to_send();
    }
}

void SerialLine::wait_to_send() {
    send_timer_.expires_at(to_steady(std::max(sent_until_ + byte_time_, steady_now() + beat)));
    send_timer_.async_wait([this](const error_code& error) {
        if (!error && !closed_) {
            transmit();
        }
    });
}

void SerialLine::transmit() {
    const auto due = static_cast<std::size_t>((steady_now() - sent_until_) / byte_time_);
    const std::size_t size = std::min({due, waiting_.size(), chunk});
    const std::string arriving = over_the_line(std::string_view{waiting_}.substr(0, size));
    if (terminal_.is_open() && !arriving.empty()) {
        [[maybe_unused]] const auto written = // what a host does not read in time is lost, as on a line
            ::write(terminal_.native_handle(), arriving.data(), arriving.size());
    }
    waiting_.erase(0, size);
    sent_until_ += static_cast<Duration::rep>(size) * byte_time_;
    sending_ = !waiting_.empty();
    if (sending_) {
        wait_to_send();
    }
}

bool SerialLine::draws(std::uint64_t one_in) {
    return one_in != 0 && next_random(draw_) % one_in == 0;
}

std::string SerialLine::over_the_line(std::string_view bytes) {
    std::string arriving;
    for (char byte : bytes) {
        if (draws(settings_.one_lost_in)) {
            continue;
        }
        if (draws(settings_.one_damaged_in)) {
            constexpr std::uint64_t other_bytes = 255;
            byte = static_cast<char>(static_cast<unsigned char>(byte) ^ (1 + next_random(draw_) % other_bytes));
        }
        arriving.push_back(byte);
    }
    return arriving;
}

void SerialLine::set_in_use(bool in_use) {
    if (std::exchange(in_use_, in_use) == in_use) {
        return;
    }
    if (in_use) {
        handler_.on_connected(id_);
    } else {
        handler_.on_disconnected(id_);
    }
}

void SerialLine::replug() {
    error_code ignored;
    terminal_.close(ignored);
    receive_timer_.cancel();
    receiving_ = false;
    waiting_.clear();
    std::error_code unlinked;
    std::filesystem::remove(settings_.link, unlinked);
    set_in_use(false);
    plug_timer_.expires_after(plugged_out);
    plug_timer_.async_wait([this](const error_code& error) {
        if (!error && !closed_) {
            static_cast<void>(make_terminal());
        }
    });
}

void SerialLine::close() {
    if (std::exchange(closed_, true)) {
        return;
    }
    error_code ignored;
    if (terminal_.is_open()) {
        terminal_.close(ignored);
        std::error_code unlinked;
        std::filesystem::remove(settings_.link, unlinked);
    }
    receive_timer_.cancel();
    send_timer_.cancel();
    plug_timer_.cancel();
}

} // namespace linefeed::simulator
