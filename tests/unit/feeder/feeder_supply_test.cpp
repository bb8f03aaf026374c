// A run that begins before its end is known: the stop point stands behind all that can come, and moves to the end.
#include "story.hpp"

namespace linefeed::feeder {
namespace {

using State = protocol::MachineState;
using std::chrono::milliseconds;

constexpr std::uint32_t bound = 200; ///< as far as anybody knows

/// The standard run, but nobody knows that 110 is the last record. Four records are in the printer, up to the first
/// answer while it prints.
Story printing_open_ended(std::uint32_t supplied = 104) {
    Story story;
    story.arm_to_grant();
    story.granted(Story::first, bound, supplied);
    story.sm(0, 77, 0);
    story.sm(0, 77, bound);
    story.actions.clear();
    story.supplied(supplied);
    story.sm(3, 77, bound);
    story.wait(FeederSettings{}.fill_lead);
    story.rs(State::printing);
    story.sm(3, 77, bound);
    story.actions.clear();
    EXPECT_EQ(story.phase(), Phase::printing);
    return story;
}

void end_known(Story& story, std::uint32_t last = Story::last) {
    story.feeder.on_end_known(RecordNumber{last}, story.now, story.actions);
}

TEST(FeederSupply, shouldBeginWithAStopPointBehindAllThatCanCome) {
    Story story;
    story.arm_to_grant();
    story.granted(Story::first, bound, Story::last);
    story.take();
    story.sm(0, 77, 0);
    story.expect("=CM 200; ?SM");
}

TEST(FeederSupply, shouldWarnOnceBeforeThePrinterRunsEmpty) {
    Story story = printing_open_ended();
    story.sm(2, 101, bound);
    EXPECT_EQ(story.take().find("notice"), std::string::npos) << "three are left";
    story.sm(0, 103, bound);
    story.sm(0, 104, bound);
    const std::string notice = story.take();
    EXPECT_NE(notice.find("notice: the printer runs empty soon"), std::string::npos) << notice;
    story.sm(0, 104, bound);
    EXPECT_EQ(story.take().find("notice"), std::string::npos) << "said already";
}

TEST(FeederSupply, shouldSayWhyThePrinterRanEmpty) {
    Story story = printing_open_ended();
    story.sm(0, 104, bound);
    story.take();
    story.rs(State::ready_to_print, raw_error(5043));
    story.judge(0, 104, true, 1004, raw_error(5043));
    const std::string end = story.take();
    EXPECT_NE(end.find("end: ran_dry"), std::string::npos) << end;
}

TEST(FeederSupply, shouldSetTheStopPointOfTheEndBeforeTheStart) {
    Story story;
    story.arm_to_grant();
    story.granted(Story::first, bound, 110);
    story.sm(0, 77, 0);
    story.take();
    end_known(story);
    story.expect("=CM 110; ?SM");
    story.sm(0, 77, bound); // asked before
    story.sm(0, 77, 110);
    story.take();
    story.supplied(110);
    story.expect("=MR 101-104; ?SM");
}

TEST(FeederSupply, shouldMoveTheStopPointWhenAllThatWasSentHasArrived) {
    Story story = printing_open_ended(110);
    end_known(story);
    EXPECT_EQ(story.take().find("=CM"), std::string::npos);
    story.sm(2, 101, bound);             // well filled
    story.expect("printed through 101"); // what is under way may be lost
    std::string told;
    int answers = 0;
    while (told.find("=CM 110") == std::string::npos && answers < 12) {
        story.sm(2, 101, bound);
        told += story.take();
        ++answers;
    }
    EXPECT_LT(answers, 12) << told;
    EXPECT_EQ(told.find("=MR"), std::string::npos) << "nothing is sent while the stop point moves";
    // Read back: it goes on as always.
    told.clear();
    for (answers = 0; answers < 12 && told.find("=MR") == std::string::npos; ++answers) {
        story.sm(1, 102, 110);
        told += story.take();
    }
    EXPECT_NE(told.find("=MR"), std::string::npos);
}

TEST(FeederSupply, shouldMoveTheStopPointUnderTheLastRecords) {
    Story story = printing_open_ended(104);
    end_known(story, 104);
    story.take();
    std::string told;
    for (int answers = 0; answers < 12 && told.find("=CM 104") == std::string::npos; ++answers) {
        story.sm(0, 103, bound); // half empty, and there is nothing to fill it with
        told += story.take();
    }
    EXPECT_NE(told.find("=CM 104"), std::string::npos) << told;
    for (int answers = 0; answers < 4; ++answers) {
        story.sm(0, 103, 104);
    }
    EXPECT_EQ(story.phase(), Phase::printing) << "the last record is loaded: an empty FIFO is no loss";
    story.take();
    story.sm(0, 104, 104);
    story.expect("printed through 104; ?RS");
}

TEST(FeederSupply, shouldStopThePrinterWhenAllIsPrintedBeforeItsStopPointHasMoved) {
    Story story = printing_open_ended(104);
    story.sm(0, 103, bound);
    end_known(story, 104);
    story.take();
    story.sm(0, 104, bound);
    EXPECT_NE(story.take().find("!ST"), std::string::npos);
}

TEST(FeederSupply, shouldWarnAgainWhenTheSupplyHadCaughtUp) {
    Story story = printing_open_ended();
    story.sm(0, 104, bound);
    EXPECT_NE(story.take().find("notice"), std::string::npos);
    story.supplied(110);
    story.durable(110); // more than fits
    EXPECT_NE(story.take().find("=MR 105-108"), std::string::npos);
    story.sm(3, 104, bound);
    story.sm(0, 107, bound);
    EXPECT_NE(story.take().find("=MR 109-110"), std::string::npos);
    story.sm(0, 109, bound);
    story.sm(0, 110, bound);
    EXPECT_NE(story.take().find("notice"), std::string::npos) << "it had been filled in between";
}

TEST(FeederSupply, shouldNotWarnOnceMoreWhileTheStopPointMoves) {
    Story story = printing_open_ended();
    end_known(story);
    story.sm(2, 101, bound); // well filled: nothing is sent now
    story.sm(0, 104, bound);
    EXPECT_NE(story.take().find("notice"), std::string::npos);
    story.supplied(110);
    story.durable(110);
    story.sm(0, 104, bound);
    const std::string told = story.take();
    EXPECT_EQ(told.find("notice"), std::string::npos) << told;
    EXPECT_EQ(told.find("=MR"), std::string::npos) << told;
}

TEST(FeederSupply, shouldNotCareAboutTheEndOutsideOfARun) {
    Story story;
    story.identify();
    end_known(story);
    story.expect("");
    story.storage_failed();
    EXPECT_EQ(story.phase(), Phase::ended);
    story.take();
    end_known(story);
    story.expect("");
}

TEST(FeederSupply, shouldIgnoreAnEndThatIsNotBeforeTheBound) {
    Story story = printing_open_ended(110);
    end_known(story, bound);
    story.expect("");
    end_known(story, bound + 50);
    story.expect("");
}

TEST(FeederSupply, shouldNotMoveTheStopPointOfAPrinterThatIgnoresIt) {
    Story story;
    story.arm_to_grant();
    story.granted(Story::first, bound, Story::last);
    story.sm(0, 77, 0);
    story.sm(0, 77, 0);
    story.sm(0, 77, 0);
    story.take();
    story.supplied(104);
    story.sm(3, 77, 0);
    story.wait(FeederSettings{}.fill_lead);
    story.rs(State::printing);
    story.take();
    end_known(story);
    EXPECT_EQ(story.take().find("=CM"), std::string::npos);
}

TEST(FeederSupply, shouldTakeAPrinterThatDoesNotMoveItsStopPointForOneThatIgnoresIt) {
    Story story = printing_open_ended(110);
    end_known(story);
    std::string told;
    for (int answers = 0; answers < 60 && told.find("notice") == std::string::npos; ++answers) {
        story.sm(2, 101, bound); // the old one, again and again
        told += story.take() + "; ";
    }
    EXPECT_NE(told.find("notice: the printer does not keep the stop point"), std::string::npos) << told;
    int moves = 0;
    for (std::size_t at = told.find("=CM 110"); at != std::string::npos; at = told.find("=CM 110", at + 1)) {
        ++moves;
    }
    EXPECT_EQ(moves, 3);
}

TEST(FeederSupply, shouldStopWhenTheFifoIsFoundLostBehindTheMove) {
    Story story = printing_open_ended(110);
    end_known(story);
    std::string told;
    for (int answers = 0; answers < 12 && told.find("=CM 110") == std::string::npos; ++answers) {
        story.sm(2, 101, bound);
        told += story.take();
    }
    for (int answers = 0; answers < 12 && story.phase() == Phase::printing; ++answers) {
        story.sm(0, 101, 110); // stopped and started again at the panel under the move: all it held is gone
    }
    EXPECT_EQ(story.phase(), Phase::stopping);
    EXPECT_NE(story.take().find("!ST"), std::string::npos);
}

/// The printer has the stop point that it was told, and prints on when that has been read back.
TEST(FeederSupply, shouldFinishBehindTheLastRecordOnceItIsKnown) {
    Story story = printing_open_ended(110);
    end_known(story);
    std::string told;
    std::uint32_t printed = 102;
    std::uint32_t sent = 104;
    std::uint32_t stop_at = bound;
    int answers_moved = 0;
    for (int answers = 0; answers < 40 && printed < 110; ++answers) {
        story.sm(sent - printed - 1, printed, stop_at);
        const std::string actions = story.take();
        stop_at = actions.find("=CM 110") != std::string::npos ? 110 : stop_at;
        if (const std::size_t refill = actions.find("=MR "); refill != std::string::npos) {
            sent = static_cast<std::uint32_t>(std::stoul(actions.substr(refill + 8)));
        }
        answers_moved += stop_at == 110 ? 1 : 0;
        printed += answers_moved > 4 && sent > printed ? 1 : 0;
        told += actions + "; ";
    }
    EXPECT_EQ(stop_at, 110U) << told;
    EXPECT_EQ(sent, 110U) << told;
    story.sm(0, 110, 110);
    story.expect("printed through 110; ?RS");
    story.rs(State::ready_to_print, end_message);
    story.judge(0, 110, true, 1010, end_message);
    story.expect("settle this run: printed none, in doubt none, unused none by nothing was issued; !EQ; ?RS");
    story.rs(State::ready_to_print);
    EXPECT_NE(story.take().find("end: finished"), std::string::npos);
}

} // namespace
} // namespace linefeed::feeder
