// Printers with which nothing is done: what is seen of them, and which machine stands behind a name.
#include "service_fixture.hpp"
#include "support/peer.hpp"

namespace linefeed::service {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class WatchTest : public ServiceTest {
protected:
    [[nodiscard]] std::string settings(const SimulatedPrinter& printer) const {
        return settings_text({printer.address()}, ", watch_interval: 1 s");
    }
    [[nodiscard]] bool comes_to_show(const std::function<bool(const daemon::PrinterView&)>& wanted) {
        return wait_until([&] { return wanted(service_->printer("line1").value()); });
    }
    /// What the doctor says of line1; empty = it is well.
    [[nodiscard]] std::string finding() const {
        for (const daemon::Finding& finding : service_->status().checks) {
            if (finding.check == "printer line1" && finding.severity != daemon::Severity::ok) {
                EXPECT_FALSE(finding.advice.empty());
                return finding.words;
            }
        }
        return {};
    }
    static simulator::SimulatorSettings machine(const std::string& serial_number) {
        simulator::SimulatorSettings settings;
        settings.printer.serial_number = serial_number;
        return settings;
    }
};

TEST_F(WatchTest, shouldShowAnIdlePrinterAsItIsAndTellWhatComesAndGoes) {
    simulator::SimulatorSettings dirty = machine("104711");
    dirty.faults = {simulator::parse_fault("time 0.3 cover open").value()};
    std::optional<SimulatedPrinter> printer{std::in_place, directory_ / "tape.csv", 100, "0", dirty};
    const std::string port = printer->port();
    open(settings(*printer));
    ASSERT_TRUE(comes_to_show([](const auto& view) { return view.watched && view.cover_open == true; }));
    EXPECT_EQ(finding(), "the head cover is open");
    EXPECT_EQ(service_->printer("line1")->link, daemon::LinkState::up);
    EXPECT_EQ(service_->printer("line1")->serial_number, "104711");
    EXPECT_EQ(service_->printer("line1")->known_serial_number, "104711");
    EXPECT_TRUE(service_->printer("line1")->total_prints.has_value());
    EXPECT_TRUE(wait_until([&] { return testing::Matches(Contains("printer.warning"))(event_kinds()); }));

    printer.reset();
    ASSERT_TRUE(comes_to_show([](const auto& view) { return view.link == daemon::LinkState::down; }));
    EXPECT_THAT(finding(), HasSubstr("does not answer"));
    EXPECT_TRUE(wait_until([&] { return testing::Matches(Contains("printer.down"))(event_kinds()); }));
    EXPECT_THAT(event_kinds(), Not(Contains("printer.up")));
    printer.emplace(directory_ / "tape2.csv", 100, port, machine("104711"));
    ASSERT_TRUE(comes_to_show([](const auto& view) { return view.link == daemon::LinkState::up; }));
    EXPECT_EQ(finding(), "");
    EXPECT_TRUE(wait_until([&] { return testing::Matches(Contains("printer.up"))(event_kinds()); }));
}

TEST_F(WatchTest, shouldLeaveAPrinterAloneThatIsNotToBeWatched) {
    SimulatedPrinter printer{directory_ / "tape.csv", 100};
    open(settings_text({printer.address()}, ", watch_interval: 0 s"));
    std::this_thread::sleep_for(std::chrono::milliseconds{200});
    EXPECT_FALSE(service_->printer("line1")->watched);
    EXPECT_EQ(service_->printer("line1")->heard_ns, 0);
    text_ = settings(printer);
    ASSERT_TRUE(service_->reload(anna)) << "it takes effect at once";
    EXPECT_TRUE(comes_to_show([](const auto& view) { return view.watched; }));
}

/// A printer that serves one connection at a time would seem to be gone.
TEST_F(WatchTest, shouldLeaveAPrinterAloneWhileSomebodyTalksToIt) {
    printer::Peer printer{[](std::string_view frame) {
        return printer::Peer::Reaction{frame == "^0?RS" ? "^0=RS2\t5\t0\t0\t9\t0\r" : ""};
    }};
    open(settings_text({printer.settings().address.substr(6)}, ", watch_interval: 1 s, reply_timeout: 100 ms"));
    ASSERT_TRUE(comes_to_show([](const auto& view) { return view.link == daemon::LinkState::up; }));
    std::thread reader{[this] { EXPECT_FALSE(service_->read_file("line1", "FFSDISK\\Jobs\\a.job")); }};
    ASSERT_TRUE(wait_until([&] { return printer.heard().find("^0$RF") != std::string::npos; }));
    const int connections = printer.connections();
    std::this_thread::sleep_for(std::chrono::milliseconds{2300});
    EXPECT_EQ(printer.connections(), connections);
    printer.cut();
    reader.join();
    EXPECT_TRUE(wait_until([&] { return printer.connections() > connections; })) << "then it is looked at again";
}

TEST_F(WatchTest, shouldLeaveAPrinterAloneWhosePanelIsHeld) {
    printer::Peer printer{[](std::string_view frame) {
        return printer::Peer::Reaction{frame == "^0?RS" ? "^0=RS2\t5\t0\t0\t9\t0\r" : ""};
    }};
    open(settings_text({printer.settings().address.substr(6)}, ", watch_interval: 1 s, reply_timeout: 100 ms"));
    ASSERT_TRUE(comes_to_show([](const auto& view) { return view.link == daemon::LinkState::up; }));
    ASSERT_TRUE(service_->suspend_panel(anna, "line1", true, std::chrono::seconds{60}));
    const int connections = printer.connections();
    std::this_thread::sleep_for(std::chrono::milliseconds{2300});
    EXPECT_EQ(printer.connections(), connections);
    ASSERT_TRUE(service_->suspend_panel(anna, "line1", false, {}));
    EXPECT_TRUE(wait_until([&] { return printer.connections() > connections; })) << "then it is looked at again";
}

/// Whoever refuses may be busy with another program.
TEST_F(WatchTest, shouldLookLessOftenAtAPrinterThatRefuses) {
    printer::Peer busy{[](std::string_view) { return printer::Peer::Reaction{{}, true}; }};
    open(settings_text({busy.settings().address.substr(6)}, ", watch_interval: 1 s"));
    std::this_thread::sleep_for(std::chrono::milliseconds{4500}); // looked at after 0, 2 and 6 s
    EXPECT_EQ(service_->printer("line1")->link, daemon::LinkState::down);
    EXPECT_LE(busy.connections(), 3);
}

TEST_F(WatchTest, shouldRaiseNoAlarmAboutAPrinterInStandby) {
    printer::Peer asleep{[](std::string_view) { return printer::Peer::Reaction{}; }};
    open(settings_text({asleep.settings().address.substr(6)}, ", watch_interval: 1 s, reply_timeout: 100 ms"));
    ASSERT_TRUE(wait_until([&] { return asleep.connections() >= 4; }));
    EXPECT_EQ(service_->printer("line1")->link, daemon::LinkState::up);
    EXPECT_THAT(event_kinds(), Not(Contains("printer.down")));
    EXPECT_THAT(event_kinds(), Contains("printer.notice"));
}

TEST_F(WatchTest, shouldTellThatTwoNamesAreOneMachine) {
    SimulatedPrinter one{directory_ / "tape1.csv", 100, "0", machine("104711")};
    SimulatedPrinter other{directory_ / "tape2.csv", 100, "0", machine("104711")};
    open(settings_text({one.address(), other.address()}, ", watch_interval: 1 s"));
    ASSERT_TRUE(comes_to_show([](const auto& view) { return view.watched; }));
    ASSERT_TRUE(wait_until([&] { return service_->printer("line2")->watched; }));
    EXPECT_TRUE(wait_until([&] {
        const auto events = service_->events(0, 1000).value();
        return std::ranges::any_of(events, [](const daemon::EventView& event) {
            return event.message.find("it is the same machine as printer line") != std::string::npos;
        });
    }));
    const auto findings = service_->preflight("line2").value();
    EXPECT_TRUE(std::ranges::any_of(findings, [](const daemon::Finding& finding) {
        return finding.check == "identity" && finding.severity == daemon::Severity::warning;
    }));
}

/// The error shows at a preflight that somebody asks for; nobody else has heard of it then.
TEST_F(WatchTest, shouldTellAnErrorThatAPreflightHasHeardFirst) {
    simulator::SimulatorSettings dirty = machine("104711");
    dirty.faults = {simulator::parse_fault("time 0.1 cover open").value()};
    SimulatedPrinter printer{directory_ / "tape.csv", 100, "0", dirty};
    open(settings_text({printer.address()}, ", watch_interval: 0 s"));
    ASSERT_TRUE(wait_until([&] {
        static_cast<void>(service_->preflight("line1"));
        return service_->printer("line1")->cover_open == true;
    }));
    text_ = settings(printer);
    ASSERT_TRUE(service_->reload(anna));
    EXPECT_TRUE(wait_until([&] { return testing::Matches(Contains("printer.warning"))(event_kinds()); }));
}

TEST_F(WatchTest, shouldNotAcceptAMachineWhileAJobIsOnTheLine) {
    SimulatedPrinter printer{directory_ / "tape.csv", 300, "0", machine("104711")};
    open(settings(printer));
    const spool::JobId job = import(2000);
    ASSERT_TRUE(service_->start(anna, job));
    ASSERT_TRUE(prints_through(job, 10));
    const auto accepted = service_->accept_printer(anna, "line1", "104711");
    ASSERT_FALSE(accepted);
    EXPECT_EQ(accepted.error().kind, FailureKind::stopped);
    EXPECT_THAT(accepted.error().message, HasSubstr("is on printer line1: stop it first"));
    EXPECT_EQ(view(job).phase, JobPhase::printing);
}

/// It knows nothing of their records, and would leave all of them in doubt.
TEST_F(WatchTest, shouldNotAskAnotherMachineHowFarOtherJobsCame) {
    std::optional<SimulatedPrinter> printer{std::in_place, directory_ / "tape.csv", 1000, "0", machine("104711")};
    const std::string port = printer->port();
    const std::string never_watched = settings_text({printer->address()}, ", watch_interval: 0 s");
    open(never_watched);
    const spool::JobId first = import(10);
    ASSERT_TRUE(service_->start(anna, first));
    ASSERT_TRUE(comes_to(first, JobPhase::finished));
    const spool::JobId second = import(10, 11);
    service_.reset();
    { // as if the service had been killed while it printed the last record once more
        auto spool = spool::Spool::open(directory_ / "spool.db", {}).value();
        const RecordRange last = RecordRange::closed(RecordNumber{10}, RecordNumber{10});
        const auto before = spool.last_run(first).value();
        const spool::LedgerEntry again{spool::LedgerKind::reprint, before->started.entry.run, last, "{}"};
        ASSERT_TRUE(spool.append(first, {&again, 1}));
        const auto run = spool.begin_run(first, last, before->started.entry.evidence).value();
        const spool::LedgerEntry intent{spool::LedgerKind::intent, run, last, {}};
        ASSERT_TRUE(spool.append(first, {&intent, 1}));
    }
    printer.reset();
    printer.emplace(directory_ / "tape2.csv", 1000, port, machine("99"));
    open(never_watched);
    ASSERT_EQ(view(first).open, RecordCount{1});
    ASSERT_TRUE(service_->start(anna, second));
    ASSERT_TRUE(comes_to(second, JobPhase::stopped));
    EXPECT_THAT(view(second).message, HasSubstr("the serial number here was 104711"));
    EXPECT_EQ(view(first).open, RecordCount{1}) << "only the right machine knows";
    service_.reset();
    EXPECT_TRUE(printer->products().empty());
}

TEST_F(WatchTest, shouldNotStartOnAnotherMachineBeforeAnOperatorHasAcceptedIt) {
    std::optional<SimulatedPrinter> printer{std::in_place, directory_ / "tape.csv", 1000, "0", machine("104711")};
    const std::string port = printer->port();
    const std::string never_watched = settings_text({printer->address()}, ", watch_interval: 0 s");
    open(never_watched);
    const spool::JobId first = import(50);
    ASSERT_TRUE(service_->start(anna, first));
    ASSERT_TRUE(comes_to(first, JobPhase::finished));
    const spool::JobId second = import(50, 1001);
    service_.reset();
    EXPECT_EQ(printer->products(), serials(1, 50));

    printer.emplace(directory_ / "tape2.csv", 1000, port, machine("99"));
    open(never_watched); // which machine it was is kept over the restart
    ASSERT_TRUE(service_->start(anna, second));
    ASSERT_TRUE(comes_to(second, JobPhase::stopped));
    EXPECT_THAT(view(second).message, HasSubstr("the serial number here was 104711"));
    EXPECT_THAT(view(second).message, HasSubstr("linefeed printer line1 accept 99"));
    EXPECT_TRUE(service_->printer("line1")->other_machine());

    const auto guessed = service_->accept_printer(anna, "line1", "98");
    ASSERT_FALSE(guessed);
    EXPECT_EQ(guessed.error().kind, FailureKind::stopped);
    EXPECT_THAT(guessed.error().message, HasSubstr("the printer's serial number is 99, and not 98"));
    ASSERT_TRUE(service_->accept_printer(anna, "line1", "99"));
    EXPECT_FALSE(service_->printer("line1")->other_machine());
    EXPECT_FALSE(service_->accept_printer(anna, "line9", "99"));
    ASSERT_TRUE(service_->start(anna, second));
    ASSERT_TRUE(comes_to(second, JobPhase::finished));
    service_.reset();
    EXPECT_EQ(printer->products(), serials(1001, 1050));
    open(never_watched);
    EXPECT_EQ(service_->printer("line1")->known_serial_number, "99");
}

} // namespace
} // namespace linefeed::service
