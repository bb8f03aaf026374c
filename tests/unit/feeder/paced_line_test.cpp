// Pacing in a closed loop: what lies in the printer against what could, for printers that come to their answers in
// different ways.
#include "paced_line.hpp"

#include <chrono>
#include <string>

namespace linefeed::feeder {
namespace {

using std::chrono::duration;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

struct Case {
    AnswerHabit habit;
    const char* name;
    /// How far what lies in the printer is behind what was printed, just before a refill arrives: in answer times. A
    /// printer that does one thing at a time may have a `?RS` between two `?SM`, and both before the records when those
    /// come.
    double answers_missing;
};

constexpr std::array<Case, 4> cases{{{AnswerHabit::on_the_way, "on the way", 1.0 + 1.0 / max_inquiries},
                                     {AnswerHabit::one_by_one, "one by one", 4.0},
                                     {AnswerHabit::in_a_cycle, "in a cycle", 1.0},
                                     {AnswerHabit::one_per_cycle, "one per cycle", 4.0}}};

double in_ms(Duration time) {
    return duration<double, std::milli>(time).count();
}

PacedLine line_with(AnswerHabit habit, Duration answer_time) {
    PacedLineSettings settings;
    settings.habit = habit;
    settings.answer_time = answer_time;
    return PacedLine{settings};
}

TEST(PacedLine, shouldKeepThePrinterAsFullAsItsAnswersAllow) {
    for (const Case& one : cases) {
        for (const Duration answer_time :
             {Duration{microseconds{100}}, Duration{milliseconds{1}}, Duration{milliseconds{5}},
              Duration{milliseconds{20}}, Duration{milliseconds{100}}}) {
            for (const double rate : {1.0, 30.0, 500.0, 1000.0, 2000.0}) {
                const double buffer_ms = 256 / rate * 1e3;
                const double unavoidable_ms = in_ms(answer_time) * one.answers_missing;
                if (unavoidable_ms > 0.8 * buffer_ms) {
                    continue; // no host could print at that rate
                }
                PacedLine line = line_with(one.habit, answer_time);
                line.run(rate, seconds{5} + std::chrono::ceil<seconds>(duration<double>{260 / rate}));
                line.run(rate, seconds{10});
                const double share_ms = buffer_ms / 32 + 2e3 / rate;
                EXPECT_GE(line.shortest_lead_ms(), buffer_ms - unavoidable_ms - share_ms)
                    << one.name << ", " << in_ms(answer_time) << " ms, " << rate << "/s";
            }
        }
    }
}

TEST(PacedLine, shouldBeginAtOnceAtTheFullRate) {
    const auto shortest_lead_ms = [](AnswerHabit habit, Duration answer_time, double rate) {
        PacedLine line = line_with(habit, answer_time);
        line.run(rate, seconds{1});
        return line.shortest_lead_ms();
    };
    EXPECT_GE(shortest_lead_ms(AnswerHabit::on_the_way, milliseconds{5}, 25000), 3.0);
    EXPECT_GE(shortest_lead_ms(AnswerHabit::on_the_way, milliseconds{20}, 9600), 3.0);
    EXPECT_GE(shortest_lead_ms(AnswerHabit::one_by_one, milliseconds{5}, 9000), 3.0);
    EXPECT_GE(shortest_lead_ms(AnswerHabit::one_by_one, milliseconds{20}, 3500), 3.0);
    EXPECT_GE(shortest_lead_ms(AnswerHabit::one_per_cycle, milliseconds{20}, 3500), 3.0);
}

TEST(PacedLine, shouldAskNoMoreThanItHasUseFor) {
    for (const Case& one : cases) {
        for (const double rate : {1.0, 100.0, 1000.0, 2000.0}) {
            PacedLine line = line_with(one.habit, milliseconds{5});
            line.run(rate, seconds{5});
            line.run(rate, seconds{10});
            EXPECT_LE(line.inquiries_per_s(), std::max(70.0, 0.27 * rate)) << one.name << ", " << rate << "/s";
        }
    }
}

TEST(PacedLine, shouldBeReadyForABurstAfterAStandstill) {
    for (const Case& one : cases) {
        for (const Duration answer_time :
             {Duration{microseconds{100}}, Duration{milliseconds{5}}, Duration{milliseconds{20}}}) {
            PacedLine line = line_with(one.habit, answer_time);
            line.run(1000, seconds{3});
            for (const int pause_ms : {30, 300, 3000, 30000}) {
                line.run(0, milliseconds{pause_ms});
                line.run(2000, seconds{1});
                EXPECT_GE(line.shortest_lead_ms(), 128 - 3 * in_ms(answer_time) - 16 - 3)
                    << one.name << ", " << in_ms(answer_time) << " ms, after " << pause_ms << " ms";
            }
        }
    }
}

} // namespace
} // namespace linefeed::feeder
