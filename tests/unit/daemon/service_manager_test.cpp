// What systemd hears, on a socket that stands for its own, and when the watchdog starves.
#include "daemon/feed_thread.hpp"
#include "daemon/service_manager.hpp"
#include "store/store_thread.hpp"
#include "support/spool_job.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <future>
#include <string>
#include <sys/socket.h>
#include <sys/un.h>
#include <thread>
#include <unistd.h>

namespace linefeed::daemon {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::SpoolJobTest;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::MatchesRegex;

/// Stands for systemd: a datagram socket whose name is in NOTIFY_SOCKET.
class FakeSystemd {
public:
    FakeSystemd() {
        socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        const std::string name = "@linefeed-notify-" + std::to_string(::getpid()); // abstract: nothing stays behind
        name.copy(address.sun_path, name.size());
        address.sun_path[0] = '\0';
        const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
        EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), size), 0);
        ::setenv("NOTIFY_SOCKET", name.c_str(), 1);
    }
    ~FakeSystemd() {
        ::unsetenv("NOTIFY_SOCKET");
        ::unsetenv("WATCHDOG_USEC");
        ::close(socket_);
    }
    FakeSystemd(const FakeSystemd&) = delete;
    FakeSystemd& operator=(const FakeSystemd&) = delete;

    /// The next message; empty = none has come.
    std::string heard() {
        std::array<char, 4096> buffer{};
        const auto size = ::recv(socket_, buffer.data(), buffer.size(), 0);
        return size < 0 ? "" : std::string{buffer.data(), static_cast<std::size_t>(size)};
    }

private:
    int socket_ = -1;
};

TEST(ServiceManager, shouldTellEachStateWithItsStatus) {
    FakeSystemd systemd;
    notify_ready("2 printers, 1 printing");
    EXPECT_EQ(systemd.heard(), "READY=1\nSTATUS=2 printers, 1 printing");
    notify_status("3 printers");
    EXPECT_EQ(systemd.heard(), "STATUS=3 printers");
    notify_reloading();
    EXPECT_THAT(systemd.heard(), MatchesRegex("RELOADING=1\nMONOTONIC_USEC=[0-9]+"));
    notify_stopping("stopping the lines");
    EXPECT_EQ(systemd.heard(), "STOPPING=1\nSTATUS=stopping the lines");
    EXPECT_EQ(systemd.heard(), "");
}

TEST(ServiceManager, shouldNotLetAStatusBecomeAnotherAssignment) {
    FakeSystemd systemd;
    notify_status("printer a\nWATCHDOG=1");
    EXPECT_EQ(systemd.heard(), "STATUS=printer a\\x0AWATCHDOG=1");
}

TEST(ServiceManager, shouldSayNothingWhereNobodyListens) {
    ::unsetenv("NOTIFY_SOCKET");
    notify_ready("alone"); // neither fails nor blocks
    EXPECT_EQ(Watchdog::look_interval(), std::nullopt);
}

TEST(ServiceManager, shouldLookFourTimesInTheTimeThatIsGranted) {
    FakeSystemd systemd;
    ::setenv("WATCHDOG_USEC", "2000000", 1);
    EXPECT_EQ(Watchdog::look_interval(), milliseconds{500});
    ::setenv("WATCHDOG_USEC", "60000000", 1);
    EXPECT_EQ(Watchdog::look_interval(), seconds{1});
    ::setenv("WATCHDOG_PID", "1", 1); // not this process
    EXPECT_EQ(Watchdog::look_interval(), std::nullopt);
    ::unsetenv("WATCHDOG_PID");
}

TEST(Watchdog, shouldBeFedOnlyWhenEveryHeartHasBeaten) {
    FakeSystemd systemd;
    std::uint64_t feed = 1;
    std::uint64_t store = 1;
    Watchdog watchdog{{{"feed thread", [&] { return feed; }}, {"store thread", [&] { return store; }}}};
    EXPECT_THAT(watchdog.look(), ElementsAre("feed thread", "store thread"));
    ++feed;
    EXPECT_THAT(watchdog.look(), ElementsAre("store thread"));
    EXPECT_EQ(systemd.heard(), "");
    ++store; // since the last feeding each has: it need not be since the last look
    EXPECT_THAT(watchdog.look(), IsEmpty());
    EXPECT_EQ(systemd.heard(), "WATCHDOG=1");
    ++store;
    EXPECT_THAT(watchdog.look(), ElementsAre("feed thread"));
    EXPECT_EQ(systemd.heard(), "");
}

/// Blocks the feed thread, as nothing may.
class StallingGuest final : public FeedThread::Guest {
public:
    void on_feed_thread() override {
        stalled.set_value();
        go_on.get_future().wait();
    }
    std::promise<void> stalled;
    std::promise<void> go_on;
};

class WatchdogThreadsTest : public SpoolJobTest {
protected:
    /// Looks for as long as `time` or until systemd hears something.
    std::string looked(Watchdog& watchdog, Duration time) {
        const auto deadline = std::chrono::steady_clock::now() + time;
        std::string heard;
        while (heard.empty() && std::chrono::steady_clock::now() < deadline) {
            still_ = watchdog.look();
            heard = systemd_.heard();
            std::this_thread::sleep_for(milliseconds{20});
        }
        return heard;
    }

    FakeSystemd systemd_;
    std::vector<std::string> still_;
};

TEST_F(WatchdogThreadsTest, shouldStarveWhileTheFeedThreadStandsStill) {
    StallingGuest guest;
    FeedThread feed{{}};
    static_cast<void>(feed.start());
    store::StoreThread store{*spool_};
    Watchdog watchdog{{{"feed thread", [&] { return feed.beats(); }}, {"store thread", [&] { return store.beats(); }}}};
    EXPECT_EQ(looked(watchdog, seconds{20}), "WATCHDOG=1");
    EXPECT_EQ(looked(watchdog, seconds{20}), "WATCHDOG=1");

    feed.let_in(guest);
    guest.stalled.get_future().wait();
    static_cast<void>(looked(watchdog, milliseconds{1200})); // what had beaten before
    EXPECT_EQ(looked(watchdog, milliseconds{1200}), "");
    EXPECT_THAT(still_, ElementsAre("feed thread"));

    guest.go_on.set_value();
    EXPECT_EQ(looked(watchdog, seconds{20}), "WATCHDOG=1");
}

TEST_F(WatchdogThreadsTest, shouldStarveWhileTheStoreThreadStandsStill) {
    store::StoreThread store{*spool_};
    Watchdog watchdog{{{"store thread", [&] { return store.beats(); }}}};
    EXPECT_EQ(looked(watchdog, seconds{20}), "WATCHDOG=1");
    std::promise<void> stalled;
    std::promise<void> go_on;
    std::thread caller{[&] {
        store.call([&](spool::Spool&) {
            stalled.set_value();
            go_on.get_future().wait();
        });
    }};
    stalled.get_future().wait();
    static_cast<void>(looked(watchdog, milliseconds{100}));
    EXPECT_EQ(looked(watchdog, milliseconds{1200}), "");
    go_on.set_value();
    caller.join();
    EXPECT_EQ(looked(watchdog, seconds{20}), "WATCHDOG=1");
}

} // namespace
} // namespace linefeed::daemon
