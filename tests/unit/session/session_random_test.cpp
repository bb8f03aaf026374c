// A session under random bytes, completions and times: it never aborts, ends once, and gives every page back.
#include "conversation.hpp"

#include <array>
#include <random>

namespace linefeed::session {
namespace {

class RandomPrinter {
public:
    explicit RandomPrinter(std::uint32_t seed)
        : random_(seed)
        , pages_(make_pages(1, 2000, 1 + draw(120), plain_text)) {
        host_.writes_complete_at_once = draw(2) == 0;
    }

    void run() {
        host_.connect();
        for (int step = 0; step < 400 && !host_.closed && !testing::Test::HasFatalFailure(); ++step) {
            one_step();
        }
        host_.close();
        ASSERT_TRUE(host_.ended);
        ASSERT_TRUE(host_.closed);
        ASSERT_EQ(host_.pages_released, host_.pages_lent);
        ASSERT_LE(host_.largest_write, max_write_pieces);
    }

private:
    std::uint32_t draw(std::uint32_t below) { return static_cast<std::uint32_t>(random_() % below); }

    void one_step() {
        switch (draw(10)) {
        case 0:
        case 1:
        case 2: {
            std::string bytes;
            for (std::uint32_t frames = draw(draw(20) == 0 ? 300 : 6); frames > 0; --frames) {
                bytes += frame();
            }
            host_.receive(bytes);
            break;
        }
        case 3:
        case 4:
            host_.now += std::chrono::milliseconds{draw(20) == 0 ? draw(1000) : draw(10)};
            host_.wait(Duration{0});
            break;
        case 5:
            if (host_.session.next_wake()) {
                host_.wake();
            }
            break;
        case 6:
            host_.written();
            break;
        case 7:
            ledger();
            break;
        case 8:
            if (lent_ < pages_.size() && host_.pages_lent - host_.pages_released < max_pages) {
                host_.page(*pages_[lent_++]);
            }
            break;
        default:
            rare();
            break;
        }
    }

    std::string frame() {
        const feeder::Refill& refill = host_.session.feeder().refill();
        switch (draw(12)) {
        case 0:
            return "^0=VS1\t1\t1\t1\t1\t1\t1\t1\t1\t1\tS1\r";
        case 1:
            return "^0=JLA\r";
        case 2:
            return "^0=CC0\t0\t" + std::to_string(draw(5000)) + "\r";
        case 3:
        case 4:
            return "^0=RS2\t" + std::to_string(draw(8) == 0 ? 1 + draw(6) : 5 + draw(2)) + "\t0\t0\t0\t0\r\n";
        case 5:
            return draw(8) == 0 ? "^0=RS2\t5\t-1711274809\t0\t0\t0\r" : "^0=RS2\t6\t0\t0\t0\t0\r";
        case 6: {
            std::string noise;
            for (std::uint32_t bytes = draw(12); bytes > 0; --bytes) {
                noise.push_back(static_cast<char>(draw(256)));
            }
            return noise;
        }
        default:
            break;
        }
        const std::uint32_t printed = draw(12) == 0 ? draw(2100)
                                                    : refill.printed_through().value() +
                                                          draw(static_cast<std::uint32_t>(refill.level().value()) + 1);
        const std::uint32_t stop = refill.range().empty() || draw(8) == 0 ? 0 : refill.range().last().value();
        return "^0=SM256\t" + std::to_string(draw(2) == 0 ? 0 : 255) + "\t" + std::to_string(printed) + "\t" +
               std::to_string(stop) + "\t" + std::to_string(draw(4)) + "\r";
    }

    void ledger() {
        if (host_.session.feeder().phase() == feeder::Phase::granting) {
            host_.grant(1, 2000, 512);
        } else if (draw(2) == 0) {
            host_.durable(host_.session.feeder().refill().sent_through().value() + draw(600));
        } else {
            host_.settled();
        }
    }

    void rare() {
        switch (draw(120)) {
        case 0:
            host_.stop();
            break;
        case 1:
            host_.storage_failed();
            break;
        case 2:
            host_.refuse(feeder::OutcomeCode::nothing_to_print);
            break;
        case 3:
            host_.close();
            break;
        default:
            break;
        }
    }

    std::mt19937 random_;
    std::vector<std::unique_ptr<RecordPage>> pages_;
    std::size_t lent_ = 0;
    Conversation host_;
};

TEST(SessionRandom, shouldSurviveWhateverThePrinterSays) {
    for (std::uint32_t seed = 1; seed <= 400 && !testing::Test::HasFatalFailure(); ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        RandomPrinter{seed}.run();
    }
}

} // namespace
} // namespace linefeed::session
