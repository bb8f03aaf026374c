// Printers with an automatic profile: what the printer says decides how records are written, and where they may start.
#include "service_fixture.hpp"

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
    [[nodiscard]] daemon::ImportRequest special_characters() const {
        const std::filesystem::path path = directory_ / "special.csv";
        std::ofstream{path} << "serial\na^b\na\\b\n";
        return {.file = path, .name = {}, .layout = "serials", .printer = "line1", .autostart = false};
    }
};

TEST_F(ToldProfileTest, shouldWriteRecordsAsThePrinterReadsThem) {
    SimulatedPrinter printer{directory_ / "tape.csv", 1000, "0", machine("jet2neo")};
    open(settings(printer));
    const auto imported = service_->import(anna, special_characters());
    ASSERT_TRUE(imported && imported->job) << (imported ? imported->report : imported.error().message);
    ASSERT_TRUE(service_->start(anna, *imported->job));
    ASSERT_TRUE(comes_to(*imported->job, JobPhase::finished)) << view(*imported->job).message;
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
    const spool::JobId job = import(20);
    printer.reset();
    printer.emplace(directory_ / "tape2.csv", 1000, port, machine("jet3"));
    ASSERT_TRUE(service_->start(anna, job));
    ASSERT_TRUE(comes_to(job, JobPhase::stopped));
    EXPECT_THAT(view(job).message, HasSubstr("Import its file again for this printer"));
    service_.reset();
    EXPECT_TRUE(printer->products().empty());
}

} // namespace
} // namespace linefeed::service
