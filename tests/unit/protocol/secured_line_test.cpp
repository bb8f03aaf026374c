// One secured frame at a time: what the printer says of it, and what its silence means.
#include "protocol/crc32.hpp"
#include "protocol/secured_line.hpp"

#include <gtest/gtest.h>

namespace linefeed::protocol {
namespace {

using Step = SecuredLine::Step;
using Kind = SecuredLine::Kind;
using std::chrono::seconds;

class SecuredLineTest : public testing::Test {
protected:
    /// Begins with the next frame and sends it.
    std::string begin() {
        const SecuredLine::Frame* const frame = line_.begin();
        if (frame == nullptr) {
            return "nothing";
        }
        if (frame->kind == Kind::record) {
            line_.set_record("^0=MR" + std::to_string(frame->number.value()) + "\tx\r");
        }
        return send();
    }
    /// What is sent, without its announcement.
    std::string send() {
        const std::string_view bytes = line_.announced(now_);
        const std::size_t end = bytes.find('\r');
        const std::string_view frame = bytes.substr(end + 1);
        EXPECT_EQ(bytes.substr(0, end), "^0=NR" + std::to_string(protocol::crc32(frame.substr(0, frame.size() - 1))));
        return std::string{frame.substr(0, frame.size() - 1)};
    }
    Step silence() {
        now_ += seconds{3};
        return line_.on_time(now_);
    }
    /// After a silence the printer answers the inquiry that is put in between. The word on the frame before may come
    /// as late as that.
    Step answer_sync() {
        EXPECT_EQ(silence(), Step::send);
        const auto code = protocol::parameter_from_code(send().substr(3, 2));
        EXPECT_EQ(line_.on_right(now_), Step::wait);
        return line_.on_answer(code.value(), now_);
    }
    void add(Kind kind, std::string bytes, Parameter what = Parameter::SM) {
        line_.add({.kind = kind, .what = what, .bytes = std::move(bytes)});
    }
    void add_records(std::uint32_t first, std::uint32_t last) {
        line_.add_records(RecordRange::closed(RecordNumber{first}, RecordNumber{last}));
    }

    SecuredLine line_{{.bytes_per_second = 11520, .crc = true}};
    Instant now_{seconds{1}};
};

TEST_F(SecuredLineTest, shouldSendTheManualsExample) {
    add(Kind::inquiry, "^0?JL\r", Parameter::JL);
    ASSERT_NE(line_.begin(), nullptr);
    EXPECT_EQ(line_.announced(now_), "^0=NR3957421711\r^0?JL\r");
}

TEST_F(SecuredLineTest, shouldSendOneFrameAfterTheOther) {
    add_records(5, 6);
    add(Kind::command, "^0!GO\r");
    add_records(7, 7);
    EXPECT_EQ(begin(), "^0=MR5\tx");
    EXPECT_EQ(begin(), "nothing") << "the first has not been answered";
    EXPECT_EQ(line_.on_right(now_), Step::next);
    EXPECT_EQ(begin(), "^0=MR6\tx");
    EXPECT_EQ(line_.on_right(now_), Step::next);
    EXPECT_EQ(begin(), "^0!GO");
    EXPECT_EQ(line_.first_waiting(), RecordNumber{7});
    EXPECT_EQ(line_.on_right(now_), Step::next);
    EXPECT_EQ(begin(), "^0=MR7\tx");
    EXPECT_EQ(line_.on_right(now_), Step::next);
    EXPECT_TRUE(line_.idle());
}

TEST_F(SecuredLineTest, shouldRepeatWhatThePrinterRefuses) {
    add_records(5, 5);
    EXPECT_EQ(begin(), "^0=MR5\tx");
    EXPECT_EQ(line_.on_refused(), Step::send);
    EXPECT_EQ(send(), "^0=MR5\tx");
    EXPECT_EQ(line_.on_right(now_), Step::next);
}

TEST_F(SecuredLineTest, shouldNotHeedWhatBelongsToNothing) {
    EXPECT_EQ(line_.on_right(now_), Step::wait);
    EXPECT_EQ(line_.on_refused(), Step::wait);
    EXPECT_EQ(line_.on_answer(Parameter::SM, now_), Step::wait);
    line_.on_echo("^0=MR5\tx");
    EXPECT_EQ(silence(), Step::wait);
    add_records(5, 5);
    EXPECT_FALSE(line_.idle());
    static_cast<void>(begin());
    EXPECT_EQ(line_.on_answer(Parameter::SM, now_), Step::wait);
    line_.on_echo("^0=MR5");
    EXPECT_EQ(silence(), Step::unproven);
}

TEST_F(SecuredLineTest, shouldGiveUpWhatIsRefusedAgainAndAgain) {
    add(Kind::inquiry, "^0?SM\r");
    add(Kind::command, "^0!GO\r");
    for (const Step last : {Step::lost, Step::next}) {
        static_cast<void>(begin());
        Step step = line_.on_refused();
        for (; step == Step::send; step = line_.on_refused()) {
            static_cast<void>(send());
        }
        EXPECT_EQ(step, last);
    }
}

TEST_F(SecuredLineTest, shouldGiveUpWhatIsLostAgainAndAgain) {
    add(Kind::inquiry, "^0?SM\r");
    add(Kind::command, "^0!GO\r");
    for (const Step last : {Step::lost, Step::next}) {
        const std::string frame = begin();
        int repeats = 0;
        Step step = silence();
        for (; step == Step::send; step = silence()) {
            const auto code = protocol::parameter_from_code(send().substr(3, 2));
            ASSERT_EQ(line_.on_answer(*code, now_), Step::send);
            EXPECT_EQ(send(), frame);
            ++repeats;
        }
        EXPECT_EQ(step, last);
        EXPECT_EQ(repeats, 7);
    }
}

TEST_F(SecuredLineTest, shouldGiveACommandUpWhenNothingIsAnswered) {
    add(Kind::command, "^0!GO\r");
    static_cast<void>(begin());
    Step step = silence();
    for (; step == Step::send; step = silence()) {
        static_cast<void>(send());
    }
    EXPECT_EQ(step, Step::next);
    EXPECT_FALSE(line_.busy());
}

TEST_F(SecuredLineTest, shouldSendOnlyCommandsInTheEnd) {
    add_records(5, 6);
    add(Kind::inquiry, "^0?SM\r");
    add(Kind::command, "^0!ST\r");
    line_.drop_records();
    EXPECT_EQ(line_.drop_inquiry(), Parameter::SM);
    EXPECT_EQ(line_.drop_inquiry(), std::nullopt);
    EXPECT_EQ(begin(), "^0!ST");
    EXPECT_EQ(line_.on_right(now_), Step::next);
    EXPECT_EQ(begin(), "nothing");
}

TEST_F(SecuredLineTest, shouldNotRepeatForEver) {
    add_records(5, 5);
    static_cast<void>(begin());
    int repeats = 0;
    while (line_.on_refused() == Step::send) {
        static_cast<void>(send());
        ++repeats;
    }
    EXPECT_EQ(repeats, 7);
    EXPECT_FALSE(line_.busy());
}

TEST_F(SecuredLineTest, shouldNeverRepeatARecordOfWhichNothingIsKnown) {
    add_records(5, 6);
    static_cast<void>(begin());
    EXPECT_EQ(silence(), Step::unproven);
    EXPECT_EQ(line_.current().number, RecordNumber{5});
    line_.drop_records();
    EXPECT_EQ(begin(), "nothing");
    EXPECT_TRUE(line_.idle());
}

/// The word on the record may come as late as it likes: what is said first behind it proves nothing.
TEST_F(SecuredLineTest, shouldNotTakeALateWordForThatOnTheStop) {
    add_records(5, 6);
    static_cast<void>(begin());
    EXPECT_EQ(silence(), Step::unproven);
    line_.drop_records();
    add(Kind::command, "^0!ST\r");
    EXPECT_EQ(begin(), "^0!ST") << "at once";
    EXPECT_EQ(line_.on_right(now_), Step::send) << "perhaps the record's";
    const auto first = protocol::parameter_from_code(send().substr(3, 2));
    EXPECT_EQ(line_.on_refused(), Step::send) << "of whichever frame";
    const auto second = protocol::parameter_from_code(send().substr(3, 2));
    EXPECT_EQ(line_.on_right(now_), Step::wait);
    EXPECT_EQ(line_.on_answer(first.value(), now_), Step::wait) << "the word on the second is still to come";
    EXPECT_EQ(line_.on_answer(second.value(), now_), Step::send);
    EXPECT_EQ(send(), "^0!ST") << "for the first one may have been refused";
    EXPECT_EQ(line_.on_right(now_), Step::next);
    EXPECT_TRUE(line_.proven());
}

TEST_F(SecuredLineTest, shouldSendNothingButCommandsBeforeALateWordHasComeOrCannotCome) {
    add_records(5, 5);
    static_cast<void>(begin());
    EXPECT_EQ(silence(), Step::unproven);
    EXPECT_FALSE(line_.proven());
    add(Kind::once, "^0!EQ\r");
    add(Kind::inquiry, "^0?SM\r");
    const std::string sync = begin();
    EXPECT_EQ(sync.substr(0, 3), "^0?");
    EXPECT_EQ(line_.on_right(now_), Step::wait);
    EXPECT_EQ(line_.on_answer(protocol::parameter_from_code(sync.substr(3, 2)).value(), now_), Step::send);
    EXPECT_EQ(send(), "^0!EQ");
    EXPECT_EQ(line_.on_right(now_), Step::next);
    EXPECT_TRUE(line_.proven());
    EXPECT_EQ(begin(), "^0?SM") << "in step again";
}

TEST_F(SecuredLineTest, shouldNeverCallARecordDeliveredThatHasNotGoneOut) {
    add(Kind::command, "^0!GO\r");
    add_records(5, 5);
    static_cast<void>(begin());
    Step step = silence();
    for (; step == Step::send; step = silence()) {
        static_cast<void>(send());
    }
    EXPECT_EQ(step, Step::next);
    EXPECT_EQ(begin().substr(0, 3), "^0?");
    for (step = silence(); step == Step::send; step = silence()) {
        EXPECT_EQ(send().substr(0, 3), "^0?");
    }
    EXPECT_EQ(step, Step::unproven);
}

TEST_F(SecuredLineTest, shouldTakeTheEchoForProof) {
    add_records(5, 6);
    static_cast<void>(begin());
    line_.on_echo("^0=MR5\ty");
    line_.on_echo("^0=MR5\tx");
    line_.on_echo("^0=MR5\ty");
    EXPECT_EQ(answer_sync(), Step::next);
    EXPECT_TRUE(line_.proven());
    static_cast<void>(begin());
    line_.on_echo("^0=MR5\tx");
    EXPECT_EQ(silence(), Step::unproven) << "that was the one before";
}

/// The echo says that it has come, and then something is refused: perhaps the inquiry, perhaps the record, late.
TEST_F(SecuredLineTest, shouldNeverSendARecordTwiceThatMayHaveBeenTaken) {
    add_records(5, 5);
    static_cast<void>(begin());
    line_.on_echo("^0=MR5\tx");
    EXPECT_EQ(silence(), Step::send);
    const std::string sync = send();
    EXPECT_EQ(line_.on_refused(), Step::send);
    const std::string second = send();
    EXPECT_NE(second, sync);
    EXPECT_EQ(line_.on_answer(protocol::parameter_from_code(second.substr(3, 2)).value(), now_), Step::unproven);
    EXPECT_FALSE(line_.proven());
}

TEST_F(SecuredLineTest, shouldWaitForTheAnswerOfAnInquiry) {
    add(Kind::inquiry, "^0?SM\r");
    static_cast<void>(begin());
    EXPECT_EQ(line_.on_right(now_), Step::wait);
    EXPECT_EQ(line_.on_answer(Parameter::RS, now_), Step::wait);
    EXPECT_EQ(line_.on_answer(Parameter::SM, now_), Step::next);
    EXPECT_EQ(line_.on_answer(Parameter::SM, now_), Step::wait) << "nobody asked";
}

TEST_F(SecuredLineTest, shouldAskAgainOnlyWhenNoAnswerCanBeOnItsWay) {
    add(Kind::inquiry, "^0?SM\r");
    static_cast<void>(begin());
    EXPECT_EQ(silence(), Step::send);
    const std::string first = send();
    EXPECT_NE(first, "^0?SM");
    EXPECT_EQ(line_.on_answer(Parameter::SM, now_), Step::wait) << "late: it is not the one that will be asked for";
    EXPECT_EQ(silence(), Step::send);
    const std::string second = send();
    EXPECT_NE(second, first) << "an answer to the first could be on its way, too";
    const auto code = protocol::parameter_from_code(second.substr(3, 2));
    ASSERT_TRUE(code);
    EXPECT_EQ(line_.on_answer(*code, now_), Step::send);
    EXPECT_EQ(send(), "^0?SM");
    EXPECT_EQ(line_.on_answer(Parameter::SM, now_), Step::next);
}

/// Its answers come after 350 ms: too late for the first, but not for ever.
TEST_F(SecuredLineTest, shouldGetUsedToAPrinterThatIsSlowToAnswer) {
    constexpr Duration slow = std::chrono::milliseconds{350};
    add(Kind::inquiry, "^0?SM\r");
    static_cast<void>(begin());
    EXPECT_EQ(line_.on_time(now_ += slow), Step::send);
    static_cast<void>(send());
    EXPECT_EQ(line_.on_time(now_ += slow), Step::send);
    const auto code = protocol::parameter_from_code(send().substr(3, 2));
    EXPECT_EQ(line_.on_time(now_ += slow), Step::wait);
    EXPECT_EQ(line_.on_answer(code.value(), now_), Step::send);
    static_cast<void>(send());
    EXPECT_EQ(line_.on_time(now_ += slow), Step::wait);
    EXPECT_EQ(line_.on_answer(Parameter::SM, now_), Step::next);
    add(Kind::inquiry, "^0?SM\r");
    static_cast<void>(begin());
    EXPECT_EQ(line_.on_time(now_ += slow), Step::wait) << "it does not forget so soon";
}

/// Where answers get lost, but are quick otherwise, it waits no longer than before.
TEST_F(SecuredLineTest, shouldGetUsedToAPrinterThatIsQuickAgain) {
    add(Kind::inquiry, "^0?SM\r");
    static_cast<void>(begin());
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(silence(), Step::send);
        static_cast<void>(send());
    }
    const Instant sent = now_;
    EXPECT_GT(*line_.deadline(), sent + std::chrono::milliseconds{500});
    EXPECT_EQ(silence(), Step::send);
    const auto code = protocol::parameter_from_code(send().substr(3, 2));
    EXPECT_EQ(line_.on_answer(code.value(), now_ += std::chrono::milliseconds{20}), Step::send);
    static_cast<void>(send());
    EXPECT_LT(*line_.deadline(), now_ + std::chrono::milliseconds{250});
}

/// A picture is worked out when it is asked for.
TEST_F(SecuredLineTest, shouldGiveThePrinterTimeForAnAnswerOnceItHasTheInquiry) {
    SecuredLine patient{{.crc = true, .answer_takes = seconds{2}}};
    patient.add({.kind = Kind::inquiry, .what = Parameter::GW, .bytes = "^0?GW\r"});
    static_cast<void>(patient.begin());
    static_cast<void>(patient.announced(now_));
    EXPECT_EQ(patient.on_right(now_), Step::wait);
    EXPECT_EQ(patient.on_time(now_ + seconds{1}), Step::wait);
    EXPECT_EQ(patient.on_answer(Parameter::GW, now_ + seconds{1}), Step::next);
}

TEST_F(SecuredLineTest, shouldNeverPutTheSameInquiryInBetween) {
    for (int i = 0; i < 6; ++i) {
        add(Kind::inquiry, "^0?DS\r", Parameter::DS);
        static_cast<void>(begin());
        EXPECT_EQ(silence(), Step::send);
        const std::string sync = send();
        EXPECT_NE(sync, "^0?DS");
        EXPECT_EQ(line_.on_answer(protocol::parameter_from_code(sync.substr(3, 2)).value(), now_), Step::send);
        EXPECT_EQ(send(), "^0?DS");
        EXPECT_EQ(line_.on_answer(Parameter::DS, now_), Step::next);
    }
}

TEST_F(SecuredLineTest, shouldGiveAnInquiryUp) {
    add(Kind::inquiry, "^0?SM\r");
    static_cast<void>(begin());
    int sent = 0;
    Step step = silence();
    for (; step == Step::send && sent < 100; step = silence()) {
        static_cast<void>(send());
        ++sent;
    }
    EXPECT_EQ(step, Step::lost);
    EXPECT_EQ(sent, 5);
}

TEST_F(SecuredLineTest, shouldRepeatACommandButNotWhatMustHappenOnce) {
    add(Kind::command, "^0!ST\r");
    add(Kind::once, "^0!EQ\r");
    static_cast<void>(begin());
    EXPECT_EQ(silence(), Step::send);
    const auto code = protocol::parameter_from_code(send().substr(3, 2));
    EXPECT_EQ(line_.on_answer(*code, now_), Step::send);
    EXPECT_EQ(send(), "^0!ST");
    EXPECT_EQ(line_.on_right(now_), Step::next);
    EXPECT_EQ(begin(), "^0!EQ");
    EXPECT_EQ(answer_sync(), Step::next);
    EXPECT_FALSE(line_.proven());
    EXPECT_TRUE(line_.idle());
}

TEST_F(SecuredLineTest, shouldWaitAsLongAsTheBytesTake) {
    SecuredLine slow{{.bytes_per_second = 120, .crc = true}};
    slow.add({.kind = Kind::command, .bytes = "^0=ET" + std::string(1000, 'x') + "\r"});
    static_cast<void>(slow.begin());
    static_cast<void>(slow.announced(now_));
    EXPECT_EQ(slow.on_time(now_ + seconds{8}), Step::wait);
    EXPECT_GT(*slow.deadline(), now_ + seconds{8});
    EXPECT_LT(*slow.deadline(), now_ + seconds{11});
}

} // namespace
} // namespace linefeed::protocol
