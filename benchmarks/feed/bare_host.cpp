#include "bare_host.hpp"

#include "base/assert.hpp"
#include "call_log.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <array>
#include <netinet/tcp.h>
#include <poll.h>
#include <string_view>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

namespace linefeed::benchmarks {

namespace {

constexpr std::string_view start = "^0!GO\r";
constexpr std::string_view inquiry = "^0?SM\r";

int connect_to(std::uint16_t port) {
    const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(port);
    LINEFEED_ASSERT(::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
    const int on = 1;
    LINEFEED_ASSERT(::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on) == 0);
    return socket;
}

/// `^0=SM<depth>\t<entries>\t<last printed>\t…`
std::uint32_t last_printed(std::string_view answer) {
    const std::size_t first_tab = answer.find('\t');
    std::uint32_t number = 0;
    for (std::size_t i = answer.find('\t', first_tab + 1) + 1; i < answer.size() && answer[i] != '\t'; ++i) {
        number = number * 10 + static_cast<std::uint32_t>(answer[i] - '0');
    }
    return number;
}

} // namespace

BareHost::BareHost(std::uint16_t port, const std::vector<RecordPage>& pages, std::uint32_t depth, Duration poll,
                   const daemon::RealTimeSettings& real_time)
    : pages_(pages)
    , depth_(depth)
    , poll_(poll)
    , thread_([this, port, real_time] { run(port, real_time); }) {}

BareHost::~BareHost() {
    stopping_ = true;
    thread_.join();
}

void BareHost::run(std::uint16_t port, const daemon::RealTimeSettings& real_time) {
    static_cast<void>(daemon::make_real_time(real_time));
    const int socket = connect_to(port);
    ::send(socket, start.data(), start.size(), 0);
    refill(socket, 0);
    std::array<char, 4096> buffer{};
    bool asked = false;
    Instant due = steady_now();
    while (!stopping_) {
        const Duration wait = asked ? Duration{std::chrono::seconds{1}} : std::max(due - steady_now(), Duration{0});
        const timespec timeout{wait.count() / 1000000000, wait.count() % 1000000000};
        pollfd waiting{socket, POLLIN, 0};
        if (::ppoll(&waiting, 1, &timeout, nullptr) == 1) {
            const ssize_t size = ::recv(socket, buffer.data(), buffer.size(), 0);
            if (size <= 0) {
                break;
            }
            refill(socket, last_printed({buffer.data(), static_cast<std::size_t>(size)}));
            asked = false;
            due = steady_now() + poll_;
        } else if (!asked) {
            ::send(socket, inquiry.data(), inquiry.size(), 0);
            asked = true;
        }
    }
    ::close(socket);
}

void BareHost::refill(int socket, std::uint32_t printed) {
    const std::uint32_t records_of_page = static_cast<std::uint32_t>(pages_.front().ends.size());
    const RecordNumber last_of_all = pages_.back().range().last();
    const std::uint32_t through = std::min(printed + depth_, last_of_all.value());
    std::array<iovec, 4> pieces{};
    std::size_t count = 0;
    while (sent_ < through && count < pieces.size()) {
        const RecordPage& page = pages_[sent_ / records_of_page];
        const auto last = std::min(RecordNumber{through}, page.range().last());
        const std::string_view slice = page.slice(RecordRange::closed(RecordNumber{sent_ + 1}, last));
        pieces[count++] = {const_cast<char*>(slice.data()), slice.size()};
        sent_ = last.value();
    }
    msghdr message{};
    message.msg_iov = pieces.data();
    message.msg_iovlen = count;
    ::sendmsg(socket, &message, MSG_NOSIGNAL);
}

} // namespace linefeed::benchmarks
