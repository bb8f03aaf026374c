// The hosts that linefeed is compared with, speaking to the simulated printer over loopback. Each prints records 1…N
// and ends; misses are counted by the printer.
//
// - single: the known-bad host: one inquiry, one record, and again. It must miss.
// - manual: the manual's own procedure (annex B): ?RS and ?SM every second, then as many blocks of 50 as there is room
//   for.
// - bare: the credit loop and nothing else: ?SM every millisecond without waiting for the answer before, each answer
//   filled up at once from memory; no file, ledger, doubt or stop. What platform and simulator allow at most.
//
// usage: bench_control_host single|manual|bare PORT RECORDS
#include <algorithm>
#include <arpa/inet.h>
#include <array>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <optional>
#include <poll.h>
#include <string>
#include <string_view>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

[[noreturn]] void fail(const std::string& what) {
    std::perror(("bench_control_host: " + what).c_str());
    std::exit(1);
}

/// What `=SM` says, as far as it is needed.
struct MailStatus {
    std::uint64_t depth = 0;
    std::uint64_t last_printed = 0;
};

/// The printer at the other end.
class Printer {
public:
    explicit Printer(std::uint16_t port)
        : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(port);
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        // The socket interface wants the general type of address.
        if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
            fail("connect");
        }
        const int on = 1;
        ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
    }
    ~Printer() { ::close(socket_); }
    Printer(const Printer&) = delete;
    Printer& operator=(const Printer&) = delete;

    void send(std::string_view bytes) {
        while (!bytes.empty()) {
            const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
            if (sent < 0) {
                fail("send");
            }
            bytes.remove_prefix(static_cast<std::size_t>(sent));
        }
    }

    /// The newest `=SM` that arrives until `deadline`; answers to other inquiries are read and dropped.
    std::optional<MailStatus> mail_status(Clock::time_point deadline) {
        for (;;) {
            if (const auto status = take_newest()) {
                return status;
            }
            const auto left = std::max(Clock::duration::zero(), deadline - Clock::now());
            const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(left);
            const timespec timeout{seconds.count(), std::chrono::nanoseconds{left - seconds}.count()};
            pollfd readable{socket_, POLLIN, 0};
            if (::ppoll(&readable, 1, &timeout, nullptr) <= 0) {
                return std::nullopt;
            }
            std::array<char, 65536> buffer{};
            const ssize_t size = ::recv(socket_, buffer.data(), buffer.size(), 0);
            if (size <= 0) {
                fail("the printer has closed the connection");
            }
            received_.append(buffer.data(), static_cast<std::size_t>(size));
        }
    }

    MailStatus ask() {
        send("^0?SM\r");
        const auto status = mail_status(Clock::now() + std::chrono::seconds{10});
        if (!status) {
            fail("no answer to ?SM");
        }
        return *status;
    }

private:
    std::optional<MailStatus> take_newest() {
        std::optional<MailStatus> newest;
        std::size_t end = 0;
        while ((end = received_.find('\r')) != std::string::npos) {
            unsigned long long depth = 0;
            unsigned long long entries = 0;
            unsigned long long last = 0;
            const std::string line = received_.substr(0, end);
            if (std::sscanf(line.c_str(), "^0=SM%llu\t%llu\t%llu", &depth, &entries, &last) == 3) {
                newest = {depth, last};
            }
            received_.erase(0, end + 1);
        }
        return newest;
    }

    int socket_;
    std::string received_;
};

/// The records and how far they are sent.
class Job {
public:
    explicit Job(std::uint64_t count)
        : count_(count) {}

    /// Sends up to `most` records as far as there is room, in one write.
    void send(Printer& printer, const MailStatus& status, std::uint64_t most) {
        const std::uint64_t through = std::min({count_, status.last_printed + status.depth, sent_ + most});
        block_.clear();
        while (sent_ < through) {
            block_ += "^0=MR" + std::to_string(++sent_) + "\tSN-0000000000-ABCDEFGHIJKLMNOP\r";
        }
        printer.send(block_);
    }
    [[nodiscard]] std::uint64_t room(const MailStatus& status) const {
        return std::min(count_, status.last_printed + status.depth) - sent_;
    }
    [[nodiscard]] bool printed(const MailStatus& status) const { return status.last_printed == count_; }

private:
    std::uint64_t count_;
    std::uint64_t sent_ = 0;
    std::string block_;
};

void print_singly(Printer& printer, Job& job) {
    for (MailStatus status = printer.ask(); !job.printed(status); status = printer.ask()) {
        job.send(printer, status, 1);
    }
}

void print_as_the_manual(Printer& printer, Job& job) {
    constexpr std::uint64_t block = 50;
    auto due = Clock::now();
    for (;;) {
        due += std::chrono::seconds{1};
        std::this_thread::sleep_until(due);
        printer.send("^0?RS\r");
        const MailStatus status = printer.ask();
        if (job.printed(status)) {
            return;
        }
        while (job.room(status) >= block) {
            job.send(printer, status, block);
        }
        if (job.room(status) > 0 && job.room({status.depth, UINT32_MAX}) < block) {
            job.send(printer, status, block); // the rest
        }
    }
}

void print_bare(Printer& printer, Job& job) {
    constexpr milliseconds beat{1};
    auto due = Clock::now();
    for (;;) {
        if (Clock::now() >= due) {
            printer.send("^0?SM\r");
            due = std::max(due + beat, Clock::now());
        }
        if (const auto status = printer.mail_status(due)) {
            if (job.printed(*status)) {
                return;
            }
            job.send(printer, *status, UINT32_MAX);
        }
    }
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 4) {
        std::fputs("usage: bench_control_host single|manual|bare PORT RECORDS\n", stderr);
        return 2;
    }
    const std::string_view mode = argv[1];
    Printer printer{static_cast<std::uint16_t>(std::strtoul(argv[2], nullptr, 10))};
    const std::uint64_t records = std::strtoull(argv[3], nullptr, 10);
    Job job{records};
    printer.send("^0=CM" + std::to_string(records) + "\r");
    job.send(printer, printer.ask(), UINT32_MAX);
    printer.ask();
    printer.send("^0!GO\r");
    if (mode == "single") {
        print_singly(printer, job);
    } else if (mode == "manual") {
        print_as_the_manual(printer, job);
    } else {
        print_bare(printer, job);
    }
}
