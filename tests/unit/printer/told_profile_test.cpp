#include "printer/told_profile.hpp"
#include "support/peer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace linefeed::printer {
namespace {

using testing::HasSubstr;

TEST(ToldProfile, shouldBeThatOfTheTypeAndFirmware) {
    for (const std::string_view name : {"jet3", "jet3up", "jet2neo", "jet2neo-v71"}) {
        simulator::SimulatorSettings settings;
        settings.printer.profile = protocol::profile_by_name(name).value();
        RunningSimulator printer{settings};
        EXPECT_EQ(ask_profile(printer.settings()).value().name, name);
    }
}

TEST(ToldProfile, shouldBeToldOnTheConnectionItself) {
    simulator::SimulatorSettings settings;
    settings.printer.profile = protocol::profile_by_name("jet3").value();
    RunningSimulator printer{settings};
    const auto client = PrinterClient::connect(printer.settings()).value();
    const auto told = told_profile(*client).value();
    EXPECT_EQ(told.name, "jet3");
    client->use(told);
    EXPECT_EQ(client->settings().profile.escapes, protocol::EscapeMode::none);
    ASSERT_TRUE(client->send(protocol::Action::power_off));
    EXPECT_FALSE(told_profile(*client)) << "in standby it is not asked";
}

TEST(ToldProfile, shouldNotBeGuessed) {
    Peer silent{[](std::string_view) { return Peer::Reaction{}; }};
    const auto untold = ask_profile(silent.settings());
    EXPECT_EQ(untold.error().kind, FailureKind::unreachable);
    EXPECT_THAT(untold.error().message, HasSubstr("the printer does not say what it is (?VS): name its profile"));
    Peer other{[](std::string_view) { return Peer::Reaction{"^0=VSf\tr\ts\tfe\tk\ty\tl\tfo\tV1.0\tLJ9\t1\r"}; }};
    const auto unknown = ask_profile(other.settings());
    EXPECT_EQ(unknown.error().kind, FailureKind::unreachable);
    EXPECT_THAT(unknown.error().message, HasSubstr("says that it is a \"LJ9\" with firmware \"V1.0\""));
    EXPECT_FALSE(ask_profile(client_of(1)));
}

} // namespace
} // namespace linefeed::printer
