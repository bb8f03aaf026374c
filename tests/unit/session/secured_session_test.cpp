// A session on a line with CRC32: a printer that keeps the protocol's section 6 stands at the other end, and does to
// single frames what a bad line does.
#include "conversation.hpp"
#include "protocol/crc32.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <sstream>

namespace linefeed::session {
namespace {

using std::chrono::milliseconds;

constexpr std::uint32_t records = 60;

SessionSettings secured_settings() {
    SessionSettings settings;
    settings.line = {.bytes_per_second = 11520, .crc = true};
    return settings;
}

/// Counts what it is told of.
struct Watching : FrameObserver {
    void on_frame_received(std::string_view, Instant) override {}
    void on_damage_received(std::uint64_t, Instant) override {}
    void on_command_sent(std::string_view, Instant) override { ++commands; }
    void on_records_sent(RecordRange range, std::string_view first, std::size_t bytes, Instant) override {
        EXPECT_EQ(first.size(), bytes);
        EXPECT_EQ(range.count(), RecordCount{1});
        ++sent;
    }
    int commands = 0;
    int sent = 0;
};

class SecuredSessionTest : public testing::Test {
protected:
    explicit SecuredSessionTest(const SessionSettings& settings = secured_settings())
        : host_(settings, {}, &watching_) {}

    /// What happens to the frame that the host sent.
    enum class Fate { arrives, refused, unannounced, lost, word_damaged, long_word, filled_word, answer_damaged };

    /// Answers until the host has nothing more to say. Returns the frames that it sent, without announcements.
    std::string answer_all() {
        std::string story;
        for (std::string sent = host_.sent(); !sent.empty(); sent = host_.sent()) {
            std::istringstream lines{sent};
            for (std::string announcement, frame; std::getline(lines, announcement) && std::getline(lines, frame);) {
                EXPECT_EQ(announcement, "^0=NR" + std::to_string(protocol::crc32(frame)));
                story += frame + "\n";
                answer(frame);
            }
        }
        return story;
    }
    void answer(const std::string& frame) {
        const Fate fate = fate_(frame);
        if (fate == Fate::lost) {
            return;
        }
        if (fate == Fate::refused) {
            host_.receive("^0=FC1\r");
            return;
        }
        const std::string said = execute(frame);
        if (fate == Fate::unannounced) {
            host_.receive(said);
            return;
        }
        host_.receive(fate == Fate::word_damaged  ? "^0!Og\r"
                      : fate == Fate::long_word   ? "^000004!OK\r"
                      : fate == Fate::filled_word ? "^0!OK   \r"
                                                  : "^0!OK\r");
        if (!said.empty()) {
            std::string crc = std::to_string(protocol::crc32(said.substr(0, said.size() - 1)));
            if (fate == Fate::answer_damaged) {
                crc.back() = crc.back() == '0' ? '1' : '0';
            }
            host_.receive("^0=NR" + crc + "\r" + said);
        }
    }
    static std::string announced(const std::string& frame) {
        return "^0=NR" + std::to_string(protocol::crc32(frame)) + "\r" + frame + "\r";
    }
    /// The printer's answer, if any.
    std::string execute(const std::string& frame) {
        if (frame.starts_with("^0=MR")) {
            last_ = static_cast<std::uint32_t>(std::stoul(frame.substr(5)));
        } else if (frame.starts_with("^0=CM")) {
            stop_at_ = frame.substr(5);
        } else if (frame == "^0!GO") {
            printing_ = true;
        } else if (frame == "^0!ST" || frame == "^0!FF") {
            printing_ = printing_ && frame != "^0!ST";
            last_ = printed_;
            stop_at_ = frame == "^0!ST" ? "0" : stop_at_;
        } else if (frame == "^0?RS") {
            return std::string{"^0=RS2\t"} + (printing_ ? "6" : "5") + "\t0\t0\t0\t0\r";
        } else if (frame == "^0?SM") {
            return "^0=SM256\t" + std::to_string(last_ > printed_ ? last_ - printed_ - 1 : 0) + "\t" +
                   std::to_string(printed_) + "\t" + stop_at_ + "\t1\r";
        } else if (frame == "^0?CC") {
            return "^0=CC0\t0\t" + std::to_string(1000 + printed_) + "\r";
        } else if (frame == "^0?VS") {
            return "^0=VS1\t1\t1\t1\t1\t1\t1\t1\t1\t1\tS1\r";
        } else if (frame == "^0?JL") {
            return "^0=JLA\r";
        } else if (frame.starts_with("^0?")) {
            return "^0=" + frame.substr(3) + "1\t1\t1\r";
        }
        return {};
    }
    /// Connects, and gives the session the records of pages_, up to `last`.
    void arm(std::uint32_t last) {
        host_.connect();
        static_cast<void>(answer_all());
        host_.grant(1, last);
        static_cast<void>(answer_all());
        for (const auto& page : pages_) {
            host_.page(*page);
        }
    }
    void print_through(std::uint32_t number) {
        host_.connect();
        static_cast<void>(answer_all());
        host_.grant(1, records);
        static_cast<void>(answer_all());
        for (const auto& page : pages_) {
            host_.page(*page);
        }
        for (int i = 0; i < 200 && !printing_; ++i) {
            static_cast<void>(answer_all());
            host_.wake();
        }
        static_cast<void>(answer_all());
        ASSERT_EQ(host_.session.feeder().phase(), feeder::Phase::printing);
        printed_ = number;
        static_cast<void>(host_.story());
    }
    /// Lets time pass until the run is over.
    std::string wait_for_end() {
        std::string story;
        for (int i = 0; i < 500 && story.find("end") == std::string::npos; ++i) {
            host_.wake();
            frames_ += answer_all();
            const std::string more = host_.story();
            story += more;
            if (more.find("settle") != std::string::npos) {
                host_.settled();
            }
            frames_ += answer_all();
            story += host_.story();
        }
        return story;
    }

    std::vector<std::unique_ptr<RecordPage>> pages_ = make_pages(1, records, 20, plain_text);
    Watching watching_;
    Conversation host_;
    std::function<Fate(const std::string& frame)> fate_ = [](const std::string&) { return Fate::arrives; };
    std::string frames_;
    std::uint32_t last_ = 0;
    std::uint32_t printed_ = 0;
    std::string stop_at_ = "0";
    bool printing_ = false;
};

/// Where bytes need no time.
class SecuredNetworkTest : public SecuredSessionTest {
protected:
    SecuredNetworkTest()
        : SecuredSessionTest([] {
            SessionSettings settings;
            settings.line.crc = true;
            return settings;
        }()) {}
    /// Nothing arrives, for so long.
    void be_away(Duration time) {
        fate_ = [](const std::string&) { return Fate::lost; };
        for (const Instant back = host_.now + time; host_.now < back && !host_.ended;) {
            static_cast<void>(answer_all());
            host_.wait(milliseconds{5});
        }
    }
};

TEST_F(SecuredNetworkTest, shouldGiveAPrinterUpWhenItsFirstAnswerIsLost) {
    print_through(2);
    be_away(std::chrono::seconds{20});
    EXPECT_TRUE(host_.ended);
    EXPECT_EQ(host_.outcome.code, feeder::OutcomeCode::no_answer);
}

/// What was only waiting to be asked tells nothing about the printer.
TEST_F(SecuredNetworkTest, shouldJudgeAPrinterThatWasAwayWhenItWasToStop) {
    print_through(2);
    be_away(milliseconds{2500});
    ASSERT_FALSE(host_.ended);
    host_.stop();
    host_.wait(milliseconds{1});
    fate_ = [](const std::string&) { return Fate::arrives; };
    const std::string story = wait_for_end();
    EXPECT_NE(story.find("stop_requested"), std::string::npos) << story;
}

TEST_F(SecuredSessionTest, shouldSendOneFrameAtATime) {
    host_.connect();
    EXPECT_EQ(host_.sent(), "^0=NR" + std::to_string(protocol::crc32("^0?RS")) + "\n^0?RS\n");
}

TEST_F(SecuredSessionTest, shouldPrintToTheEnd) {
    print_through(records);
    printing_ = false;
    const std::string story = wait_for_end();
    EXPECT_NE(story.find("finished"), std::string::npos) << story;
    EXPECT_EQ(last_, records);
}

TEST_F(SecuredSessionTest, shouldRepeatARefusedRecordBeforeTheNext) {
    int refusals = 3;
    fate_ = [&](const std::string& frame) {
        return frame.starts_with("^0=MR7\t") && refusals-- > 0 ? Fate::refused : Fate::arrives;
    };
    print_through(0);
    EXPECT_EQ(last_, records);
    EXPECT_EQ(refusals, -1);
}

TEST_F(SecuredSessionTest, shouldTakeADamagedWordForRight) {
    fate_ = [](const std::string& frame) { return frame.starts_with("^0=MR7\t") ? Fate::word_damaged : Fate::arrives; };
    print_through(0);
    EXPECT_EQ(last_, records);
}

/// An earlier client has sent `!LN`.
TEST_F(SecuredSessionTest, shouldUnderstandAWordWithALength) {
    fate_ = [](const std::string& frame) { return frame.starts_with("^0=MR") ? Fate::long_word : Fate::arrives; };
    print_through(0);
    EXPECT_EQ(last_, records);
}

/// Each record takes so long that the fill outlasts the time-out for it.
TEST_F(SecuredSessionTest, shouldFillThePrinterHoweverLongThatTakes) {
    fate_ = [this](const std::string& frame) {
        host_.now += frame.starts_with("^0=MR") ? milliseconds{150} : milliseconds{0};
        return Fate::arrives;
    };
    print_through(0);
    EXPECT_EQ(last_, records);
    EXPECT_GT(host_.now - Instant{}, secured_settings().feeder.verify_timeout);
}

TEST_F(SecuredSessionTest, shouldUnderstandAWordThatIsFilledWithBlanks) {
    fate_ = [](const std::string&) { return Fate::filled_word; };
    print_through(0);
    EXPECT_EQ(last_, records);
}

TEST_F(SecuredSessionTest, shouldNotTakeOtherBytesForAWord) {
    fate_ = [](const std::string& frame) { return frame.starts_with("^0=MR7\t") ? Fate::lost : Fate::arrives; };
    arm(records);
    static_cast<void>(answer_all());
    // Pieces may be of a refusal.
    host_.receive("~0!OK\r^000007!OK\rx0=FC\rabc\r^0!GO\r^0?GO\r^0=NRx\r^0=ZZ1\r" + announced("^0=ZZ1") +
                  announced("^0=SM256\t0\t0\t0\t1"));
    EXPECT_EQ(host_.sent(), "") << "the record has not been confirmed";
    EXPECT_EQ(last_, 6U);
}

TEST_F(SecuredSessionTest, shouldTellWhoeverKeepsTheFrames) {
    print_through(0);
    EXPECT_EQ(watching_.sent, static_cast<int>(records));
    EXPECT_GT(watching_.commands, watching_.sent);
}

TEST_F(SecuredSessionTest, shouldAskAgainForAnAnswerThatCannotBeRead) {
    host_.connect();
    static_cast<void>(host_.sent());
    host_.receive("^0!OK\r" + announced("^0=RSx"));
    host_.wait(milliseconds{50});
    EXPECT_EQ(host_.sent(), "^0=NR" + std::to_string(protocol::crc32("^0?RS")) + "\n^0?RS\n");
}

TEST_F(SecuredSessionTest, shouldGiveAPrinterUpThatSaysNothing) {
    fate_ = [](const std::string&) { return Fate::lost; };
    host_.connect();
    const std::string story = wait_for_end();
    EXPECT_NE(story.find("no_answer"), std::string::npos) << story;
}

TEST_F(SecuredSessionTest, shouldSayThatAPrinterKnowsNoCrc) {
    fate_ = [](const std::string&) { return Fate::unannounced; };
    host_.connect();
    EXPECT_NE(wait_for_end().find("not_secured"), std::string::npos);
    EXPECT_LT(host_.now, Instant{std::chrono::seconds{8}});
}

TEST_F(SecuredSessionTest, shouldBelieveStandbyWithoutCrc) {
    host_.connect();
    host_.receive("^0=RS0\t1\t0\t0\t0\t0\r");
    EXPECT_NE(host_.story().find("not_ready"), std::string::npos) << "at once";
}

TEST_F(SecuredSessionTest, shouldNotHeedWhatIsNoAnswerBeforeAnythingIsSecured) {
    host_.connect();
    static_cast<void>(host_.sent());
    host_.receive("^0!GO\r^0=ZZ1\r^0=SM256\t0\t0\t0\t1\r");
    EXPECT_EQ(host_.session.statistics().frames_unexpected, 3U);
    EXPECT_EQ(host_.session.feeder().phase(), feeder::Phase::identifying);
}

TEST_F(SecuredSessionTest, shouldAskNothingMoreAtTheEnd) {
    host_.connect();
    static_cast<void>(host_.sent());
    host_.receive("^0!OK\r" + announced("^0=RS2\t5\t0\t0\t0\t0"));
    EXPECT_NE(host_.sent().find("^0?VS"), std::string::npos) << "and the job's name waits";
    host_.stop();
    EXPECT_NE(host_.story().find("close"), std::string::npos);
    EXPECT_EQ(host_.sent(), "");
}

/// The last stop is repeated until the printer has it, though the run has ended for want of an answer.
TEST_F(SecuredSessionTest, shouldStopAPrinterThatWasSilentBeforeItGoes) {
    print_through(0);
    bool back = false;
    fate_ = [&](const std::string& frame) {
        back = back || frame == "^0!ST";
        return back ? Fate::arrives : Fate::lost;
    };
    EXPECT_NE(wait_for_end().find("no_answer"), std::string::npos);
    EXPECT_FALSE(printing_);
    EXPECT_GE(frames_.find("^0!ST\n", frames_.find("^0!ST\n") + 1), frames_.find("^0!ST\n"));
}

TEST_F(SecuredSessionTest, shouldNotGiveUpWhatIsNoInquiryWhenItIsToStop) {
    fate_ = [](const std::string& frame) { return frame == "^0!GO" ? Fate::lost : Fate::arrives; };
    arm(records);
    std::string frames;
    for (int i = 0; i < 200 && frames.find("^0!GO") == std::string::npos; ++i) {
        frames += answer_all();
        host_.wake();
    }
    fate_ = [](const std::string&) { return Fate::lost; };
    static_cast<void>(answer_all());
    host_.wait(milliseconds{400});
    EXPECT_EQ(answer_all().substr(0, 3), "^0?") << "put in between";
    host_.stop();
    EXPECT_EQ(answer_all(), "");
    fate_ = [](const std::string&) { return Fate::arrives; };
    EXPECT_NE(wait_for_end().find("stop_requested"), std::string::npos);
}

TEST_F(SecuredSessionTest, shouldNotWaitForAnAnswerThatNobodyWantsAnyMore) {
    host_.connect();
    host_.stop();
    EXPECT_NE(host_.story().find("close"), std::string::npos) << "the first inquiry is still under way";
}

/// The inquiry is lost, and so is each that is put in between: the stop goes out all the same, and is repeated when the
/// printer answers again.
TEST_F(SecuredSessionTest, shouldStopThoughAnInquiryIsUnderWay) {
    print_through(0);
    fate_ = [](const std::string&) { return Fate::lost; };
    host_.wait(milliseconds{100});
    EXPECT_NE(answer_all().find("^0?"), std::string::npos);
    host_.wait(milliseconds{400});
    static_cast<void>(answer_all()); // the one that is put in between
    host_.stop();
    EXPECT_EQ(answer_all(), "^0!ST\n");
    fate_ = [](const std::string&) { return Fate::arrives; };
    EXPECT_NE(wait_for_end().find("stop_requested"), std::string::npos);
    EXPECT_FALSE(printing_);
}

TEST_F(SecuredSessionTest, shouldNotBelieveAnAnswerThatWasNotAnnounced) {
    fate_ = [](const std::string&) { return Fate::unannounced; };
    host_.connect();
    const std::string frames = answer_all();
    EXPECT_EQ(frames, "^0?RS\n");
    EXPECT_EQ(host_.session.feeder().phase(), feeder::Phase::identifying);
    EXPECT_EQ(host_.session.statistics().frames_unexpected, 1U);
}

TEST_F(SecuredSessionTest, shouldAskAgainWhenAnAnswerIsDamaged) {
    int damaged = 1;
    fate_ = [&](const std::string& frame) {
        return frame == "^0?RS" && damaged-- > 0 ? Fate::answer_damaged : Fate::arrives;
    };
    host_.connect();
    static_cast<void>(answer_all());
    host_.wait(milliseconds{500});
    const std::string frames = answer_all();
    EXPECT_EQ(frames.substr(0, 12), "^0?DS\n^0?RS\n");
    EXPECT_NE(frames.find("^0?SM"), std::string::npos);
}

TEST_F(SecuredSessionTest, shouldStopBeforeAnUnprovenRecord) {
    fate_ = [](const std::string& frame) { return frame.starts_with("^0=MR40\t") ? Fate::unannounced : Fate::arrives; };
    arm(records);
    static_cast<void>(answer_all());
    ASSERT_EQ(last_, 40U);
    const std::string story = wait_for_end();
    EXPECT_NE(story.find("line_noise"), std::string::npos) << story;
    EXPECT_EQ(frames_.find("^0=MR41"), std::string::npos) << frames_;
    EXPECT_EQ(frames_.find("^0!GO"), std::string::npos) << frames_;
    EXPECT_NE(frames_.find("^0!FF"), std::string::npos) << frames_;
}

TEST_F(SecuredSessionTest, shouldDoubtAnUnprovenRecordThatIsPrinted) {
    fate_ = [this](const std::string& frame) {
        return frame.starts_with("^0=MR") && printing_ ? Fate::unannounced : Fate::arrives;
    };
    pages_ = make_pages(1, 400, 100, plain_text);
    arm(400);
    for (int i = 0; i < 2000 && last_ <= 256; ++i) {
        static_cast<void>(answer_all());
        printed_ = printing_ ? 200 : 0;
        host_.wake();
    }
    static_cast<void>(answer_all());
    ASSERT_EQ(last_, 257U);
    printed_ = 257; // the FIFO was all but empty
    const std::string story = wait_for_end();
    EXPECT_NE(story.find("line_noise"), std::string::npos) << story;
    EXPECT_NE(story.find("in doubt 257-257"), std::string::npos) << story;
}

} // namespace
} // namespace linefeed::session
