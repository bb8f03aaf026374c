// Printers with an automatic profile: what the printer says decides how records are written, and where they may start.
#include "service_fixture.hpp"
#include "support/peer.hpp"

namespace linefeed::service {
namespace {

using testing::HasSubstr;

class ToldProfileTest : public ServiceTest {
protected:
    static simulator::SimulatorSettings machine(std::string_view profile) {
        simulator::SimulatorSettings settings;
        settings.printer.profile = protocol::profile_by_name(profile).value();
        return settings;
    }
    [[nodiscard]] std::string settings(const SimulatedPrinter& printer) const {
        return settings_text({printer.address()}, ", profile: auto, watch_interval: 0 s");
    }
    spool::JobId import_special() {
        const auto imported = service_->import(anna, special_characters());
        EXPECT_TRUE(imported && imported->job) << (imported ? imported->report : imported.error().message);
        return imported ? imported->job.value_or(spool::JobId{}) : spool::JobId{};
    }
    [[nodiscard]] daemon::ImportRequest special_characters() const {
        const std::filesystem::path path = directory_ / "special.csv";
        std::ofstream{path} << "serial\na^b\na\\b\n";
        return {.file = path, .name = {}, .layout = "serials", .printer = "line1", .autostart = false};
    }
};

TEST_F(ToldProfileTest, shouldWriteRecordsAsThePrinterReadsThem) {
    SimulatedPrinter printer{directory_ / "tape.csv", 1000, "0", machine("jet2neo")};
    open(settings(printer));
    const spool::JobId job = import_special();
    ASSERT_TRUE(service_->start(anna, job));
    ASSERT_TRUE(comes_to(job, JobPhase::finished)) << view(job).message;
    service_.reset();
    EXPECT_THAT(printer.products(), testing::ElementsAre("a^b", "a\\b"));
}

TEST_F(ToldProfileTest, shouldRefuseWhatThePrinterCannotBeSent) {
    SimulatedPrinter printer{directory_ / "tape.csv", 1000, "0", machine("jet3")};
    open(settings(printer));
    const auto refused = service_->import(anna, special_characters());
    ASSERT_TRUE(refused) << refused.error().message;
    EXPECT_FALSE(refused->job);
    EXPECT_THAT(refused->report, HasSubstr("without escapes"));
    const spool::JobId plain = import(20);
    ASSERT_TRUE(service_->start(anna, plain));
    ASSERT_TRUE(comes_to(plain, JobPhase::finished));
    service_.reset();
    EXPECT_EQ(printer.products(), serials(1, 20));
}

TEST_F(ToldProfileTest, shouldNotStartOnOtherFirmwareWhatWasWrittenWithEscapes) {
    std::optional<SimulatedPrinter> printer{std::in_place, directory_ / "tape.csv", 1000, "0", machine("jet3up")};
    const std::string port = printer->port();
    open(settings(*printer));
    const spool::JobId job = import_special();
    const spool::JobId plain = import(20);
    printer.reset();
    printer.emplace(directory_ / "tape2.csv", 1000, port, machine("jet3"));
    ASSERT_TRUE(service_->start(anna, job));
    ASSERT_TRUE(comes_to(job, JobPhase::stopped));
    EXPECT_THAT(view(job).message, HasSubstr("Import its file again for this printer"));
    ASSERT_TRUE(service_->start(anna, plain));
    ASSERT_TRUE(comes_to(plain, JobPhase::finished)) << "nothing in it needs an escape";
    text_ = settings_text({printer->address()}, ", profile: jet3, watch_interval: 0 s");
    ASSERT_TRUE(service_->reload(anna));
    EXPECT_THAT(service_->start(anna, job).error().message, HasSubstr("imported for another firmware"));
    service_.reset();
    EXPECT_EQ(printer->products(), serials(1, 20));
}

TEST_F(ToldProfileTest, shouldNotStartRecordsWithEscapesWhereThePrinterDoesNotTellWhatItIs) {
    std::optional<SimulatedPrinter> printer{std::in_place, directory_ / "tape.csv", 1000, "0", machine("jet3up")};
    open(settings(*printer));
    const spool::JobId job = import_special();
    service_.reset();
    auto unknown = machine("jet3up");
    unknown.printer.firmware = "new";
    printer.emplace(directory_ / "tape2.csv", 1000, "0", unknown);
    open(settings(*printer));
    ASSERT_TRUE(service_->start(anna, job));
    ASSERT_TRUE(comes_to(job, JobPhase::stopped));
    EXPECT_THAT(view(job).message, HasSubstr("name its profile in the settings"));
    service_.reset();
    EXPECT_TRUE(printer->products().empty());

    printer::Peer silent{[](std::string_view frame) {
        return printer::Peer::Reaction{frame == "^0?RS"   ? "^0=RS2\t5\t0\t0\t9\t0\r"
                                       : frame == "^0?SM" ? "^0=SM256\t0\t0\t0\t1\r"
                                                          : ""};
    }};
    open(settings_text({silent.settings().address.substr(6)},
                       ", profile: auto, watch_interval: 0 s, reply_timeout: 100 ms"));
    ASSERT_TRUE(service_->start(anna, job));
    ASSERT_TRUE(comes_to(job, JobPhase::stopped));
    EXPECT_THAT(view(job).message, HasSubstr("name its profile in the settings"));
    EXPECT_THAT(silent.heard(), HasSubstr("^0?VS\n^0?VS\n"));
    EXPECT_THAT(silent.heard(), testing::Not(HasSubstr("^0!")));
}

TEST_F(ToldProfileTest, shouldRememberWhatASwitchedOffPrinterHasTold) {
    std::optional<SimulatedPrinter> printer{std::in_place, directory_ / "tape.csv", 1000, "0", machine("jet3up")};
    const std::string text = settings(*printer);
    open(text);
    static_cast<void>(import(20)); // for which it is asked
    service_.reset();
    printer.reset();
    open(text);
    EXPECT_NE(import_special(), spool::JobId{}) << "JET3up knows escapes";
    EXPECT_EQ(service_->printer("line1")->firmware, "") << "it was not heard of since";
}

TEST_F(ToldProfileTest, shouldRememberAProbeOfThisMachineWithThisFirmware) {
    auto ignores = machine("jet3up");
    ASSERT_TRUE(simulator::set_habit(ignores.printer.habits, "ignore-stop-at"));
    std::optional<SimulatedPrinter> printer{std::in_place, directory_ / "tape.csv", 1000, "0", ignores};
    const std::string port = printer->port();
    const std::string text = settings(*printer);
    open(text);
    EXPECT_EQ(service_->printer("line1")->probe, "");
    ASSERT_TRUE(service_->command(anna, "line1", "probe", "{}"));
    service_.reset();
    open(text);
    const auto view = service_->printer("line1");
    EXPECT_THAT(view->probe, HasSubstr("\"keeps_stop_at\":false"));
    EXPECT_GT(view->probed_ns, 0);
    const auto finds = [this](std::string_view words) {
        const auto findings = service_->preflight("line1");
        return findings && std::ranges::any_of(*findings, [&](const daemon::Finding& finding) {
                   return finding.words.find(words) != std::string::npos;
               });
    };
    EXPECT_TRUE(finds("does not keep a stop point"));
    printer.reset();
    auto newer = machine("jet3up");
    newer.printer.firmware = "V63.0.0.1";
    printer.emplace(directory_ / "tape2.csv", 1000, port, newer);
    EXPECT_TRUE(finds("firmware V63.0.0.1"));
    EXPECT_EQ(service_->printer("line1")->probe, "") << "that was another firmware";
    EXPECT_FALSE(finds("does not keep a stop point"));
}

/// A printer that serves one connection at a time would lose the job.
TEST_F(ToldProfileTest, shouldNotAskAPrinterThatAJobIsOn) {
    printer::Peer silent{[](std::string_view) { return printer::Peer::Reaction{}; }};
    open(settings_text({silent.settings().address.substr(6)},
                       ", profile: auto, watch_interval: 0 s, reply_timeout: 1 s"));
    const spool::JobId job = import(20);
    EXPECT_EQ(silent.connections(), 1);
    ASSERT_TRUE(service_->start(anna, job));
    ASSERT_TRUE(wait_until([&] { return silent.connections() == 2; })) << "the look before the start";
    static_cast<void>(import(20, 101));
    EXPECT_EQ(silent.connections(), 2);
    EXPECT_EQ(service_->printer("line1")->job, job) << "it was still on the line";
}

} // namespace
} // namespace linefeed::service
