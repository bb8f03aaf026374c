// The log: levels, fields, what is disarmed, and what happens when lines come faster than they can be written.
#include "daemon/feed_thread.hpp"
#include "daemon/log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <condition_variable>
#include <map>
#include <mutex>
#include <string>
#include <sys/uio.h>
#include <thread>
#include <vector>

namespace linefeed::daemon {
namespace {

using config::LogComponent;
using config::LoggingSettings;
using config::LogLevel;
using testing::ElementsAre;
using testing::HasSubstr;

/// What has been written, and a gate that holds the writing up.
class Paper {
public:
    void add(const LogLine& line) {
        std::unique_lock lock{mutex_};
        ++waiting_;
        changed_.notify_all();
        changed_.wait(lock, [this] { return !closed_; });
        --waiting_;
        std::string text{line.component};
        text.append("/").append(line.message);
        for (const auto& [name, value] : line.fields) {
            text.append(" ").append(name).append("=").append(value);
        }
        lines_.push_back(text);
        file_ = line.file;
        code_line_ = line.line;
        level_ = line.level;
    }
    void close() { set(true); }
    void open() { set(false); }
    /// Waits until the log's thread stands at the closed gate.
    void wait_until_held() {
        std::unique_lock lock{mutex_};
        changed_.wait(lock, [this] { return waiting_ > 0; });
    }
    std::vector<std::string> lines_;
    std::string file_;
    std::uint32_t code_line_ = 0;
    LogLevel level_ = LogLevel::trace;

private:
    void set(bool closed) {
        const std::lock_guard lock{mutex_};
        closed_ = closed;
        changed_.notify_all();
    }
    std::mutex mutex_;
    std::condition_variable changed_;
    bool closed_ = false;
    int waiting_ = 0;
};

class PaperTarget final : public LogTarget {
public:
    explicit PaperTarget(Paper& paper)
        : paper_(paper) {}
    void write(const LogLine& line) override { paper_.add(line); }

private:
    Paper& paper_;
};

std::unique_ptr<LogTarget> on(Paper& paper) {
    return std::make_unique<PaperTarget>(paper);
}

TEST(Log, shouldWriteWordsAndFields) {
    Paper paper;
    Log{{}, on(paper)}.write(LogComponent::printer, LogLevel::warning, "the buffer runs empty",
                             {spool::JobId{12}, "line1", RecordNumber{4711}});
    EXPECT_THAT(paper.lines_, ElementsAre("printer/the buffer runs empty JOB=12 PRINTER=line1 RECORD=4711"));
    EXPECT_EQ(paper.level_, LogLevel::warning);
    EXPECT_THAT(paper.file_, HasSubstr("log_test.cpp"));
    EXPECT_GT(paper.code_line_, 0U);
}

TEST(Log, shouldDisarmWhatComesFromOutside) {
    Paper paper;
    Log{{}, on(paper)}.write(LogComponent::folder, LogLevel::error, "a\x1b[2J\nb\x1FJOB=99\xFF Größe",
                             {{}, "line\n1", {}});
    EXPECT_THAT(paper.lines_, ElementsAre("folder/a\\x1B[2J\\x0Ab\\x1FJOB=99\\xFF Größe PRINTER=line\\x0A1"));
}

TEST(Log, shouldKeepAnEqualsSignInAValue) {
    Paper paper;
    Log{{}, on(paper)}.write(LogComponent::api, LogLevel::info, "", {{}, "a=b", {}});
    EXPECT_THAT(paper.lines_, ElementsAre("api/ PRINTER=a=b"));
}

TEST(Log, shouldHaveALevelForEachComponent) {
    Paper paper;
    {
        LoggingSettings settings;
        settings.level = LogLevel::warning;
        settings.levels[static_cast<std::size_t>(LogComponent::intake)] = LogLevel::debug;
        Log log{settings, on(paper)};
        EXPECT_TRUE(log.wants(LogComponent::intake, LogLevel::debug));
        EXPECT_FALSE(log.wants(LogComponent::intake, LogLevel::trace));
        EXPECT_FALSE(log.wants(LogComponent::store, LogLevel::info));
        log.write(LogComponent::intake, LogLevel::debug, "one");
        log.write(LogComponent::store, LogLevel::info, "two");
        log.write(LogComponent::store, LogLevel::error, "three");
    }
    EXPECT_THAT(paper.lines_, ElementsAre("intake/one", "store/three"));
}

TEST(Log, shouldTakeNewLevelsWhileItRuns) {
    Paper paper;
    {
        Log log{{}, on(paper)};
        log.write(LogComponent::store, LogLevel::debug, "one");
        LoggingSettings settings;
        settings.level = LogLevel::debug;
        log.set_levels(settings);
        log.write(LogComponent::store, LogLevel::debug, "two");
    }
    EXPECT_THAT(paper.lines_, ElementsAre("store/two"));
}

TEST(Log, shouldLoseTheOldestAndSaySo) {
    Paper paper;
    paper.close();
    constexpr std::size_t waiting = 10;
    {
        Log log{{}, on(paper), waiting};
        log.write(LogComponent::service, LogLevel::info, "held");
        paper.wait_until_held();
        for (int i = 0; i < 25; ++i) { // nobody waits for the target
            log.write(LogComponent::service, LogLevel::info, std::to_string(i));
        }
        EXPECT_EQ(log.dropped(), 15U);
        paper.open();
    }
    ASSERT_EQ(paper.lines_.size(), 12U);
    EXPECT_EQ(paper.lines_[0], "service/held");
    EXPECT_EQ(paper.lines_[1], "service/lines of the log were lost because more came than could be written: 15 now, 15 "
                               "since the start");
    EXPECT_EQ(paper.lines_[2], "service/15");
    EXPECT_EQ(paper.lines_.back(), "service/24");
}

TEST(Log, shouldTakeLinesOfManyThreads) {
    Paper paper;
    {
        Log log{{}, on(paper)};
        std::vector<std::thread> threads;
        for (int thread = 0; thread < 4; ++thread) {
            threads.emplace_back([&log] {
                for (int i = 0; i < 500; ++i) {
                    log.write(LogComponent::store, LogLevel::info, "line", {{}, "p", RecordNumber{1}});
                }
            });
        }
        for (std::thread& thread : threads) {
            thread.join();
        }
        EXPECT_EQ(log.dropped(), 0U);
    }
    EXPECT_EQ(paper.lines_.size(), 2000U);
    EXPECT_THAT(paper.lines_, testing::Each("store/line PRINTER=p RECORD=1"));
}

class LoggingGuest final : public FeedThread::Guest {
public:
    void on_feed_thread() override { log_.write(LogComponent::printer, LogLevel::info, "wrong"); }

private:
    Paper paper_;
    Log log_{{}, on(paper_)};
};

void log_on_feed_thread() {
    LoggingGuest guest;
    FeedThread feed{{}};
    static_cast<void>(feed.start());
    feed.let_in(guest);
    std::this_thread::sleep_for(std::chrono::seconds{20});
}

TEST(LogDeathTest, shouldNotBeWrittenOnTheFeedThread) {
    testing::FLAGS_gtest_death_test_style = "threadsafe";
    EXPECT_DEATH(log_on_feed_thread(), "FeedThread::is_current");
}

LogLine example() {
    LogLine line;
    line.time = std::chrono::system_clock::time_point{std::chrono::milliseconds{1'700'000'000'042}};
    line.component = "printer";
    line.level = LogLevel::warning;
    line.message = "the cover is open";
    line.fields = {{"JOB", "12"}, {"PRINTER", "line1"}};
    return line;
}

TEST(LogTarget, shouldGiveTheJournalItsFields) {
    std::map<std::string, std::string> fields;
    const auto send = [&fields](const iovec* pieces, int count) {
        for (int i = 0; i < count; ++i) {
            const std::string_view piece{static_cast<const char*>(pieces[i].iov_base), pieces[i].iov_len};
            fields.emplace(piece.substr(0, piece.find('=')), piece.substr(piece.find('=') + 1));
        }
        return 0;
    };
    LogLine line = example();
    line.file = "src/daemon/x.cpp";
    line.line = 7;
    line.function = "f()";
    testing::internal::CaptureStderr();
    journal_target(send)->write(line);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    const std::map<std::string, std::string> wanted{
        {"MESSAGE", "the cover is open"},  {"PRIORITY", "4"},      {"SYSLOG_IDENTIFIER", "linefeedd"},
        {"LINEFEED_COMPONENT", "printer"}, {"LINEFEED_JOB", "12"}, {"LINEFEED_PRINTER", "line1"},
        {"CODE_FILE", "src/daemon/x.cpp"}, {"CODE_LINE", "7"},     {"CODE_FUNC", "f()"}};
    EXPECT_EQ(fields, wanted);
}

TEST(LogTarget, shouldRankLevelsAsSyslogDoes) {
    std::vector<std::string> priorities;
    const auto target = journal_target([&priorities](const iovec* pieces, int) {
        priorities.emplace_back(static_cast<const char*>(pieces[1].iov_base), pieces[1].iov_len);
        return 0;
    });
    for (const LogLevel level :
         {LogLevel::trace, LogLevel::debug, LogLevel::info, LogLevel::warning, LogLevel::error}) {
        LogLine line = example();
        line.level = level;
        target->write(line);
    }
    EXPECT_THAT(priorities, ElementsAre("PRIORITY=7", "PRIORITY=7", "PRIORITY=6", "PRIORITY=4", "PRIORITY=3"));
}

TEST(LogTarget, shouldWriteToStandardErrorWhatTheJournalRefuses) {
    testing::internal::CaptureStderr();
    journal_target([](const iovec*, int) { return -EMSGSIZE; })->write(example());
    EXPECT_EQ(testing::internal::GetCapturedStderr(),
              "2023-11-14T22:13:20.042Z warning printer: the cover is open (job 12, printer line1)\n");
}

TEST(LogTarget, shouldWriteALineWithoutFields) {
    LogLine line = example();
    line.fields.clear();
    testing::internal::CaptureStderr();
    make_log_target(config::LogTarget::standard_error)->write(line);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "2023-11-14T22:13:20.042Z warning printer: the cover is open\n");
}

} // namespace
} // namespace linefeed::daemon
