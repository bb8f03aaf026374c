// New settings while the service runs: whole, or not at all.
#include "service_fixture.hpp"

namespace linefeed::service {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

using ReloadTest = ServiceTest;

TEST_F(ReloadTest, shouldTakeOverPrintersThatAreNewAndLetGoOfOthers) {
    open(settings_text({"127.0.0.1:1", "127.0.0.1:2"}));
    const spool::JobId job = import(10, 1, "line2");
    text_ = settings_text({"127.0.0.1:1"});
    EXPECT_THAT(service_->reload(anna).value(), ElementsAre(HasSubstr("printers.line2: gone")));
    EXPECT_EQ(service_->printer("line2"), std::nullopt);
    EXPECT_THAT(service_->start(anna, job).error().message, HasSubstr("not in the settings any more"));
    EXPECT_TRUE(service_->enqueue(anna, job, "line1"));

    text_ = settings_text({"127.0.0.1:1", "127.0.0.1:2", "127.0.0.1:3"});
    EXPECT_THAT(service_->reload(anna).value(), SizeIs(2));
    EXPECT_THAT(service_->printers(), SizeIs(3));
    EXPECT_THAT(service_->reload(anna).value(), SizeIs(0));
}

TEST_F(ReloadTest, shouldKeepTheOldSettingsWhenTheNewOnesAreWrong) {
    open(settings_text({"127.0.0.1:1"}));
    text_ = settings_text({"127.0.0.1:2"}) + "nonsense: 1\n";
    const auto done = service_->reload(anna);
    ASSERT_FALSE(done);
    EXPECT_THAT(done.error().message, HasSubstr("the old settings stay"));
    EXPECT_THAT(done.error().message, HasSubstr("nonsense"));
    EXPECT_EQ(service_->printer("line1")->address, "tcp://127.0.0.1:1");
    EXPECT_TRUE(wait_until([&] { return testing::Value(event_kinds(), Contains("service.reload_refused")); }));
}

TEST_F(ReloadTest, shouldTakeNothingOverThatIsRefusedAroundTheService) {
    std::vector<std::string> offered;
    take_over_ = [&](const config::Settings& next) -> Result<void> {
        offered.push_back(link::to_string(next.printers.at(0).address));
        return offered.size() == 1 ? Result<void>{Failure{FailureKind::usage, "a token is wrong"}} : Result<void>{};
    };
    open(settings_text({"127.0.0.1:1"}));
    EXPECT_THAT(offered, SizeIs(0)) << "it is told of what changes";
    text_ = settings_text({"127.0.0.1:2"});
    const auto refused = service_->reload(anna);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error(), (Failure{FailureKind::usage, "the old settings stay: a token is wrong"}));
    EXPECT_EQ(service_->printer("line1")->address, "tcp://127.0.0.1:1");
    EXPECT_TRUE(service_->reload(anna));
    EXPECT_EQ(service_->printer("line1")->address, "tcp://127.0.0.1:2");
    EXPECT_THAT(offered, ElementsAre("tcp://127.0.0.1:2", "tcp://127.0.0.1:2"));
}

TEST_F(ReloadTest, shouldNotChangeTheAddressOfAPrinterThatPrints) {
    SimulatedPrinter printer{directory_ / "tape.csv", 300};
    open(settings_text({printer.address()}));
    const spool::JobId job = import(300);
    ASSERT_TRUE(service_->start(anna, job));
    ASSERT_TRUE(prints_through(job, 10));
    text_ = settings_text({"127.0.0.1:1"});
    const auto refused = service_->reload(anna);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, FailureKind::stopped);
    EXPECT_THAT(refused.error().message, HasSubstr("not while line1 prints"));
    text_ = settings_text({printer.address()}, ", reply_timeout: 3 s");
    EXPECT_TRUE(service_->reload(anna)) << "from the next start on";
    ASSERT_TRUE(comes_to(job, JobPhase::finished));
    text_ = settings_text({"127.0.0.1:1"});
    EXPECT_TRUE(service_->reload(anna));
    EXPECT_EQ(service_->printer("line1")->address, "tcp://127.0.0.1:1");
    service_.reset();
    EXPECT_EQ(printer.products(), serials(1, 300));
}

/// The line that is called so by now is not the printer that has them.
TEST_F(ReloadTest, shouldAskForRecordsOnlyWhereTheyMayBe) {
    SimulatedPrinter printer{directory_ / "tape.csv", 300};
    const std::string address = printer.address();
    open(settings_text({address, "127.0.0.1:1"}));
    const spool::JobId job = import(100);
    service_.reset();
    {
        auto spool = spool::Spool::open(directory_ / "spool.db", {}).value();
        const auto records = RecordRange::closed(RecordNumber{1}, RecordNumber{100});
        const auto run = spool.begin_run(job, records, R"({"printer":"tcp://)" + address + R"("})").value();
        const spool::LedgerEntry intent{spool::LedgerKind::intent, run, records, {}};
        ASSERT_TRUE(spool.append(job, {&intent, 1}));
    }
    open(settings_text({"127.0.0.1:1", address})); // they have changed places
    EXPECT_THAT(service_->start(anna, job).error().message, HasSubstr("may have records in printer line2"));
    ASSERT_TRUE(service_->enqueue(anna, job, "line2"));
    EXPECT_THAT(service_->enqueue(anna, job, "line1").error().message, HasSubstr("may have records in printer line2"));
    ASSERT_TRUE(service_->start(anna, job));
    EXPECT_TRUE(wait_until([&] { return service_->printer("line2")->phase == daemon::PrinterPhase::idle; }));
    EXPECT_EQ(view(job).open, RecordCount{0}) << "asked there";
}

TEST_F(ReloadTest, shouldLookAfterAFolderOnceHoweverManyReloadAtOnce) {
    open(settings_text({"127.0.0.1:1"}));
    std::filesystem::create_directory(directory_ / "in");
    text_ = settings_text({"127.0.0.1:1"}, {},
                          "folders:\n  in: {path: " + (directory_ / "in").string() +
                              ", layout: serials, printer: line1}\n");
    std::vector<std::thread> callers;
    for (int i = 0; i < 4; ++i) {
        callers.emplace_back([this] { EXPECT_TRUE(service_->reload(anna)); });
    }
    for (std::thread& caller : callers) {
        caller.join();
    }
    EXPECT_THAT(service_->folders(), SizeIs(1));
}

TEST_F(ReloadTest, shouldBeginToWatchAFolderThatIsNew) {
    open(settings_text({"127.0.0.1:1"}));
    std::filesystem::create_directory(directory_ / "in");
    text_ = settings_text({"127.0.0.1:1"}, {},
                          "folders:\n  in: {path: " + (directory_ / "in").string() +
                              ", layout: serials, printer: line1, settle: rename}\n");
    ASSERT_TRUE(service_->reload(anna));
    std::filesystem::rename(file("a.csv", 3), directory_ / "in" / "a.csv");
    EXPECT_TRUE(wait_until([&] { return service_->jobs({.phases = {JobPhase::queued}})->size() == 1; }));
    text_ = settings_text({"127.0.0.1:1"});
    ASSERT_TRUE(service_->reload(anna));
    EXPECT_THAT(service_->folders(), SizeIs(0));
}

} // namespace
} // namespace linefeed::service
