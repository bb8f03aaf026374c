// Short conversations: with the simulated printer, and with peers that are silent, slow, mad, or gone.
#include "printer/printer_client.hpp"
#include "support/peer.hpp"

#include <gtest/gtest.h>

#include <chrono>

namespace linefeed::printer {
namespace {

using protocol::Parameter;
using std::chrono::milliseconds;

const std::string ready = "^0=RS2\t5\t0\t0\t9\t1\r";

TEST(PrinterClient, shouldAskTheSimulatedPrinter) {
    RunningSimulator printer;
    const auto client = PrinterClient::connect(printer.settings()).value();
    const auto machine = client->ask<protocol::MachineStatus>(Parameter::RS);
    ASSERT_TRUE(machine);
    EXPECT_EQ(machine->machine, protocol::MachineState::ready_to_print);
    EXPECT_EQ(client->ask<protocol::VersionInfo>(Parameter::VS)->serial_number, "104711");
    EXPECT_EQ(client->ask<protocol::JobName>(Parameter::JL)->path, "\\FFSDISK\\JOBS\\Testprint.job");
    EXPECT_EQ(client->ask<protocol::MailStatus>(Parameter::SM)->depth, 256U);
    EXPECT_EQ(client->ask<protocol::Counters>(Parameter::CC)->total, 0U);
    EXPECT_EQ(client->oddities(), ConversationOddities{});
    EXPECT_TRUE(client->open());
}

TEST(PrinterClient, shouldCopeWithWhatOthersHaveLeftOn) {
    simulator::SimulatorSettings settings;
    settings.printer.length_on = true;
    settings.printer.echo_on = true;
    settings.printer.block_length = 64;
    settings.printer.habits.line_end = simulator::LineEnd::cr_lf;
    RunningSimulator printer{settings};
    const auto client = PrinterClient::connect(printer.settings()).value();
    EXPECT_TRUE(client->send(protocol::Action::user_resume)); // comes back
    EXPECT_TRUE(client->ask<protocol::MachineStatus>(Parameter::RS));
    EXPECT_TRUE(client->ask<protocol::MailStatus>(Parameter::SM));
    EXPECT_EQ(client->oddities(), (ConversationOddities{true, true, true, 0}));
}

TEST(PrinterClient, shouldWaitNoLongerThanItMay) {
    Peer silent{[](std::string_view) { return Peer::Reaction{}; }};
    const auto client = PrinterClient::connect(silent.settings()).value();
    const auto begun = std::chrono::steady_clock::now();
    EXPECT_FALSE(client->ask<protocol::MachineStatus>(Parameter::RS));
    EXPECT_GE(std::chrono::steady_clock::now() - begun, milliseconds{200});
    EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds{10});
    EXPECT_TRUE(client->open());
    EXPECT_EQ(silent.heard(), "^0?RS\n");
}

TEST(PrinterClient, shouldTakeTheAnswerOutOfWhateverComesBesides) {
    Peer talkative{[](std::string_view) {
        return Peer::Reaction{"noise^0!GO\r^0=XX1\r^0=SM256\t0\t0\t0\t1\r^0=RSx\r" + ready + "^0=CC1\t2\t3\r"};
    }};
    const auto client = PrinterClient::connect(talkative.settings()).value();
    EXPECT_TRUE(client->ask<protocol::MachineStatus>(Parameter::RS));
    EXPECT_TRUE(client->oddities().echoes);
    EXPECT_GE(client->oddities().damaged_bytes, 5U + 3U);
}

TEST(PrinterClient, shouldNotTakeGarbageForAnAnswer) {
    Peer mad{[](std::string_view) { return Peer::Reaction{std::string(3000, 'x') + "HTTP/1.1 400\r\n"}; }};
    const auto client = PrinterClient::connect(mad.settings()).value();
    EXPECT_FALSE(client->ask<protocol::MachineStatus>(Parameter::RS));
    EXPECT_GE(client->oddities().damaged_bytes, 3000U);
}

TEST(PrinterClient, shouldWaitForAnAnswerThatComesInPieces) {
    int asked = 0;
    Peer slow{
        [&asked](std::string_view) { return Peer::Reaction{++asked == 1 ? ready.substr(0, 7) : ready.substr(7)}; }};
    const auto client = PrinterClient::connect(slow.settings()).value();
    EXPECT_FALSE(client->ask<protocol::MachineStatus>(Parameter::RS));
    EXPECT_TRUE(client->ask<protocol::MachineStatus>(Parameter::RS)) << "the rest comes with the second inquiry";
}

TEST(PrinterClient, shouldNoticeThatTheOtherSideHasClosed) {
    Peer closing{[](std::string_view) { return Peer::Reaction{"^0=RS2\t5", true}; }};
    const auto client = PrinterClient::connect(closing.settings()).value();
    const auto begun = std::chrono::steady_clock::now();
    EXPECT_FALSE(client->ask<protocol::MachineStatus>(Parameter::RS));
    EXPECT_FALSE(client->open());
    EXPECT_FALSE(client->ask<protocol::MailStatus>(Parameter::SM));
    EXPECT_FALSE(client->send(protocol::Action::user_resume));
    EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds{10});
}

TEST(PrinterClient, shouldSayWhyThereIsNoConnection) {
    std::uint16_t nobody = 0;
    {
        boost::asio::io_context context;
        boost::asio::ip::tcp::acceptor acceptor{context, {boost::asio::ip::address_v4::loopback(), 0}};
        nobody = acceptor.local_endpoint().port();
    }
    ClientSettings settings = client_of(nobody);
    const auto refused = PrinterClient::connect(settings);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, FailureKind::unreachable);
    EXPECT_EQ(refused.error().message, settings.address + ": Connection refused");

    settings.endpoints.tcp.clear();
    EXPECT_EQ(PrinterClient::connect(settings).error().message, settings.address + ": it has no address");
}

TEST(PrinterClient, shouldGiveUpAConnectionThatIsNotTaken) {
    boost::asio::io_context context;
    boost::asio::ip::tcp::acceptor full{context};
    full.open(boost::asio::ip::tcp::v4());
    full.bind({boost::asio::ip::address_v4::loopback(), 0});
    full.listen(0);
    std::list<boost::asio::ip::tcp::socket> waiting; // its queue is full: what comes now is not answered
    for (int i = 0; i < 4; ++i) {
        waiting.emplace_back(context);
        waiting.back().async_connect(full.local_endpoint(), [](const boost::system::error_code&) {});
    }
    context.run_for(milliseconds{100});
    ClientSettings settings = client_of(full.local_endpoint().port());
    settings.connect_timeout = milliseconds{150};
    const auto result = PrinterClient::connect(settings);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().message, settings.address + ": no connection within 150 ms");
}

TEST(PrinterClient, shouldTryTheNextEndpoint) {
    Peer peer{[](std::string_view) { return Peer::Reaction{ready}; }};
    ClientSettings settings = peer.settings();
    settings.endpoints.tcp.insert(settings.endpoints.tcp.begin(), {boost::asio::ip::address_v4::loopback(), 1});
    const auto client = PrinterClient::connect(settings).value();
    EXPECT_TRUE(client->ask<protocol::MachineStatus>(Parameter::RS));
}

} // namespace
} // namespace linefeed::printer
