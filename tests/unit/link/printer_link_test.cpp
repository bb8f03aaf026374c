// The link between a session and a socket. The printer at the other end is a few lines of script in the same thread, so
// that what has been written can be looked at in the middle of a batch of effects.
#include "link/printer_link.hpp"
#include "protocol/messages.hpp"

#include <boost/asio/ip/address.hpp>
#include <gtest/gtest.h>

#include <string>
#include <sys/ioctl.h>
#include <sys/socket.h>

namespace linefeed::link {
namespace {

using boost::asio::ip::tcp;

constexpr std::uint32_t depth = 64;
constexpr std::uint32_t records = 200;
constexpr std::uint32_t block = 8; ///< few enough to be plausible at once

class PrinterLinkTest : public testing::Test, public EffectHandler {
protected:
    PrinterLinkTest() {
        page_.first = RecordNumber{1};
        for (std::uint32_t number = 1; number <= records; ++number) {
            page_.frames += "^0=MR" + std::to_string(number) + "\tx\r";
            page_.ends.push_back(static_cast<std::uint32_t>(page_.frames.size()));
        }
    }

    void on_effect(const session::Effect& effect) override {
        if (std::holds_alternative<feeder::BeginRun>(effect)) {
            grant_ = true;
        } else if (std::holds_alternative<feeder::ConfirmPrinted>(effect)) {
            int waiting = 0;
            ASSERT_EQ(::ioctl(printer_.native_handle(), FIONREAD, &waiting), 0);
            bytes_at_confirmation_ = waiting;
        } else if (const auto* last = std::get_if<feeder::End>(&effect)) {
            ended_ = last->outcome.code;
        }
    }
    void on_unreachable(const std::string& reason) override { unreachable_ = reason; }
    void on_progress(Instant) override {}

    void connect() {
        link_.connect({.tcp = {acceptor_.local_endpoint()}}, std::chrono::seconds{5});
        acceptor_.accept(printer_);
        printer_.non_blocking(true);
    }

    /// Lets the link do what it can, and the ledger answer.
    void step() {
        context_.run_one_for(std::chrono::milliseconds{1});
        if (grant_) {
            grant_ = false;
            link_.call([this](session::Session& session, Instant at, session::Effects& effects) {
                session.on_granted(page_.range(), page_.range().last(), at, effects);
                session.on_page(&page_, at, effects);
            });
        }
    }
    /// The printer reads and answers; `?SM` while it prints waits for report().
    void answer() {
        std::string answers;
        for (std::string_view left = read(); !left.empty();) {
            const std::string_view frame = left.substr(0, left.find('\r'));
            left.remove_prefix(frame.size() + 1);
            if (frame == "^0?SM" && printing_) {
                ++mail_asked_;
            } else if (frame == "^0?SM") {
                protocol::append_message(answers, mail());
            } else if (frame == "^0?RS") {
                protocol::MachineStatus status;
                status.nozzle = protocol::NozzleState::open;
                status.machine = printing_ ? protocol::MachineState::printing : protocol::MachineState::ready_to_print;
                protocol::append_message(answers, status);
            } else if (frame == "^0?VS") {
                protocol::append_message(answers, protocol::VersionInfo{}, protocol::EscapeMode::backslash);
            } else if (frame == "^0?JL") {
                protocol::append_message(answers, protocol::JobName{"a.job"}, protocol::EscapeMode::backslash);
            } else if (frame == "^0?CC") {
                protocol::append_message(answers, protocol::Counters{0, 0, printed_});
            } else if (frame.starts_with("^0=CM")) {
                stop_at_ = RecordNumber{records};
            } else if (frame.starts_with("^0=MR")) {
                ++received_;
            } else if (frame == "^0!GO") {
                printing_ = true;
            }
        }
        printer_.write_some(boost::asio::buffer(answers));
    }
    void report(std::uint32_t more_printed) {
        printed_ += more_printed;
        std::string text;
        protocol::append_message(text, mail());
        printer_.write_some(boost::asio::buffer(text));
    }
    /// The next record to be printed does not count: it lies in the print buffer.
    [[nodiscard]] protocol::MailStatus mail() const {
        const std::uint32_t level = received_ - printed_;
        return {depth, std::max(level, 1U) - 1, RecordNumber{printed_}, stop_at_, true, {}};
    }
    std::string_view read() {
        boost::system::error_code nothing_yet;
        const std::size_t size = printer_.read_some(boost::asio::buffer(buffer_), nothing_yet);
        return {buffer_.data(), size};
    }

    boost::asio::io_context context_;
    tcp::acceptor acceptor_{context_, tcp::endpoint{boost::asio::ip::address_v4::loopback(), 0}};
    tcp::socket printer_{context_};
    session::Session session_{{}, {}};
    PrinterLink link_{context_, session_, *this};

    RecordPage page_;
    bool grant_ = false;
    std::string unreachable_;
    std::optional<feeder::OutcomeCode> ended_;
    std::optional<int> bytes_at_confirmation_;

    std::array<char, 65536> buffer_{};
    bool printing_ = false;
    int mail_asked_ = 0;
    std::uint32_t received_ = 0;
    std::uint32_t printed_ = 0;
    RecordNumber stop_at_;
};

TEST_F(PrinterLinkTest, shouldRefillThePrinterBeforeAnybodyElseIsTold) {
    connect();
    while (!printing_ || mail_asked_ == 0 || received_ < depth) {
        ASSERT_FALSE(ended_);
        step();
        answer();
    }
    report(block);
    while (!bytes_at_confirmation_) {
        ASSERT_FALSE(ended_);
        step();
    }
    const auto refill = page_.slice(RecordRange::closed(RecordNumber{depth + 1}, RecordNumber{depth + block}));
    EXPECT_GE(*bytes_at_confirmation_, static_cast<int>(refill.size()));
    answer();
    EXPECT_EQ(received_, depth + block);
}

/// None of them waits for the next answer or for a timer, however they come.
TEST_F(PrinterLinkTest, shouldRefillForAllAnswersThatComeTogether) {
    connect();
    while (!printing_ || mail_asked_ < 2 || received_ < depth) {
        ASSERT_FALSE(ended_);
        step();
        answer();
    }
    std::string text;
    for (int answers = 0; answers < 2; ++answers) {
        printed_ += block;
        protocol::append_message(text, mail());
    }
    printer_.write_some(boost::asio::buffer(text));
    for (int steps = 0; steps < 100 && received_ < depth + 2 * block; ++steps) {
        step();
        answer();
    }
    EXPECT_EQ(received_, depth + 2 * block);
    EXPECT_FALSE(ended_);
}

TEST_F(PrinterLinkTest, shouldEndTheRunWhenThePrinterCloses) {
    connect();
    while (read().empty()) {
        step();
    }
    printer_.close();
    while (!ended_) {
        step();
    }
    EXPECT_EQ(ended_, feeder::OutcomeCode::link_lost);
    EXPECT_EQ(unreachable_, "");
}

TEST_F(PrinterLinkTest, shouldSayWhyThereIsNoConnection) {
    const auto nobody = acceptor_.local_endpoint();
    acceptor_.close();
    link_.connect({.tcp = {nobody}}, std::chrono::seconds{5});
    while (unreachable_.empty()) {
        step();
    }
    EXPECT_EQ(unreachable_, "Connection refused");
}

TEST_F(PrinterLinkTest, shouldTryTheNextEndpoint) {
    tcp::acceptor closed{context_, tcp::endpoint{boost::asio::ip::address_v4::loopback(), 0}};
    const auto nobody = closed.local_endpoint();
    closed.close();
    link_.connect({.tcp = {nobody, acceptor_.local_endpoint()}}, std::chrono::seconds{5});
    for (int i = 0; i < 100; ++i) {
        step();
    }
    acceptor_.non_blocking(true);
    acceptor_.accept(printer_);
    EXPECT_EQ(read(), "^0?RS\r");
    EXPECT_EQ(unreachable_, "");
}

} // namespace
} // namespace linefeed::link
