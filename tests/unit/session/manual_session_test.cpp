// The manual's own session (protocol, section 5) byte for byte: 100 000 last names, 22 117 of them printed before. The
// printer's answers are the manual's; where linefeed asks more than the manual does, they follow from them. However the
// answers are split, echoed, prefixed or padded, the host sends the same bytes.
#include "conversation.hpp"

#include <array>
#include <utility>

namespace linefeed::session {
namespace {

constexpr std::uint32_t first = 22118;
constexpr std::uint32_t last = 100000;

/// The names that the manual prints; the rest is made up.
std::string name_of(std::uint32_t number) {
    switch (number) {
    case 22118:
        return "Maier";
    case 22119:
        return "Mail\xE4nder";
    case 22120:
        return "Malasse";
    case 22121:
        return "Marin";
    case 22122:
        return "Marahrenz";
    case 22370:
        return "Michel";
    case 22373:
        return "Middelb\xFCscher";
    case 22374:
        return "Middeldorf";
    case 99997:
        return "Zimmerman";
    case 99998:
        return "Zinser";
    case 99999:
        return "Zupke";
    case 100000:
        return "Zwick";
    default:
        return "Name" + std::to_string(number);
    }
}

const std::vector<std::unique_ptr<RecordPage>>& all_pages() {
    static const auto pages = make_pages(first, last, 500, name_of);
    return pages;
}

/// How the printer's bytes arrive.
struct Wire {
    const char* name;
    std::size_t chunk = 0;      ///< bytes at a time; 0 = whole answers
    bool merged = false;        ///< all answers to one write in one piece
    bool line_feed = false;     ///< LF behind each CR
    bool length_prefix = false; ///< `!LN`
    bool echo = false;          ///< `!EM`
    std::size_t block = 0;      ///< `=FL`

    friend std::ostream& operator<<(std::ostream& out, const Wire& wire) { return out << wire.name; }
};

/// Talks to the session as the manual's printer did.
class ManualSession {
public:
    explicit ManualSession(const Wire& wire)
        : wire_(wire) {
        SessionSettings settings;
        settings.feeder.pacing.poll_min = std::chrono::milliseconds{23}; // a line of 2500 prints a second
        settings.feeder.pacing.poll_least = settings.feeder.pacing.poll_min;
        settings.feeder.pacing.unknown_rate = {};
        host_ = std::make_unique<Conversation>(settings);
    }

    Conversation& host() { return *host_; }
    std::string sent() {
        std::string text = host_->sent();
        transcript_ += text;
        return text;
    }
    const std::string& transcript() const { return transcript_; }

    void answer(const std::vector<std::string>& payloads) {
        std::string bytes;
        for (const std::string& payload : payloads) {
            std::string frame = echoes() + framed(payload);
            if (!wire_.merged) {
                deliver(frame);
            } else {
                bytes += frame;
            }
        }
        deliver(bytes);
    }

private:
    std::string framed(const std::string& payload) const {
        std::string frame = "^0";
        if (wire_.length_prefix) {
            const std::string length = std::to_string(payload.size() + 1);
            frame += std::string(5 - length.size(), '0') + length;
        }
        frame += payload + (wire_.line_feed ? "\r\n" : "\r");
        if (wire_.block > 0 && frame.size() % wire_.block > 0) {
            frame += std::string(wire_.block - frame.size() % wire_.block, ' ');
        }
        return frame;
    }
    /// What the printer sends back of what it got, at some place between its answers.
    std::string echoes() const {
        return wire_.echo ? framed("!GO") + framed("=CM100000") + framed("=MR22118\tMaier") + framed("=CC\t5")
                          : std::string{};
    }
    void deliver(const std::string& bytes) {
        const std::size_t chunk = wire_.chunk > 0 ? wire_.chunk : std::max<std::size_t>(1, bytes.size());
        for (std::size_t at = 0; at < bytes.size(); at += chunk) {
            host_->receive(std::string_view{bytes}.substr(at, chunk));
        }
    }

    Wire wire_;
    std::unique_ptr<Conversation> host_;
    std::string transcript_;
};

/// `=MR` frames with line ends for CR.
std::string records(std::uint32_t from, std::uint32_t to) {
    std::string text;
    for (std::uint32_t number = from; number <= to; ++number) {
        text += "^0=MR" + std::to_string(number) + "\t" + name_of(number) + "\n";
    }
    return text;
}

std::string mail(std::uint32_t entries, std::uint32_t last_printed, std::uint32_t stop_at = last) {
    return "=SM256\t" + std::to_string(entries) + "\t" + std::to_string(last_printed) + "\t" + std::to_string(stop_at) +
           "\t1";
}

void lend_pages(ManualSession& manual, std::size_t& lent) {
    Conversation& host = manual.host();
    while (lent < all_pages().size() && host.pages_lent - host.pages_released < max_pages) {
        host.page(*all_pages()[lent++]);
    }
}

/// The whole session; everything the host sends is compared on the way.
void play(ManualSession& manual) {
    Conversation& host = manual.host();
    std::size_t lent = 0;
    bool asked_for_state = false; // now and then
    const auto answer_state = [&] {
        if (std::exchange(asked_for_state, false)) {
            manual.answer({"=RS2\t6\t0\t0\t9\t0"});
        }
    };
    const auto next_inquiry = [&] {
        answer_state(); // in the order of the inquiries: behind =SM
        for (std::string asked; asked.find("^0?SM\n") == std::string::npos;) {
            answer_state();
            host.wake();
            asked = manual.sent();
            ASSERT_TRUE(asked.empty() || asked == "^0?RS\n" || asked == "^0?SM\n" || asked == "^0?SM\n^0?RS\n")
                << asked;
            asked_for_state = asked.find("^0?RS\n") != std::string::npos;
        }
    };

    host.connect();
    ASSERT_EQ(manual.sent(), "^0?RS\n");
    manual.answer({"=RS2\t5\t0\t0\t9\t1"});
    ASSERT_EQ(manual.sent(), "^0?VS\n^0?JL\n");
    manual.answer({"=VS1.0\t2.0\t3.0\t4.0\t5.0\tLJ\t1\t2\tV62.0.7.0\tJET3up\t4711", "=JL\\FFSDISK\\JOBS\\NAMES.job"});
    ASSERT_EQ(manual.sent(), "^0?SM\n");
    manual.answer({mail(0, 0, 0)});
    ASSERT_EQ(manual.sent(), "^0?SM\n");
    manual.answer({mail(0, 0, 0)});
    ASSERT_EQ(manual.sent(), "^0?CC\n");
    manual.answer({"=CC5\t0\t1000"});
    ASSERT_EQ(manual.sent(), "");
    ASSERT_EQ(host.story(), "begin run, last printed before 0");
    host.grant(first, last, first + 511);
    ASSERT_EQ(manual.sent(), "^0!FF\n^0?SM\n");
    manual.answer({mail(0, 0, 0)});
    ASSERT_EQ(manual.sent(), "^0=CM100000\n^0?SM\n");
    manual.answer({mail(0, 0)});
    ASSERT_EQ(manual.sent(), "");
    lend_pages(manual, lent);
    const std::string first_fill = manual.sent();
    ASSERT_EQ(first_fill.substr(0, 38), "^0=MR22118\tMaier\n^0=MR22119\tMail\xE4nder\n");
    ASSERT_EQ(first_fill, records(22118, 22373) + "^0?SM\n");
    ASSERT_EQ(first_fill.substr(first_fill.size() - 31), "^0=MR22373\tMiddelb\xFCscher\n^0?SM\n");
    ASSERT_EQ(host.story(), "intent through 23141");
    manual.answer({mail(255, 0)});
    ASSERT_EQ(manual.sent(), "");
    host.wake(); // a moment later, since the first product may come at once
    ASSERT_EQ(manual.sent(), "^0!GO\n^0?RS\n^0?SM\n");
    manual.answer({"=RS2\t6\t0\t0\t9\t0"});
    ASSERT_EQ(manual.sent(), "");
    ASSERT_EQ(host.story(), "notice: printing");

    // Two printed: the smallest block.
    manual.answer({mail(253, 22119)});
    ASSERT_EQ(manual.sent(), records(22374, 22375));
    ASSERT_EQ(host.story(), "printed through 22119");
    host.durable(23141);
    ASSERT_EQ(manual.sent(), "");
    next_inquiry();
    manual.answer({mail(198, 22175)}); // the manual's own slip: 197 would be right
    ASSERT_EQ(manual.sent(), records(22376, 22431));
    next_inquiry();
    manual.answer({mail(211, 22219)});
    ASSERT_EQ(manual.sent(), records(22432, 22475));

    // On and on, 50 prints at a time.
    std::uint32_t sent_through = 22475;
    for (std::uint32_t printed = 22269; printed < 99750; printed += 50) {
        ASSERT_NO_FATAL_FAILURE(next_inquiry());
        manual.answer({mail(sent_through - printed - 1, printed)});
        const std::uint32_t through = std::min(printed + 256, last);
        ASSERT_EQ(manual.sent(), records(sent_through + 1, through));
        sent_through = through;
        host.durable(std::min(through + 1024, last)); // the ledger is never far behind
        lend_pages(manual, lent);
    }
    next_inquiry();
    manual.answer({mail(sent_through - 99750 - 1, 99750)});
    ASSERT_EQ(manual.sent(), records(sent_through + 1, last)); // however few: it is the rest
    host.story();
    for (const auto& [entries, printed] : {std::pair{127U, 99872U}, std::pair{49U, 99950U}, std::pair{3U, 99996U}}) {
        next_inquiry();
        manual.answer({mail(entries, printed)});
        ASSERT_EQ(manual.sent(), "");
        ASSERT_EQ(host.story(), "printed through " + std::to_string(printed));
    }
    next_inquiry();
    manual.answer({mail(0, last, 0)});
    ASSERT_EQ(manual.sent(), "^0?RS\n");
    manual.answer({"=RS2\t5\t-1711274809\t0\t9\t0"});
    ASSERT_EQ(manual.sent(), "^0?RS\n");
    manual.answer({"=RS2\t5\t-1711274809\t0\t9\t0"});
    ASSERT_EQ(manual.sent(), "^0?SM\n");
    manual.answer({mail(0, last, 0)});
    ASSERT_EQ(manual.sent(), "^0?SM\n");
    manual.answer({mail(0, last, 0)});
    ASSERT_EQ(manual.sent(), "^0?CC\n");
    manual.answer({"=CC77888\t0\t78883"});
    ASSERT_EQ(manual.sent(), "^0!EQ\n^0?RS\n");
    ASSERT_EQ(host.story(), "settle this run: printed 99997-100000, in doubt none, unused none by end message 1223");
    manual.answer({"=RS2\t5\t0\t0\t9\t0"});
    ASSERT_EQ(manual.sent(), "");
    ASSERT_TRUE(host.closed);
    ASSERT_EQ(host.outcome.code, feeder::OutcomeCode::finished);
    ASSERT_EQ(host.pages_released, all_pages().size());
}

class ManualSessionOver : public testing::TestWithParam<Wire> {};

INSTANTIATE_TEST_SUITE_P(
    Wire, ManualSessionOver,
    testing::Values(
        Wire{.name = "whole_answers"}, Wire{.name = "single_bytes", .chunk = 1},
        Wire{.name = "chunks_of_7", .chunk = 7}, Wire{.name = "merged", .merged = true},
        Wire{.name = "line_feeds", .line_feed = true},
        Wire{.name = "line_feeds_in_single_bytes", .chunk = 1, .line_feed = true},
        Wire{.name = "length_prefixes", .length_prefix = true}, Wire{.name = "echo", .echo = true},
        Wire{.name = "blocks_of_64", .block = 64},
        Wire{.name = "everything", .chunk = 3, .line_feed = true, .length_prefix = true, .echo = true, .block = 32}),
    [](const auto& wire) { return std::string{wire.param.name}; });

TEST_P(ManualSessionOver, shouldSendTheSameBytes) {
    ManualSession manual{GetParam()};
    ASSERT_NO_FATAL_FAILURE(play(manual));
    static const std::string as_whole = [] {
        ManualSession whole{Wire{.name = "whole_answers"}};
        play(whole);
        return whole.transcript();
    }();
    EXPECT_EQ(manual.transcript() == as_whole, true);
    const SessionStatistics& statistics = manual.host().session.statistics();
    EXPECT_EQ(statistics.bytes_damaged, 0U);
    EXPECT_EQ(statistics.frames_unexpected > 0, GetParam().echo);
}

TEST(ManualSession, shouldSendEachRecordOnceInOrder) {
    ManualSession manual{Wire{.name = "whole_answers"}};
    ASSERT_NO_FATAL_FAILURE(play(manual));
    std::string all_records;
    std::istringstream lines{manual.transcript()};
    for (std::string line; std::getline(lines, line);) {
        if (line.rfind("^0=MR", 0) == 0) {
            all_records += line + "\n";
        }
    }
    EXPECT_EQ(all_records == records(first, last), true);
}

/// Every place at which the first answers can be split, in two.
TEST(ManualSession, shouldUnderstandAnswersSplitAtEveryByte) {
    const std::vector<std::string> answers{
        "^0=RS2\t5\t0\t0\t9\t1\r\n", "^0=VS1\t2\t3\t4\t5\t6\t7\t8\t9\t10\t11\r\n^0=JL\\A.job\r\n",
        "^0=SM256\t0\t0\t0\t1\r\n", "^0=SM256\t0\t0\t0\t1\t21\r\n", "^0=CC1\t2\t3\r\n"};
    const std::vector<std::string> expected{"^0?VS\n^0?JL\n", "^0?SM\n", "^0?SM\n", "^0?CC\n", ""};
    for (std::size_t which = 0; which < answers.size(); ++which) {
        for (std::size_t split = 0; split <= answers[which].size(); ++split) {
            Conversation host;
            host.connect();
            host.sent();
            for (std::size_t i = 0; i < answers.size(); ++i) {
                const std::string_view bytes{answers[i]};
                host.receive(bytes.substr(0, i == which ? split : 0));
                host.receive(bytes.substr(i == which ? split : 0));
                ASSERT_EQ(host.sent(), expected[i]) << which << ' ' << split << ' ' << i;
            }
            ASSERT_EQ(host.story(), "begin run, last printed before 0");
            ASSERT_EQ(host.session.statistics().frames_received, 6U);
        }
    }
}

} // namespace
} // namespace linefeed::session
