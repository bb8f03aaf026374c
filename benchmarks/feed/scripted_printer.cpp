#include "scripted_printer.hpp"

#include "base/assert.hpp"
#include "call_log.hpp"
#include "protocol/messages.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <charconv>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

namespace linefeed::benchmarks {

using protocol::Parameter;

namespace {

std::uint32_t number_in(std::string_view text) {
    std::uint32_t number = 0;
    std::from_chars(text.data(), text.data() + text.size(), number);
    return number;
}

} // namespace

ScriptedPrinter::ScriptedPrinter(std::uint32_t depth, std::uint32_t records)
    : depth_(depth)
    , bytes_behind_(std::size_t{records} + 1)
    , listener_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const generic = reinterpret_cast<sockaddr*>(&address);
    LINEFEED_ASSERT(::bind(listener_, generic, size) == 0 && ::listen(listener_, 1) == 0);
    LINEFEED_ASSERT(::getsockname(listener_, generic, &size) == 0);
    port_ = ntohs(address.sin_port);
}

ScriptedPrinter::~ScriptedPrinter() {
    close();
    ::close(listener_);
}

void ScriptedPrinter::accept() {
    socket_ = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    const int on = 1;
    LINEFEED_ASSERT(socket_ >= 0 && ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on) == 0);
}

void ScriptedPrinter::close() {
    if (socket_ >= 0) {
        ::close(socket_);
        socket_ = -1;
    }
}

void ScriptedPrinter::take() {
    while (true) {
        const ssize_t size = ::recv(socket_, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
        if (size <= 0) {
            break;
        }
        std::string_view bytes{buffer_.data(), static_cast<std::size_t>(size)};
        bytes_ += bytes.size();
        while (true) {
            const auto result = decoder_.next(bytes);
            if (std::holds_alternative<std::monostate>(result)) {
                break;
            }
            LINEFEED_ASSERT(std::holds_alternative<protocol::Frame>(result));
            take_frame(std::get<protocol::Frame>(result), bytes_ - bytes.size());
        }
    }
    if (!printing_) {
        answer_all();
    }
    send_answers();
}

void ScriptedPrinter::answer_all() {
    for (const Parameter inquiry : inquiries_) {
        answer(inquiry);
    }
    inquiries_.clear();
}

void ScriptedPrinter::take_frame(const protocol::Frame& frame, std::uint64_t bytes_through) {
    const std::string_view code = frame.payload.substr(0, 2);
    if (frame.group == protocol::Group::inquiry) {
        inquiries_.push_back(protocol::parameter_from_code(code).value());
    } else if (code == "MR") {
        received_ = number_in(frame.payload.substr(2));
        bytes_behind_[received_] = bytes_through;
    } else if (code == "CM") {
        stop_at_ = number_in(frame.payload.substr(2));
    } else if (code == "GO") {
        printing_ = true;
    }
}

void ScriptedPrinter::answer(Parameter inquiry) {
    if (inquiry == Parameter::SM) {
        append_mail_status();
    } else if (inquiry == Parameter::RS) {
        protocol::MachineStatus status;
        status.nozzle = protocol::NozzleState::open;
        status.machine = printing_ ? protocol::MachineState::printing : protocol::MachineState::ready_to_print;
        protocol::append_message(answers_, status);
    } else if (inquiry == Parameter::CC) {
        protocol::append_message(answers_, protocol::Counters{0, 0, printed_});
    } else if (inquiry == Parameter::VS) {
        protocol::VersionInfo version;
        version.serial_number = "104711";
        protocol::append_message(answers_, version, protocol::EscapeMode::backslash);
    } else if (inquiry == Parameter::JL) {
        protocol::append_message(answers_, protocol::JobName{"Testprint.job"}, protocol::EscapeMode::backslash);
    }
}

void ScriptedPrinter::append_mail_status() {
    const std::uint32_t level = received_ - printed_;
    const std::uint32_t entries = std::max(level, 1U) - 1; // without the one in the print buffer
    protocol::append_message(answers_,
                             protocol::MailStatus{depth_, entries, RecordNumber{printed_}, RecordNumber{stop_at_}});
}

bool ScriptedPrinter::ready() const {
    return printing_ && std::ranges::find(inquiries_, Parameter::SM) != inquiries_.end();
}

Instant ScriptedPrinter::report(std::uint32_t records) {
    LINEFEED_ASSERT(ready());
    printed_ += records;
    answer_all();
    const Instant sent = steady_now();
    send_answers();
    return sent;
}

void ScriptedPrinter::send_answers() {
    if (!answers_.empty()) {
        const ssize_t sent = ::send(socket_, answers_.data(), answers_.size(), MSG_NOSIGNAL);
        LINEFEED_ASSERT(sent == static_cast<ssize_t>(answers_.size()));
        answers_.clear();
    }
}

} // namespace linefeed::benchmarks
