// One conversation: answers matched with inquiries, time-outs, damage, slow writes, pages, and the farewell.
#include "conversation.hpp"
#include "session/line_fit.hpp"

namespace linefeed::session {
namespace {

using feeder::OutcomeCode;
using std::chrono::milliseconds;
using std::chrono::seconds;

const std::string not_printing = "^0=RS2\t5\t0\t0\t0\t0\r";
const std::string identity = "^0=VS1\t1\t1\t1\t1\t1\t1\t1\t1\t1\tS1\r^0=JLA\r";
const std::string printing = "^0=RS2\t6\t0\t0\t0\t0\r";

std::string mail(std::uint32_t entries, std::uint32_t last_printed, std::uint32_t stop_at) {
    return "^0=SM256\t" + std::to_string(entries) + "\t" + std::to_string(last_printed) + "\t" +
           std::to_string(stop_at) + "\t1\r";
}

std::vector<std::unique_ptr<RecordPage>> thousand_records() {
    return make_pages(1, 1000, 100, plain_text);
}

TEST(Session, shouldIgnoreAnswersThatNobodyAskedFor) {
    Conversation host;
    host.connect();
    host.sent();
    host.receive(
        mail(0, 5, 0) +
        "^0=CC1\t2\t3\r^0=VS1\r^0=JLA\r^0=XX1\r^0!GO\r^0?RS\r^0*LINE\r^0$FT1\r^0=MR1\tA\r^1=RS2\t5\t0\t0\t0\r");
    EXPECT_EQ(host.sent(), "");
    EXPECT_EQ(host.session.statistics().frames_received, 11U);
    EXPECT_EQ(host.session.statistics().frames_unexpected, 11U);
    EXPECT_EQ(host.session.statistics().bytes_damaged, 0U);
    host.receive(not_printing);
    EXPECT_EQ(host.sent(), "^0?VS\n^0?JL\n");
    host.receive(not_printing); // it was answered already
    EXPECT_EQ(host.sent(), "");
}

TEST(Session, shouldCountWhatIsDamaged) {
    Conversation host;
    host.connect();
    host.sent();
    host.receive("noise^Z^0=RSx\t5\r^0=RS2\t5^0=RS");
    EXPECT_EQ(host.sent(), "");
    EXPECT_GE(host.session.statistics().bytes_damaged, 5U + 1U + 5U);
    EXPECT_FALSE(host.ended);
    host.receive("2\t5\t0\t0\t0\t0\r"); // the inquiry still waits for an answer that can be read
    EXPECT_EQ(host.sent(), "^0?VS\n^0?JL\n");
}

TEST(Session, shouldNotTakeATruncatedAnswer) {
    Conversation host;
    host.connect();
    host.sent();
    host.receive("^0=RS2\t5\t0\t0\t0\t" + std::string(10000, '1') + "\r");
    EXPECT_EQ(host.sent(), "");
    EXPECT_EQ(host.session.statistics().frames_unexpected, 1U);
}

TEST(Session, shouldEndWhenThePrinterDoesNotAnswer) {
    Conversation host;
    host.connect();
    EXPECT_EQ(host.session.next_wake(), host.now + seconds{2});
    host.wait(seconds{2} - milliseconds{1});
    EXPECT_FALSE(host.ended);
    host.wait(milliseconds{1});
    EXPECT_TRUE(host.closed);
    EXPECT_EQ(host.outcome.code, OutcomeCode::no_answer);
    EXPECT_EQ(host.story(), "end: no_answer (standby, error 0); close");
    EXPECT_EQ(host.session.next_wake(), std::nullopt);
}

TEST(Session, shouldGoOnWithoutTheAnswersThatAreNotNeeded) {
    Conversation host;
    host.connect();
    host.receive(not_printing);
    host.sent();
    host.wait(seconds{2}); // neither ?VS nor ?JL
    EXPECT_EQ(host.sent(), "^0?SM\n");
    host.receive(mail(0, 0, 0) + mail(0, 0, 0));
    EXPECT_EQ(host.sent(), "^0?SM\n^0?CC\n");
    host.receive("^0=VS1\t1\t1\t1\t1\t1\t1\t1\t1\t1\tS1\r"); // too late
    EXPECT_EQ(host.session.statistics().frames_unexpected, 1U);
    host.wait(seconds{2});
    EXPECT_EQ(host.sent(), "^0?CC\n"); // once more
    host.wait(seconds{2});
    EXPECT_EQ(host.story(), "begin run, last printed before 0");
}

TEST(Session, shouldStopALineThatDoesNotAnswerAnyMore) {
    const auto pages = thousand_records();
    Conversation host;
    host.print(pages);
    while (!host.ended) {
        host.wake();
    }
    EXPECT_EQ(host.outcome.code, OutcomeCode::no_answer);
    const std::string sent = host.sent();
    EXPECT_EQ(sent.substr(sent.size() - 6), "^0!ST\n");
    EXPECT_EQ(host.pages_released, pages.size());
}

/// Whatever it is asked meanwhile: the inquiries need not time out together.
TEST(Session, shouldNotWaitLongerForALineThatIsAskedAllTheTime) {
    const auto pages = thousand_records();
    Conversation host;
    host.print(pages);
    Instant heard = host.now;
    for (int i = 0; i < 400; ++i) {
        host.wait(milliseconds{1});
        const std::string sent = host.sent();
        for (auto at = sent.find('?'); at != std::string::npos; at = sent.find('?', at + 1)) {
            host.receive(sent.substr(at + 1, 2) == "RS" ? printing : mail(255, 0, 1000));
            heard = host.now;
        }
    }
    while (!host.ended && host.now < heard + seconds{10}) {
        host.wake();
    }
    EXPECT_EQ(host.outcome.code, OutcomeCode::no_answer);
    EXPECT_LE(host.now - heard, milliseconds{2010});
}

/// On a serial line there is one inquiry of a kind at a time: noise that takes one answer of each makes no silence.
TEST(Session, shouldOutliveTheLossOfOneAnswerOfEachKindOnASerialLine) {
    const auto pages = thousand_records();
    SessionSettings settings;
    settings.line.bytes_per_second = 11520;
    fit_to_line(settings, 20);
    Conversation host{settings};
    std::uint32_t sent_through = 0;
    std::string stop_at = "0";
    bool started = false;
    std::string lost; // kinds of inquiry whose next answer is lost
    const auto answer = [&] {
        std::istringstream frames{host.sent()};
        for (std::string frame; std::getline(frames, frame);) {
            const std::string what = frame.substr(2, 3);
            if (const auto hit = lost.find(what); hit != std::string::npos) {
                lost.erase(hit, what.size());
            } else if (what == "?RS") {
                host.receive(started ? printing : not_printing);
            } else if (what == "?VS") {
                host.receive("^0=VS1\t1\t1\t1\t1\t1\t1\t1\t1\t1\tS1\r");
            } else if (what == "?JL") {
                host.receive("^0=JLA\r");
            } else if (what == "?CC") {
                host.receive("^0=CC0\t0\t1000\r");
            } else if (what == "?SM") {
                host.receive(
                    mail(sent_through > 0 ? sent_through - 1 : 0, 0, static_cast<std::uint32_t>(std::stoul(stop_at))));
            } else if (what == "=CM") {
                stop_at = frame.substr(5);
            } else if (what == "=MR") {
                sent_through = static_cast<std::uint32_t>(std::stoul(frame.substr(5)));
            } else {
                started = started || what == "!GO";
            }
        }
    };
    const auto pass = [&](seconds time) {
        for (const Instant end = host.now + time; host.now < end && !host.ended;) {
            host.wait(milliseconds{1});
            answer();
        }
    };
    host.connect();
    pass(seconds{1});
    host.grant(1, 1000);
    pass(seconds{1});
    for (const auto& page : pages) {
        host.page(*page);
    }
    pass(seconds{5});
    ASSERT_EQ(host.session.feeder().phase(), feeder::Phase::printing) << host.story();
    lost = "?SM?RS";
    pass(seconds{2});
    ASSERT_EQ(lost, "");
    pass(seconds{8});
    EXPECT_FALSE(host.ended);
}

/// On a serial line an answer may be damaged: that stops nothing.
TEST(Session, shouldAskAgainWhenAnAnswerIsLost) {
    Conversation host;
    host.connect();
    host.wait(seconds{1});
    host.receive("^0=RS5\r"); // a part of it
    host.sent();
    host.wait(seconds{1});
    EXPECT_EQ(host.sent(), "^0?RS\n");
    EXPECT_FALSE(host.ended);
}

/// Answers come in the order of the inquiries: a `=RS` shows that the `=SM` before it will not come any more.
/// Nobody knows whether a machine in such a state prints; at the start it is told.
TEST(Session, shouldNotBelieveAStateThatTheManualDoesNotNameWhileItPrints) {
    const auto pages = make_pages(1, 3, 3, plain_text);
    Conversation host;
    host.print(pages);
    const auto before = host.session.statistics().frames_unexpected;
    host.receive("^0=RS2\t7\t0\t0\t0\t0\r");
    EXPECT_EQ(host.session.feeder().phase(), feeder::Phase::printing);
    EXPECT_EQ(host.session.statistics().frames_unexpected, before + 1);
    Conversation start;
    start.connect();
    for (int i = 0; i < 4; ++i) {
        start.receive("^0=RS2\t7\t0\t0\t0\t0\r");
    }
    EXPECT_NE(start.story().find("not_ready (unknown"), std::string::npos);
}

TEST(Session, shouldForgetTheInquiriesBeforeAnAnsweredStatus) {
    const auto pages = thousand_records();
    Conversation host;
    host.print(pages);
    std::string asked;
    while (asked.find("^0?RS") == std::string::npos) {
        host.wake();
        asked += host.sent();
    }
    const auto under_way = std::ranges::count(asked, 'M');
    EXPECT_GT(under_way, 1);
    host.receive(printing);
    for (auto polls = under_way; polls > 0; --polls) {
        host.wake(); // all of them may be under way again
    }
    asked = host.sent();
    EXPECT_GE(std::ranges::count(asked, 'M'), under_way - 1);
    EXPECT_FALSE(host.ended);
}

TEST(Session, shouldAnswerEachInquiryOnceInOrder) {
    const auto pages = thousand_records();
    Conversation host;
    host.print(pages);
    host.receive(mail(255, 0, 1000));
    host.wake();
    host.wake();
    EXPECT_EQ(host.sent(), "^0?SM\n^0?SM\n");
    host.now += milliseconds{20}; // or the numbers would leap
    host.receive(mail(239, 16, 1000) + mail(235, 20, 1000) + mail(200, 255, 1000));
    EXPECT_EQ(host.story(), "printed through 16; printed through 20");
    EXPECT_EQ(host.session.statistics().frames_unexpected, 1U);
    EXPECT_EQ(host.session.feeder().refill().printed_through(), RecordNumber{20});
}

TEST(Session, shouldGatherWhatComesWhileAWriteIsUnderWay) {
    const auto pages = thousand_records();
    Conversation host;
    host.print(pages);
    host.writes_complete_at_once = false;
    host.writes = 0;
    host.now += milliseconds{20}; // or the numbers would leap
    host.receive(mail(239, 16, 1000));
    const std::string refill = host.sent();
    EXPECT_EQ(refill.substr(0, refill.find('\n') + 1), "^0=MR257\trecord 257\n");
    EXPECT_EQ(host.writes, 1U);
    host.wake(); // the next ?SM waits for the write
    EXPECT_EQ(host.sent(), "");
    host.stop();
    EXPECT_EQ(host.sent(), "");
    host.written();
    EXPECT_EQ(host.sent(), "^0?SM\n^0!ST\n^0?RS\n");
    EXPECT_EQ(host.writes, 2U);
}

TEST(Session, shouldTellWhenRecordsWereAllowedAndWhenTheyWereWritten) {
    const auto pages = thousand_records();
    Conversation host;
    host.print(pages);
    EXPECT_EQ(host.records_written.size(), 1U); // the fill
    host.records_written.clear();
    host.writes_complete_at_once = false;
    std::vector<Instant> answered;
    for (const std::uint32_t printed : {16U, 32U, 48U}) {
        host.now += milliseconds{20};
        host.wake();
        answered.push_back(host.now);
        host.receive(mail(255 - printed, printed, 1000));
    }
    EXPECT_TRUE(host.records_written.empty());
    host.now += milliseconds{1};
    const Instant first_written = host.now;
    host.written(); // an inquiry went first
    host.now += milliseconds{1};
    host.written();
    using Written = std::vector<RecordsWritten>;
    const auto numbers = [](std::uint32_t first, std::uint32_t last) {
        return RecordRange::closed(RecordNumber{first}, RecordNumber{last});
    };
    EXPECT_EQ(host.records_written, (Written{{numbers(257, 304), answered[0], first_written + milliseconds{1}}}));
    EXPECT_EQ(host.sent().find("^0=MR305"), std::string::npos);
}

/// Tells what it sees as lines, `<` from the printer and `>` to it.
class Watching : public FrameObserver {
public:
    void on_frame_received(std::string_view frame, Instant at) override { tell("< ", frame, at); }
    void on_damage_received(std::uint64_t bytes, Instant at) override { tell("< damaged ", std::to_string(bytes), at); }
    void on_command_sent(std::string_view frame, Instant at) override {
        EXPECT_EQ(frame.back(), '\r');
        tell("> ", frame.substr(0, frame.size() - 1), at);
    }
    void on_records_sent(RecordRange records, std::string_view first, std::size_t bytes, Instant at) override {
        EXPECT_EQ(first.back(), '\r');
        std::ostringstream told;
        told << records << ", " << bytes << " bytes: " << first.substr(0, first.size() - 1);
        tell("> ", told.str(), at);
    }
    std::string story() { return std::exchange(story_, {}); }
    Instant last_at{};

private:
    void tell(std::string_view what, std::string_view text, Instant at) {
        (story_ += what) += std::string{text} + "\n";
        last_at = at;
    }
    std::string story_;
};

TEST(Session, shouldShowEveryFrameInItsOrder) {
    const auto pages = make_pages(1, 1000, 100, plain_text);
    Watching frames;
    Conversation host{{}, {}, &frames};
    host.print(pages);
    EXPECT_NE(frames.story().find("> ^0=CM1000\n> ^0?SM\n"), std::string::npos);
    host.now += seconds{1}; // or the numbers would leap
    host.receive("x" + mail(156, 99, 1000) + "^0=XX1\r");
    // Those of two pages are one.
    EXPECT_EQ(frames.story(), "< damaged 1\n< ^0=SM256\t156\t99\t1000\t1\n> 257-355, 1980 bytes: ^0=MR257\trecord "
                              "257\n< ^0=XX1\n");
    EXPECT_EQ(frames.last_at, host.now);
}

TEST(Session, shouldGiveAPageBackOnlyWhenItIsWritten) {
    const auto pages = thousand_records();
    Conversation host;
    host.print(pages);
    EXPECT_EQ(host.pages_released, 2U); // 1-100 and 101-200 went out with the first fill
    host.writes_complete_at_once = false;
    host.receive(mail(199, 56, 1000)); // 257-312
    EXPECT_EQ(host.pages_released, 2U) << "its bytes are being written";
    host.written();
    EXPECT_EQ(host.pages_released, 3U);
}

TEST(Session, shouldTakePagesThatComeBeforeTheGrant) {
    const auto pages = make_pages(1, 10, 10, plain_text);
    Conversation host;
    host.connect();
    host.receive(not_printing);
    host.page(*pages[0]);
    host.receive(identity + mail(0, 0, 0) + mail(0, 0, 0) + "^0=CC0\t0\t0\r");
    host.grant(1, 10);
    host.receive(mail(0, 0, 0) + mail(0, 0, 10));
    const std::string sent = host.sent();
    EXPECT_NE(sent.find("^0=MR10\trecord 10\n^0?SM\n"), std::string::npos);
}

TEST(Session, shouldTakeAGrantThatComesBehindTheEnd) {
    const auto pages = make_pages(1, 10, 10, plain_text);
    Conversation host;
    host.connect();
    host.receive(not_printing + identity + mail(0, 0, 0) + mail(0, 0, 0) + "^0=CC0\t0\t0\r");
    host.writes_complete_at_once = false;
    host.page(*pages[0]);
    host.stop();
    host.sent();
    host.grant(1, 10);
    EXPECT_EQ(host.sent(), "");
    EXPECT_EQ(host.pages_released, pages.size());
}

TEST(Session, shouldEndWhenTheLedgerRefuses) {
    Conversation host;
    host.connect();
    host.receive(not_printing + identity + mail(0, 0, 0) + mail(0, 0, 0) + "^0=CC0\t0\t0\r");
    host.story();
    host.refuse(OutcomeCode::nothing_to_print);
    EXPECT_EQ(host.story(), "end: nothing_to_print (ready for print start, error 0); close");
}

TEST(Session, shouldFlushAndEndWhenTheLedgerHasTheTruth) {
    const auto pages = thousand_records();
    Conversation host;
    host.print(pages);
    host.stop();
    host.receive(not_printing + not_printing);
    // One of these answers belongs to the inquiry from before the stop.
    host.receive(mail(0, 3, 0) + mail(0, 3, 0) + mail(0, 3, 0) + "^0=CC0\t0\t1003\r");
    EXPECT_EQ(host.story(), "settle this run so far: printed 1-3 by mail status and total print counter");
    host.sent();
    host.settled();
    EXPECT_EQ(host.sent(), "^0!FF\n^0?RS\n");
    host.receive(not_printing);
    EXPECT_EQ(host.sent(), "^0?SM\n");
    host.receive(mail(0, 3, 0));
    EXPECT_EQ(host.sent(), "^0?SM\n");
    host.receive(mail(0, 3, 0));
    EXPECT_EQ(host.sent(), "^0?CC\n");
    host.receive("^0=CC0\t0\t1003\r");
    EXPECT_EQ(host.story().substr(0, 123),
              "settle this run: printed none, in doubt none, unused 4-256 by mail status and total print counter; "
              "release page 201; releas");
    EXPECT_EQ(host.outcome.code, OutcomeCode::stop_requested);
    EXPECT_EQ(host.pages_released, pages.size());
}

TEST(Session, shouldEndWhenTheLedgerFails) {
    Conversation host;
    host.connect();
    host.storage_failed();
    EXPECT_EQ(host.outcome.code, OutcomeCode::storage_failed);
    EXPECT_TRUE(host.closed);
}

TEST(Session, shouldEndWhenTheLinkIsLost) {
    const auto pages = thousand_records();
    Conversation host;
    host.print(pages);
    host.close();
    EXPECT_EQ(host.outcome.code, OutcomeCode::link_lost);
    EXPECT_TRUE(host.outcome.issued);
    EXPECT_EQ(host.sent(), "");
    EXPECT_EQ(host.pages_released, pages.size());
    EXPECT_EQ(host.session.next_wake(), std::nullopt);
    host.close(); // once is enough
    EXPECT_EQ(host.effects.size(), 0U);
}

TEST(Session, shouldDropAWriteUnderWayWhenTheLinkIsLost) {
    const auto pages = thousand_records();
    Conversation host;
    host.print(pages);
    host.writes_complete_at_once = false;
    host.receive(mail(239, 16, 1000));
    host.close();
    EXPECT_TRUE(host.closed);
    EXPECT_TRUE(host.session.pieces().empty());
    host.written(); // a completion that was on its way
    EXPECT_EQ(host.effects.size(), 0U);
}

TEST(Session, shouldWriteItsLastCommandsBeforeItEnds) {
    const auto pages = thousand_records();
    Conversation host;
    host.print(pages);
    host.writes_complete_at_once = false;
    host.receive(mail(239, 16, 1000)); // a refill is being written
    host.sent();
    while (!host.session.next_wake() || host.session.feeder().phase() != feeder::Phase::ended) {
        host.wake();
    }
    EXPECT_FALSE(host.ended) << "!ST waits for the write";
    EXPECT_EQ(host.sent(), "");
    host.written();
    const std::string sent = host.sent();
    EXPECT_EQ(sent.substr(sent.size() - 6), "^0!ST\n");
    EXPECT_FALSE(host.ended);
    host.written();
    EXPECT_TRUE(host.closed);
    EXPECT_EQ(host.outcome.code, OutcomeCode::no_answer);
}

TEST(Session, shouldEndWithoutItsLastCommandsWhenTheyCannotBeWritten) {
    const auto pages = thousand_records();
    Conversation host;
    host.print(pages);
    host.writes_complete_at_once = false;
    host.receive(mail(239, 16, 1000));
    while (host.session.feeder().phase() != feeder::Phase::ended) {
        host.wake();
    }
    const Instant ended = host.now;
    EXPECT_EQ(host.session.next_wake(), ended + seconds{1});
    host.wait(seconds{1} - milliseconds{1});
    EXPECT_FALSE(host.ended);
    host.receive(printing); // nobody listens any more
    host.wait(milliseconds{1});
    EXPECT_TRUE(host.closed);
    EXPECT_EQ(host.pages_released, pages.size());
    host.written();
    host.wait(seconds{10});
    EXPECT_EQ(host.effects.size(), 0U);
}

TEST(Session, shouldEndWhenTheLinkIsLostDuringTheFarewell) {
    const auto pages = thousand_records();
    Conversation host;
    host.print(pages);
    host.writes_complete_at_once = false;
    host.receive(mail(239, 16, 1000));
    while (host.session.feeder().phase() != feeder::Phase::ended) {
        host.wake();
    }
    host.close();
    EXPECT_TRUE(host.closed);
    EXPECT_EQ(host.outcome.code, OutcomeCode::no_answer);
}

TEST(Session, shouldGiveBackAPageThatComesTooLate) {
    const auto pages = make_pages(1, 20, 10, plain_text);
    Conversation host;
    host.print(pages);
    host.close();
    ASSERT_TRUE(host.closed);
    Effects effects;
    host.session.on_page(pages[0].get(), host.now, effects);
    ASSERT_EQ(effects.size(), 1U);
    EXPECT_EQ(std::get<ReleasePage>(effects[0]).page, pages[0].get());
}

TEST(Session, shouldKeepALatePageUntilTheFarewellIsOver) {
    const auto pages = thousand_records();
    const auto late = make_pages(1001, 1100, 100, plain_text);
    Conversation host;
    host.print(pages);
    host.writes_complete_at_once = false;
    host.receive(mail(239, 16, 1000));
    while (host.session.feeder().phase() != feeder::Phase::ended) {
        host.wake();
    }
    host.page(*late[0]);
    EXPECT_FALSE(host.ended);
    host.wait(seconds{1});
    EXPECT_EQ(host.pages_released, pages.size() + 1);
}

TEST(Session, shouldSendABlankEndMarkerWithTheFieldsOfTheRecords) {
    const auto pages = make_pages(1, 10, 10, plain_text);
    SessionSettings settings;
    settings.charsets.assign(3, protocol::Charset::latin1);
    Conversation host{settings};
    host.connect();
    host.receive(not_printing + identity + mail(0, 0, 0) + mail(0, 0, 0) + "^0=CC0\t0\t0\r");
    host.grant(1, 10);
    host.receive(mail(0, 0, 0) + mail(0, 0, 0) + mail(0, 0, 0));
    host.page(*pages[0]);
    host.receive(mail(9, 0, 0));
    host.wake(); // !GO
    host.receive(printing);
    for (int answers = 0; answers < 12; ++answers) {
        host.receive(mail(9, 0, 0));
        host.wake();
    }
    EXPECT_NE(host.sent().find("^0=MR11\t \t \t \n"), std::string::npos);
}

TEST(Session, shouldSpeakOfATakeover) {
    feeder::FeederPlan plan;
    plan.open = feeder::OpenRun{RecordNumber{1}, RecordNumber{0},  RecordNumber{100}, "", {},
                                RecordNumber{0}, RecordNumber{100}};
    plan.take_over = true;
    Conversation host{{}, plan};
    host.connect();
    host.receive(printing + identity + mail(3, 50, 100) + mail(3, 50, 100) + "^0=CC0\t0\t0\r" + mail(3, 50, 100) +
                 mail(3, 50, 100));
    EXPECT_EQ(host.story(), "adopt run, printed through 50, sent through 54");
}

/// The most that can gather behind a write that does not complete fits in the next.
TEST(Session, shouldBoundWhatGathersBehindAWrite) {
    const auto pages = make_pages(1, 4000, 16, plain_text); // pages far smaller than any real one
    Conversation host;
    std::size_t lent = 0;
    const auto lend = [&] {
        while (lent < pages.size() && host.pages_lent - host.pages_released < max_pages) {
            host.page(*pages[lent++]);
        }
    };
    host.connect();
    host.receive(not_printing + identity + mail(0, 0, 0) + mail(0, 0, 0) + "^0=CC0\t0\t0\r");
    host.grant(1, 4000);
    host.receive(mail(0, 0, 0) + mail(0, 0, 4000));
    lend();
    host.receive(mail(255, 0, 4000));
    host.wake(); // !GO
    host.receive(printing);
    lend();
    host.writes_complete_at_once = false;
    std::uint32_t printed = 0;
    for (int round = 0; round < 200 && !host.session.feeder().refill().all_sent(); ++round) {
        // Four inquiries are answered while one write is under way.
        for (int answers = 0; answers < 4 && printed < host.session.feeder().refill().sent_through().value();
             ++answers) {
            printed = std::min(printed + 60, host.session.feeder().refill().sent_through().value());
            host.receive(mail(0, printed, 4000));
            lend();
        }
        host.wake();
        host.written();
        host.written();
        lend();
    }
    EXPECT_GT(printed, 2000U);
    EXPECT_GT(host.largest_write, 10U);
    EXPECT_LE(host.largest_write, max_write_pieces);
}

} // namespace
} // namespace linefeed::session
