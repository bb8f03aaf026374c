// Conversations secured by CRC32: with the simulated printer, over a noisy serial line, and with peers that break the
// rules.
#include "printer/printer_client.hpp"
#include "protocol/crc32.hpp"
#include "support/peer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <unistd.h>

namespace linefeed::printer {
namespace {

using protocol::Parameter;

const std::string ready = "^0=RS2\t5\t0\t0\t9\t1";

std::string announced(const std::string& frame) {
    return "^0=NR" + std::to_string(protocol::crc32(frame)) + "\r" + frame + "\r";
}

ClientSettings secured(ClientSettings settings) {
    settings.endpoints.crc = true;
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

TEST(SecuredClient, shouldDropAnswersThatWereNotAnnounced) {
    Peer plain{[](std::string_view frame) { return Peer::Reaction{frame == "^0?RS" ? ready + "\r" : ""}; }};
    const auto client = PrinterClient::connect(secured(plain.settings())).value();
    EXPECT_FALSE(client->ask<protocol::MachineStatus>(Parameter::RS));
    EXPECT_EQ(times(plain.heard(), "^0?RS\n"), 5U);
}

TEST(SecuredClient, shouldSendOnlyOnceWhatMustNotHappenTwice) {
    Peer silent{[](std::string_view) { return Peer::Reaction{}; }};
    const auto client = PrinterClient::connect(secured(silent.settings())).value();
    EXPECT_FALSE(client->send(protocol::Action::acknowledge_errors));
    EXPECT_EQ(times(silent.heard(), "^0!EQ\n"), 1U);
    EXPECT_FALSE(client->send(protocol::Action::stop_print));
    EXPECT_EQ(times(silent.heard(), "^0!ST\n"), 5U);
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
    EXPECT_FALSE(client->ask<protocol::MachineStatus>(Parameter::RS)) << "and the next frame is secured again";
    EXPECT_EQ(times(peer.heard(), "=NR"), 5U);
}

} // namespace
} // namespace linefeed::printer
