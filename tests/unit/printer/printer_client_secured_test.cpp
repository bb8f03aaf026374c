// Conversations secured by CRC32: with the simulated printer, over a noisy serial line, and with peers that break the
// rules.
#include "printer/printer_client.hpp"
#include "protocol/crc32.hpp"
#include "support/peer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <unistd.h>
#include <utility>

namespace linefeed::printer {
namespace {

using protocol::Parameter;
using testing::HasSubstr;

const std::string ready = "^0=RS2\t5\t0\t0\t9\t1";

std::string announced(const std::string& frame) {
    return "^0=NR" + std::to_string(protocol::crc32(frame)) + "\r" + frame + "\r";
}

ClientSettings secured(ClientSettings settings) {
    settings.endpoints.crc = true;
    settings.reply_timeout = std::chrono::seconds{1};
    return settings;
}

std::size_t times(const std::string& text, const std::string& what) {
    std::size_t count = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) {
        ++count;
    }
    return count;
}

TEST(SecuredClient, shouldTalkToTheSimulatedPrinter) {
    RunningSimulator printer;
    const auto client = PrinterClient::connect(secured(printer.settings())).value();
    EXPECT_EQ(client->ask<protocol::VersionInfo>(Parameter::VS)->serial_number, "104711");
    EXPECT_TRUE(client->send(protocol::Action::user_resume));
    EXPECT_EQ(client->ask<protocol::MailStatus>(Parameter::SM)->depth, 256U);
    EXPECT_EQ(client->oddities(), ConversationOddities{});
}

TEST(SecuredClient, shouldBelieveNothingThatANoisyLineHasChanged) {
    simulator::SimulatorSettings settings;
    const std::string port = (std::filesystem::temp_directory_path() / ("port" + std::to_string(::getpid()))).string();
    settings.server.serial = simulator::SerialSettings{.link = port, .baud = 921600, .one_damaged_in = 150};
    settings.printer.total_prints = 1234567890;
    RunningSimulator printer{settings};
    ClientSettings noisy = secured(printer.settings());
    noisy.endpoints.tcp.clear();
    noisy.endpoints.serial = link::SerialAddress{.device = port, .baud = 921600};
    const auto client = PrinterClient::connect(noisy).value();
    constexpr int asked = 60;
    int answered = 0;
    for (int i = 0; i < asked; ++i) {
        if (const auto counters = client->ask<protocol::Counters>(Parameter::CC)) {
            EXPECT_EQ(counters->total, 1234567890U);
            ++answered;
        }
    }
    EXPECT_GT(answered, asked * 3 / 4);
    EXPECT_GT(client->oddities().damaged_bytes, 0U);
}

TEST(SecuredClient, shouldRepeatWhatIsRefused) {
    int refusals = 2;
    Peer peer{[&](std::string_view frame) {
        return frame != "^0?RS" ? Peer::Reaction{}
               : refusals-- > 0 ? Peer::Reaction{"^0=FC1\r"}
                                : Peer::Reaction{"^0!OK\r" + announced(ready)};
    }};
    const auto client = PrinterClient::connect(secured(peer.settings())).value();
    EXPECT_TRUE(client->ask<protocol::MachineStatus>(Parameter::RS));
    const std::string once = "^0=NR" + std::to_string(protocol::crc32("^0?RS")) + "\n^0?RS\n";
    EXPECT_EQ(peer.heard(), once + once + once);
}

TEST(SecuredClient, shouldSayThatAPrinterKnowsNoCrc) {
    Peer plain{[](std::string_view frame) {
        const bool inquiry = frame.starts_with("^0?");
        return Peer::Reaction{frame == "^0?RS" ? ready + "\r"
                              : inquiry        ? "^0=" + std::string{frame.substr(3)} + "0\r"
                                               : ""};
    }};
    const auto client = PrinterClient::connect(secured(plain.settings())).value();
    EXPECT_FALSE(client->ask<protocol::MachineStatus>(Parameter::RS));
    EXPECT_EQ(times(plain.heard(), "^0?RS\n"), 1U);
    EXPECT_THAT(client->silence("?RS"), HasSubstr("does not answer ?RS with CRC32"));
    EXPECT_TRUE(client->oddities().unsecured);
}

/// There it knows nothing of CRC32 (protocol, section 1).
TEST(SecuredClient, shouldTalkToAPrinterInStandby) {
    Peer standby{
        [](std::string_view frame) { return Peer::Reaction{frame == "^0?RS" ? "^0=RS0\t1\t0\t0\t0\t0\r" : ""}; }};
    const auto client = PrinterClient::connect(secured(standby.settings())).value();
    EXPECT_EQ(client->ask<protocol::MachineStatus>(Parameter::RS)->machine, protocol::MachineState::standby);
    EXPECT_FALSE(client->oddities().unsecured);
    EXPECT_TRUE(client->send(protocol::Action::power_on));
    EXPECT_TRUE(client->send(protocol::Action::restart));
    EXPECT_EQ(client->ask<protocol::MachineStatus>(Parameter::RS)->machine, protocol::MachineState::standby);
    EXPECT_THAT(standby.heard(), HasSubstr("\n^0?RS\n^0!PO\n^0!RM\n^0=NR"));
}

TEST(SecuredClient, shouldSendOnlyOnceWhatMustNotHappenTwice) {
    bool step_is_lost = true;
    Peer peer{[&](std::string_view frame) {
        const bool lost = frame == "^0!MO" || (frame == "^0!ST" && std::exchange(step_is_lost, false));
        const std::string answer =
            frame.starts_with("^0?") ? announced("^0=" + std::string{frame.substr(3)} + "0") : "";
        return Peer::Reaction{lost || frame.starts_with("^0=NR") ? "" : "^0!OK\r" + answer};
    }};
    const auto client = PrinterClient::connect(secured(peer.settings())).value();
    EXPECT_FALSE(client->send(protocol::Action::motor_open));
    EXPECT_EQ(times(peer.heard(), "^0!MO\n"), 1U);
    EXPECT_TRUE(client->send(protocol::Action::stop_print));
    EXPECT_EQ(times(peer.heard(), "^0!ST\n"), 2U);
}

/// The printer is silent for so long that the first is given up; the word on it comes when the second is under way, of
/// which only half has arrived.
TEST(SecuredClient, shouldNotTakeALateWordForThatOnTheNextFrame) {
    bool silent = true;
    bool flush_is_damaged = true;
    Peer peer{[&](std::string_view frame) {
        if (silent && frame == "^0!FF") {
            silent = false;
            return Peer::Reaction{"^0!OK\r"}; // on the one before
        }
        if (silent || frame.starts_with("^0=NR")) {
            return Peer::Reaction{};
        }
        const bool refused = frame == "^0!FF" && std::exchange(flush_is_damaged, false);
        const std::string answer =
            frame.starts_with("^0?") ? announced("^0=" + std::string{frame.substr(3)} + "0") : "";
        return Peer::Reaction{(refused ? "^0=FC1\r" : "^0!OK\r") + answer};
    }};
    const auto client = PrinterClient::connect(secured(peer.settings())).value();
    EXPECT_FALSE(client->send(protocol::Action::acknowledge_errors)) << "nobody knows";
    EXPECT_TRUE(client->send(protocol::Action::flush_fifo));
    EXPECT_EQ(times(peer.heard(), "^0!EQ\n"), 1U);
    EXPECT_EQ(times(peer.heard(), "^0!FF\n"), 3U) << "not taken, refused, taken";
}

TEST(SecuredClient, shouldNotWaitForEverForADeviceThatOnlyTalks) {
    Peer peer{[](std::string_view) { return Peer::Reaction{std::string(100, 'x')}; }};
    const auto client = PrinterClient::connect(secured(peer.settings())).value();
    const auto begun = std::chrono::steady_clock::now();
    EXPECT_FALSE(client->ask<protocol::MachineStatus>(Parameter::RS));
    EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds{15});
    EXPECT_THAT(client->silence("?RS"), HasSubstr("bytes came that are no frame"));
}

TEST(SecuredClient, shouldLeaveFileTransferToItsOwnChecks) {
    Peer peer{[](std::string_view frame) { return Peer::Reaction{frame.starts_with("^0$RD") ? "^0$DI1\t00\r" : ""}; }};
    const auto client = PrinterClient::connect(secured(peer.settings())).value();
    bool heard = false;
    EXPECT_TRUE(client->converse(client->frame_of(protocol::DirectoryRequest{"FFSDISK"}),
                                 [&](const protocol::Message& message, std::string_view) {
                                     heard = std::holds_alternative<protocol::DirectoryBlock>(message);
                                     return heard ? PrinterClient::Heard::done : PrinterClient::Heard::ignored;
                                 }));
    EXPECT_TRUE(heard);
    EXPECT_EQ(times(peer.heard(), "=NR"), 0U);
    EXPECT_FALSE(client->ask<protocol::MachineStatus>(Parameter::RS));
    EXPECT_THAT(peer.heard(), HasSubstr("=NR")) << "the next frame is secured again";
}

} // namespace
} // namespace linefeed::printer
