// What happens in a folder, by inotify where the kernel sees every change, by looking again and again where it does
// not: on a network share the changes of other machines raise no events here. The rest of the drop folder knows no
// difference: it looks at the whole folder in intervals in both cases, and events only tell more, and sooner.
#pragma once

#include "base/failure.hpp"
#include "base/time.hpp"

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::intake {

enum class WatchMode { inotify, poll };

struct FolderEvent {
    enum class Kind {
        created,  ///< made in place, perhaps as a second name
        moved_in, ///< renamed into place
        modified, ///< somebody has it open for writing
        closed,   ///< somebody who had it open for writing has closed it
        gone,     ///< removed or renamed
        lost,     ///< events are missing: the whole folder must be looked at (no name)
    };
    Kind kind = Kind::lost;
    std::string name{};

    friend bool operator==(const FolderEvent&, const FolderEvent&) = default;
};

class FolderWatch {
public:
    virtual ~FolderWatch() = default;
    /// Readable when there are events; -1 = there never are.
    [[nodiscard]] virtual int descriptor() const = 0;
    /// Appends what has happened since the last call, in order, at most some thousand events a call. Does not wait.
    [[nodiscard]] virtual Result<void> read(std::vector<FolderEvent>& events) = 0;
    /// How long the folder may go without a look at all of it.
    [[nodiscard]] virtual Duration rescan_interval() const = 0;
};

/// Watches the open directory with this descriptor. `rescan` replaces the usual interval (inotify 30 s, poll 1 s).
/// FailureKind::internal if inotify does not work here; the message says why.
[[nodiscard]] Result<std::unique_ptr<FolderWatch>> watch_folder(int directory, WatchMode mode,
                                                                std::optional<Duration> rescan);

/// The kind of file system on which the open directory lies, if changes on it can go unseen ("NFS"); empty if not.
[[nodiscard]] std::string_view network_file_system(int directory);

} // namespace linefeed::intake
