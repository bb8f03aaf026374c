#include "intake/folder_watch.hpp"
#include "intake_fixture.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

namespace linefeed::intake {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using Kind = FolderEvent::Kind;

class FolderWatchTest : public IntakeTest {
protected:
    void SetUp() override {
        IntakeTest::SetUp();
        folder = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    }
    void TearDown() override {
        ::close(folder);
        IntakeTest::TearDown();
    }
    std::vector<FolderEvent> read(FolderWatch& watch) {
        std::vector<FolderEvent> events;
        EXPECT_TRUE(watch.read(events).has_value());
        return events;
    }
    int folder = -1;
};

TEST_F(FolderWatchTest, shouldTellWhatHappensToAName) {
    const auto watch = watch_folder(folder, WatchMode::inotify, {}).value();
    EXPECT_EQ(watch->rescan_interval(), Duration{30s});
    pollfd waiting{watch->descriptor(), POLLIN, 0};
    EXPECT_EQ(::poll(&waiting, 1, 0), 0);
    write("x", "a\nb");
    EXPECT_EQ(::poll(&waiting, 1, 0), 1);
    std::filesystem::rename(directory / "a\nb", directory / "c");
    std::filesystem::remove(directory / "c");
    EXPECT_THAT(read(*watch), ElementsAre(FolderEvent{Kind::created, "a\nb"}, FolderEvent{Kind::modified, "a\nb"},
                                          FolderEvent{Kind::closed, "a\nb"}, FolderEvent{Kind::gone, "a\nb"},
                                          FolderEvent{Kind::moved_in, "c"}, FolderEvent{Kind::gone, "c"}));
    EXPECT_THAT(read(*watch), ElementsAre());
}

TEST_F(FolderWatchTest, shouldSayThatEventsWereLost) {
    const auto watch = watch_folder(folder, WatchMode::inotify, 5s).value();
    EXPECT_EQ(watch->rescan_interval(), Duration{5s});
    std::size_t most = 16384;
    std::ifstream{"/proc/sys/fs/inotify/max_queued_events"} >> most;
    write("x", "0");
    for (std::size_t i = 0; i < most; ++i) {
        std::filesystem::rename(directory / std::to_string(i), directory / std::to_string(i + 1));
    }
    std::vector<FolderEvent> all;
    for (auto events = read(*watch); !events.empty(); events = read(*watch)) {
        all.insert(all.end(), events.begin(), events.end());
    }
    EXPECT_LE(all.size(), most + 1);
    EXPECT_EQ(all.back(), FolderEvent{Kind::lost});
}

TEST_F(FolderWatchTest, shouldKnowNothingButTheTimeWhenPolling) {
    const auto watch = watch_folder(folder, WatchMode::poll, {}).value();
    EXPECT_EQ(watch->descriptor(), -1);
    EXPECT_EQ(watch->rescan_interval(), Duration{1s});
    write("x", "a");
    EXPECT_THAT(read(*watch), ElementsAre());
}

TEST_F(FolderWatchTest, shouldRefuseWhatIsNoFolder) {
    const int file = ::open(write("x").c_str(), O_RDONLY | O_CLOEXEC);
    EXPECT_EQ(watch_folder(file, WatchMode::inotify, {}).error().kind, FailureKind::internal);
    ::close(file);
}

TEST_F(FolderWatchTest, shouldSeeThatALocalDiskIsNoShare) {
    EXPECT_EQ(network_file_system(folder), "");
    EXPECT_EQ(network_file_system(-1), "");
}

} // namespace
} // namespace linefeed::intake
