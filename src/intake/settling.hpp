// When is a dropped file complete? A file that is read too early gives half a batch, and nothing in it says so. Facts
// and time come in, a decision comes out: no clock, no file system.
#pragma once

#include "base/time.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace linefeed::intake {

/// How the files of a folder come to be complete. In every case a done mark settles its file at once, and a file that
/// is known to be open for writing, or that has a second name (a hard link), stays.
enum class SettleBy {
    quiet,     ///< unchanged for a time: written in place
    renaming,  ///< there is complete, because it was renamed into place; one seen to be made in place has to be quiet
    done_mark, ///< when NAME.done lies beside NAME, not older than its last change
};

struct SettleRule {
    SettleBy by = SettleBy::quiet;
    Duration quiet = std::chrono::seconds{2}; ///< > 0. An empty file has five times as long to get its first byte
};

/// "rename", "done", "quiet" or "quiet=TIME" with a time in ms, s or min above 0 and up to a day; absent = none of
/// them.
[[nodiscard]] std::optional<SettleRule> parse_settle_rule(std::string_view text);

enum class FileKind { regular, directory, symbolic_link, other };

/// What a name in the folder is like, its link not followed.
struct FileLook {
    FileKind kind = FileKind::regular;
    std::uint64_t device = 0;
    std::uint64_t inode = 0;
    std::uint64_t size_bytes = 0;
    std::int64_t modified_ns = 0; ///< since the Unix epoch; whoever writes the file may set it
    std::int64_t changed_ns = 0;  ///< since the Unix epoch; the kernel's word about content, names and rights
    std::uint64_t names = 1;      ///< hard links

    friend bool operator==(const FileLook&, const FileLook&) = default;
};

/// The same file with the same content, as far as a look can tell; perhaps under another name.
[[nodiscard]] inline bool same_content(const FileLook& a, const FileLook& b) {
    return a.kind == b.kind && a.device == b.device && a.inode == b.inode && a.size_bytes == b.size_bytes &&
           a.modified_ns == b.modified_ns;
}

struct SettleDecision {
    enum class Kind {
        ready, ///< take it
        wait,  ///< look again at `until`
        hold,  ///< only an event or another look in good time can change it
    };
    Kind kind = Kind::wait;
    Instant until{};   ///< for wait
    std::string why{}; ///< not taken yet
};

/// One name in the folder. Flow: what the watch says of it, in any order; decide() at each look.
class SettlingFile {
public:
    // What the watch has seen, if it sees such things
    void created() { *this = SettlingFile{}, in_place_ = true, never_closed_ = true; }
    void moved_in() { *this = SettlingFile{}; }
    void modified() { open_for_writing_ = true; }
    void closed() { open_for_writing_ = false, never_closed_ = false; }
    /// Events are missing: nothing is known of its writers, and how long it has been quiet counts anew.
    void events_lost() { open_for_writing_ = false, never_closed_ = false, look_.reset(); }

    /// `mark` is the look at its done mark, if there is one.
    [[nodiscard]] SettleDecision decide(const SettleRule& rule, const FileLook& look,
                                        const std::optional<FileLook>& mark, Instant now);

private:
    bool in_place_ = false;     ///< seen to be made here …
    bool never_closed_ = false; ///< … and not closed since
    bool open_for_writing_ = false;
    std::optional<FileLook> look_; ///< the last one …
    Instant since_{};              ///< … and since when it is like this
};

} // namespace linefeed::intake
