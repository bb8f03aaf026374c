#include "intake/folder_watch.hpp"

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <sys/inotify.h>
#include <sys/statfs.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace linefeed::intake {

namespace {

constexpr Duration inotify_rescan = std::chrono::seconds{30};
constexpr Duration poll_interval = std::chrono::seconds{1};
/// Of one read; an event with the longest name fits many times.
constexpr std::size_t buffer_bytes = std::size_t{64} * 1024;
constexpr int most_reads = 16;

class InotifyWatch final : public FolderWatch {
public:
    InotifyWatch(int descriptor, Duration rescan)
        : descriptor_(descriptor)
        , rescan_(rescan) {}
    InotifyWatch(const InotifyWatch&) = delete;
    InotifyWatch& operator=(const InotifyWatch&) = delete;
    ~InotifyWatch() override { ::close(descriptor_); }

    int descriptor() const override { return descriptor_; }
    Duration rescan_interval() const override { return rescan_; }
    Result<void> read(std::vector<FolderEvent>& events) override;

private:
    int descriptor_;
    Duration rescan_;
};

class PollWatch final : public FolderWatch {
public:
    explicit PollWatch(Duration interval)
        : interval_(interval) {}
    int descriptor() const override { return -1; }
    Result<void> read(std::vector<FolderEvent>&) override { return {}; }
    Duration rescan_interval() const override { return interval_; }

private:
    Duration interval_;
};

void append(std::vector<FolderEvent>& events, std::uint32_t mask, std::string name) {
    using Kind = FolderEvent::Kind;
    // The kernel reports one thing an event.
    constexpr std::array<std::pair<std::uint32_t, Kind>, 6> kinds{{{IN_CREATE, Kind::created},
                                                                   {IN_MOVED_TO, Kind::moved_in},
                                                                   {IN_MODIFY, Kind::modified},
                                                                   {IN_CLOSE_WRITE, Kind::closed},
                                                                   {IN_MOVED_FROM, Kind::gone},
                                                                   {IN_DELETE, Kind::gone}}};
    if ((mask & (IN_Q_OVERFLOW | IN_UNMOUNT)) != 0) {
        events.push_back({Kind::lost});
    }
    for (const auto& [bit, kind] : kinds) {
        if ((mask & bit) != 0) {
            events.push_back({kind, std::move(name)});
            return;
        }
    }
}

Result<void> InotifyWatch::read(std::vector<FolderEvent>& events) {
    alignas(inotify_event) std::array<char, buffer_bytes> buffer;
    for (int reads = 0; reads < most_reads; ++reads) {
        const ssize_t got = ::read(descriptor_, buffer.data(), buffer.size());
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got <= 0) {
            return got == 0 || errno == EAGAIN
                       ? Result<void>{}
                       : Failure{FailureKind::internal, "inotify: " + std::generic_category().message(errno)};
        }
        for (std::size_t at = 0; at < static_cast<std::size_t>(got);) {
            inotify_event event{};
            std::memcpy(&event, buffer.data() + at, sizeof event);
            const char* const name = buffer.data() + at + sizeof event;
            append(events, event.mask, std::string{name, ::strnlen(name, event.len)}); // padded with NUL
            at += sizeof event + event.len;
        }
    }
    return {};
}

Failure no_inotify(int error) {
    // EMFILE, ENOSPC: fs.inotify.max_user_instances, max_user_watches
    return {FailureKind::internal,
            "the folder cannot be watched by inotify: " + std::generic_category().message(error) +
                (error == EMFILE || error == ENOSPC ? " (see sysctl fs.inotify)" : "")};
}

} // namespace

Result<std::unique_ptr<FolderWatch>> watch_folder(int directory, WatchMode mode, std::optional<Duration> rescan) {
    if (mode == WatchMode::poll) {
        return std::unique_ptr<FolderWatch>{new PollWatch{rescan.value_or(poll_interval)}};
    }
    const int descriptor = ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    if (descriptor < 0) {
        return no_inotify(errno);
    }
    auto watch = std::make_unique<InotifyWatch>(descriptor, rescan.value_or(inotify_rescan));
    // By the descriptor, so that it is the very directory that is open, whatever its path leads to now.
    const std::string folder = "/proc/self/fd/" + std::to_string(directory);
    constexpr std::uint32_t mask = IN_CREATE | IN_MOVED_TO | IN_MODIFY | IN_CLOSE_WRITE | IN_MOVED_FROM | IN_DELETE;
    if (::inotify_add_watch(descriptor, folder.c_str(), mask | IN_ONLYDIR) < 0) {
        return no_inotify(errno);
    }
    return std::unique_ptr<FolderWatch>{std::move(watch)};
}

std::string_view network_file_system(int directory) {
    // linux/magic.h has most of these, but not all.
    constexpr std::array<std::pair<std::uint32_t, std::string_view>, 14> remote{{
        {0x6969, "NFS"},
        {0x517B, "SMB"},
        {0xFF534D42, "CIFS"},
        {0xFE534D42, "SMB2"},
        {0x01021997, "9P"},
        {0x65735546, "FUSE"},
        {0x5346414F, "AFS"},
        {0x6B414653, "AFS"},
        {0x73757245, "Coda"},
        {0x00C36400, "Ceph"},
        {0x0BD00BD0, "Lustre"},
        {0x7461636F, "OCFS2"},
        {0x01161970, "GFS2"},
        {0x786F4256, "vboxsf"},
    }};
    struct statfs status {};
    if (::fstatfs(directory, &status) != 0) {
        return {};
    }
    for (const auto& [magic, name] : remote) {
        if (static_cast<std::uint32_t>(status.f_type) == magic) {
            return name;
        }
    }
    return {};
}

} // namespace linefeed::intake
