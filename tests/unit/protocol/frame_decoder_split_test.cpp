// One read is not one message: however a stream is split, the same comes out.
#include "decoding.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace linefeed::protocol {
namespace {

/// Everything that can happen to a stream, one after the other.
std::string eventful_stream() {
    return "^0=RS2\t6\t0\t0\t9\t1\r"
           "^0=SM256\t255\t0\t100000\t1\r\n"
           "^000013=RS2\t6\t0\t0\t0\r"
           "\r\r   ^0=MR1\ta\\^b\\\\\t{ho2r3}\r"
           "noise^0=JLx\\\\^0!GO\r"
           "^0=RS2\t6^0?SM\n\r"
           "^G!GO\r^0GO\r^012=\r^\r^0\r"
           "^000030=JLA\\^000013=RS2\t6\t0\t0\t0\r"
           "^000010=JLA\\^000013=RS2\t6\t0\t0\t0\r"
           "^000013=RS2\t6\t0\t0\t0^0!ST\r"
           "^000013=RS2\t6\t0\t0\t0\n\r^000014=RS2\t6\t0\t0\t0\n\r\n"
           "^000004!GO\n\n\r^000004!GO\n^0!ST\n\r";
}

class FrameDecoderSplit : public testing::TestWithParam<EscapeMode> {};
INSTANTIATE_TEST_SUITE_P(Modes, FrameDecoderSplit, testing::Values(EscapeMode::backslash, EscapeMode::none),
                         [](const auto& mode) { return mode.param == EscapeMode::none ? "none" : "backslash"; });

TEST_P(FrameDecoderSplit, shouldNotDependOnASplitAnywhere) {
    const std::string stream = eventful_stream();
    const auto whole = decode(stream, GetParam());
    ASSERT_GT(whole.size(), 18U);
    for (std::size_t cut = 0; cut <= stream.size(); ++cut) {
        EXPECT_EQ(decode(stream, GetParam(), {cut}), whole) << "cut at " << cut;
    }
}

TEST_P(FrameDecoderSplit, shouldNotDependOnTwoSplits) {
    const std::string stream = eventful_stream().substr(0, 120);
    const auto whole = decode(stream, GetParam());
    for (std::size_t first = 0; first <= stream.size(); ++first) {
        for (std::size_t second = first; second <= stream.size(); ++second) {
            ASSERT_EQ(decode(stream, GetParam(), {first, second}), whole) << "cut at " << first << " and " << second;
        }
    }
}

TEST_P(FrameDecoderSplit, shouldNotDependOnReadingByteByByte) {
    const std::string stream = eventful_stream();
    EXPECT_EQ(decode(stream, GetParam(), every_byte(stream.size())), decode(stream, GetParam()));
}

TEST_P(FrameDecoderSplit, shouldNotDependOnSplitsOfOverlongFrames) {
    const std::string stream =
        "^0=" + std::string(max_frame_bytes, 'x') + "\r^0=" + std::string(9000, '\\') + "^0!GO\r";
    const auto whole = decode(stream, GetParam());
    for (std::size_t cut = max_frame_bytes - 10; cut < max_frame_bytes + 10; ++cut) {
        EXPECT_EQ(decode(stream, GetParam(), {cut}), whole) << "cut at " << cut;
    }
    EXPECT_EQ(decode(stream, GetParam(), every_byte(stream.size())), whole);
}

/// Bytes that are likely to mean something to the decoder.
std::string random_stream(std::mt19937_64& random, std::size_t size) {
    constexpr std::string_view alphabet = "^^^\\\\\r\r\n 0000135=!?$*ARS\t";
    std::string stream;
    while (stream.size() < size) {
        switch (random() % 8) {
        case 0:
            stream += "^0=SM256\t0\t0\t0\t1\r";
            break;
        case 1:
            stream += "^000004!GO\r";
            break;
        case 2:
            stream += "^000004!GO\n\r";
            break;
        case 3:
            stream.push_back(static_cast<char>(random() % 256));
            break;
        default:
            stream.push_back(alphabet[random() % alphabet.size()]);
        }
    }
    return stream;
}

TEST_P(FrameDecoderSplit, shouldNotDependOnRandomSplitsOfRandomBytes) {
    for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
        std::mt19937_64 random{seed};
        const std::string stream = random_stream(random, 1 + random() % 300);
        const auto whole = decode(stream, GetParam());
        std::vector<std::size_t> cuts;
        for (std::size_t at = random() % 9; at < stream.size(); at += 1 + random() % 9) {
            cuts.push_back(at);
        }
        ASSERT_EQ(decode(stream, GetParam(), cuts), whole) << "seed " << seed;
        ASSERT_EQ(decode(stream, GetParam(), every_byte(stream.size())), whole) << "seed " << seed;
    }
}

TEST_P(FrameDecoderSplit, shouldAlwaysDecodeAGoodFrameBehindAnyNoise) {
    for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
        std::mt19937_64 random{seed};
        const std::string noise = random_stream(random, random() % 200);
        const auto stories = decode(noise + "\r^0=CM100000\r", GetParam());
        ASSERT_FALSE(stories.empty());
        ASSERT_EQ(stories.back(), "0=CM100000 [^0=CM100000]") << "seed " << seed;
    }
}

TEST_P(FrameDecoderSplit, shouldAccountForEveryByteThatIsNotFilling) {
    // Without line feeds, blanks and carriage returns each byte is in a frame or in an error.
    for (std::uint64_t seed = 1; seed <= 500; ++seed) {
        std::mt19937_64 random{seed};
        std::string stream = random_stream(random, 200);
        std::erase_if(stream, [](char c) { return c == ' ' || c == '\n' || c == '\0'; });
        stream += '\r';
        FrameDecoder decoder{GetParam()};
        std::string_view input = stream;
        std::uint64_t accounted = 0;
        while (true) {
            const DecodeResult result = decoder.next(input);
            if (const auto* const frame = std::get_if<Frame>(&result)) {
                accounted += frame->raw.size();
            } else if (const auto* const error = std::get_if<FrameError>(&result)) {
                accounted += error->bytes;
            } else {
                break;
            }
        }
        const auto ends = static_cast<std::uint64_t>(std::ranges::count(stream, '\r'));
        ASSERT_EQ(accounted + ends, stream.size()) << "seed " << seed;
    }
}

} // namespace
} // namespace linefeed::protocol
