// What is asked of the operating system for the feed thread, and what is said about it.
#include "daemon/real_time.hpp"

#include <gmock/gmock.h>

#include <sched.h>
#include <thread>
#include <unistd.h>

namespace linefeed::daemon {
namespace {

using testing::HasSubstr;

/// On a thread of its own: what is granted goes with it.
template <typename Check>
void on_a_thread(const RealTimeSettings& settings, const Check& check) {
    std::thread{[&] { check(make_real_time(settings)); }}.join();
}

TEST(RealTime, shouldAskForNothingUnlessToldTo) {
    EXPECT_FALSE(RealTimeSettings{}.wanted());
    on_a_thread({}, [](const std::string& line) { EXPECT_EQ(line, ""); });
}

TEST(RealTime, shouldBindTheThreadToItsProcessor) {
    on_a_thread({.priority = {}, .processor = 0}, [](const std::string& line) {
        EXPECT_EQ(line, "feed thread: processor 0 granted");
        cpu_set_t processors;
        ASSERT_EQ(::sched_getaffinity(0, sizeof processors, &processors), 0);
        EXPECT_EQ(CPU_COUNT(&processors), 1);
        EXPECT_TRUE(CPU_ISSET(0, &processors));
    });
}

TEST(RealTime, shouldSayWhatIsRefusedAndWhatHelps) {
    for (const int processor : {-1, 1000000}) {
        on_a_thread({.priority = {}, .processor = processor}, [](const std::string& line) {
            EXPECT_THAT(line, HasSubstr("refused"));
            EXPECT_THAT(line, HasSubstr("nproc"));
        });
    }
    on_a_thread({.priority = 1000}, [](const std::string& line) {
        EXPECT_THAT(line, HasSubstr("SCHED_FIFO priority 1000 refused"));
        EXPECT_THAT(line, HasSubstr("LimitRTPRIO"));
        EXPECT_EQ(::sched_getscheduler(0), SCHED_OTHER);
    });
}

TEST(RealTime, shouldScheduleTheThreadWherePermitted) {
    on_a_thread({.priority = 1}, [](const std::string& line) {
        const bool granted = line == "feed thread: SCHED_FIFO priority 1 granted";
        EXPECT_EQ(::sched_getscheduler(0) == SCHED_FIFO, granted) << line;
    });
}

} // namespace
} // namespace linefeed::daemon
