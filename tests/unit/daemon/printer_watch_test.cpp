// What is worth a word about one look at an idle printer after the other.
#include "daemon/events.hpp"
#include "daemon/printer_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace linefeed::daemon {

void PrintTo(const PrinterWatch::News& news, std::ostream* out) {
    *out << news.kind << ": " << news.words;
}

namespace {

using protocol::MachineState;
using protocol::MachineStatus;
using protocol::NozzleState;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

MATCHER_P2(IsNews, kind, words, "") {
    return arg.kind == kind && arg.words.find(words) != std::string::npos;
}

printer::Look healthy() {
    printer::Look look;
    look.machine = MachineStatus{NozzleState::open, MachineState::ready_to_print, {}, false, 9, false};
    look.version.emplace().serial_number = "104711";
    return look;
}

class PrinterWatchTest : public testing::Test {
protected:
    std::vector<PrinterWatch::News> take(const printer::Look& look) {
        return watch_.take(look, {settings_, printer_, serial_});
    }

    PrinterWatch watch_;
    config::Settings settings_;
    config::PrinterSettings printer_;
    std::string serial_ = "104711";
};

TEST_F(PrinterWatchTest, shouldHaveNothingToSayAboutAPrinterThatIsWell) {
    EXPECT_THAT(take(healthy()), IsEmpty());
    EXPECT_THAT(take(healthy()), IsEmpty());
    EXPECT_EQ(watch_.link(), LinkState::up);
}

TEST_F(PrinterWatchTest, shouldTellOnceThatAPrinterIsGoneAndThatItIsBack) {
    printer::Look gone;
    gone.unreachable = "tcp://h:3000: Connection refused";
    EXPECT_THAT(take(gone), IsEmpty()) << "another program may hold its only connection for a moment";
    EXPECT_EQ(watch_.link(), LinkState::connecting);
    EXPECT_THAT(take(healthy()), IsEmpty());
    EXPECT_EQ(watch_.link(), LinkState::up);
    EXPECT_THAT(take(gone), IsEmpty());
    EXPECT_THAT(take(gone), ElementsAre(IsNews(event_kind::printer_down, "Connection refused. Look whether")));
    EXPECT_EQ(watch_.link(), LinkState::down);
    EXPECT_THAT(take(gone), IsEmpty());
    EXPECT_THAT(take(healthy()), ElementsAre(IsNews(event_kind::printer_up, "is there again")));
    EXPECT_THAT(take(healthy()), IsEmpty());
}

/// A printer in standby takes the connection and need not answer anything.
TEST_F(PrinterWatchTest, shouldNotTakeASilentPrinterForOneThatIsGone) {
    printer::Look silent;
    silent.silent = true;
    EXPECT_THAT(take(healthy()), IsEmpty());
    EXPECT_THAT(take(silent), ElementsAre(IsNews(event_kind::printer_notice, "it may be in standby")));
    EXPECT_THAT(take(silent), IsEmpty());
    EXPECT_THAT(take(silent), IsEmpty());
    EXPECT_EQ(watch_.link(), LinkState::up);
    EXPECT_THAT(take(healthy()), IsEmpty());
    EXPECT_EQ(take(silent).size(), 1U) << "again";
}

/// Whoever asks for a preflight reads what it finds, but nobody else does.
TEST_F(PrinterWatchTest, shouldTellWhateverHasNotBeenToldByAStartOrARun) {
    printer::Look look = healthy();
    look.machine->error.raw = 0x12000000 | 12113;
    look.machine->cover_open = true;
    watch_.heard(*look.machine);
    EXPECT_THAT(take(look), IsEmpty());
    look.machine->error.raw = -1711274809;
    EXPECT_THAT(take(look), ElementsAre(IsNews(event_kind::printer_warning, "1223")));
}

TEST_F(PrinterWatchTest, shouldTellAnErrorWhenItComesChangesAndGoes) {
    printer::Look look = healthy();
    settings_.errors.entries = {{12113, "the head is dirty", "Clean it.", config::ErrorPolicy::report},
                                {1223, "last record", "Nothing.", config::ErrorPolicy::report}};
    look.machine->error.raw = 0x12000000 | 12113; // an error window
    EXPECT_THAT(take(look), ElementsAre(IsNews(event_kind::printer_error, ": the head is dirty. Clean it.")));
    EXPECT_THAT(take(look), IsEmpty());
    look.machine->error.raw = -1711274809; // 1223 in a message window
    EXPECT_THAT(take(look), ElementsAre(IsNews(event_kind::printer_warning, ": last record. Nothing.")));
    printer_.errors[1223] = config::ErrorPolicy::stop;
    watch_.heard(*healthy().machine);
    EXPECT_THAT(take(look), ElementsAre(IsNews(event_kind::printer_error, "1223")));
    EXPECT_THAT(take(healthy()), ElementsAre(IsNews(event_kind::printer_notice, "the error is gone: 1223")));
}

TEST_F(PrinterWatchTest, shouldTellThatTheCoverIsOpenOrClosed) {
    printer::Look look = healthy();
    look.machine->cover_open = true;
    EXPECT_THAT(take(look), ElementsAre(IsNews(event_kind::printer_warning, "the head cover is open")));
    EXPECT_THAT(take(look), IsEmpty());
    EXPECT_THAT(take(healthy()), ElementsAre(IsNews(event_kind::printer_notice, "the head cover is closed")));
}

TEST_F(PrinterWatchTest, shouldTellThatAPrinterPrintsWhichNobodyLooksAfter) {
    printer::Look look = healthy();
    look.machine->machine = MachineState::printing;
    EXPECT_THAT(take(look), ElementsAre(IsNews(event_kind::printer_warning, "it is printing, and linefeed")));
    EXPECT_THAT(take(look), IsEmpty());
}

TEST_F(PrinterWatchTest, shouldTellOnceThatAnotherMachineAnswers) {
    printer::Look look = healthy();
    look.version->serial_number = "99";
    EXPECT_THAT(take(look), ElementsAre(IsNews(event_kind::printer_warning,
                                               "another machine: serial number 99, and it was 104711")));
    EXPECT_THAT(take(look), IsEmpty());
    EXPECT_THAT(take(healthy()), IsEmpty());
    EXPECT_EQ(take(look).size(), 1U) << "again";
    look.version->serial_number = "98";
    EXPECT_EQ(take(look).size(), 1U) << "and another one";
    look.version->serial_number.clear();
    EXPECT_THAT(take(look), IsEmpty());
    look.version.reset();
    EXPECT_THAT(take(look), IsEmpty());
    serial_.clear();
    look = healthy();
    EXPECT_THAT(take(look), IsEmpty()) << "the first one that answers is the one";
}

} // namespace
} // namespace linefeed::daemon
