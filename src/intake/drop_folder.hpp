// The drop folder: files that others put into a folder become jobs, each once.
//
//     folder/NAME ──settled──> processing/NAME ──hash, import──> done/NAME or failed/NAME, with a report beside it
//
// A crash at any moment neither loses nor doubles a batch, because a file is always in exactly one of these places and
// moves on only when what comes before is durable: the job is committed, with the file's hash, before the file leaves
// processing/. What lies in processing/ at the start is taken up again, and the spool knows by hash and file whether it
// was imported. The claim is synced to the disk before the job is made; every other rename that a power failure undoes
// is done again.
//
// Not handled: a writer that was silent for the whole quiet time and writes on after the file was claimed is only found
// out while the file is being read (then it is read again later); what it writes after that is in done/, not in the
// job.
#pragma once

#include "intake/batch_store.hpp"
#include "intake/drop_directory.hpp"
#include "intake/drop_report.hpp"
#include "intake/folder_watch.hpp"
#include "intake/layout.hpp"
#include "intake/settling.hpp"

#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace linefeed::intake {

struct DropSettings {
    std::filesystem::path folder{};
    std::string pattern = "*.csv"; ///< shell pattern, see is_batch_name()
    SettleRule settle{};
    std::optional<WatchMode> mode{};  ///< absent = inotify, but poll on network file systems
    std::optional<Duration> rescan{}; ///< see watch_folder()
    Layout layout{};
    std::int64_t started_ns = 0; ///< what came before that time, since the Unix epoch, is left over; 0 = nothing is
    bool refuse_grown = true;    ///< a file that begins with all the records of an earlier one and has more fails
    std::uint64_t max_bytes = std::uint64_t{64} << 30U; ///< larger files fail unread
};

/// The moments between which a crash makes a difference.
enum class DropStep {
    settled,  ///< the file will be claimed
    claimed,  ///< it is in processing/, its done mark perhaps still there
    hashed,   ///< its content is known
    imported, ///< its job is committed, or it is known that there will be none
    reported, ///< its report is written
    moved,    ///< it is in done/ or failed/
};

/// What a drop folder tells, from within step(). Names are raw bytes: escape them.
class DropEvents {
public:
    virtual ~DropEvents() = default;
    /// What has come of a file. It is about to be moved; after a crash it may be told a second time, never not at all.
    virtual void finished(const DropReport& report) = 0;
    /// A file stays where it is for now, and why; an empty name = about the folder.
    virtual void note(const std::string& name, const std::string& words) = 0;
    /// A file is about to become a job. `left_over` = it came before DropSettings::started_ns.
    virtual void importing(const std::string& /*name*/, bool /*left_over*/) {}
    /// A long file: how much of it has been read, 0…1, first for its hash, then for its `rows`. False breaks off.
    [[nodiscard]] virtual bool progress(const std::string& name, std::uint64_t rows, double fraction) = 0;
    /// For tests of crashes.
    virtual void reached(DropStep) {}
};

/// Flow: open(), then step() again and again, each time when the last one said so or descriptor() is readable. One
/// thread. `store` and `events` must outlive it.
class DropFolder {
public:
    /// Makes and locks the folders and begins to watch. See DropDirectory::open() and watch_folder() for the failures.
    [[nodiscard]] static Result<DropFolder> open(DropSettings settings, BatchStore& store, DropEvents& events);

    struct Next {
        bool more = false; ///< call step() again at once
        Instant at{};      ///< otherwise then, or when descriptor() is readable
        bool idle = false; ///< nothing that is here now will be taken just by waiting; see staying()
    };
    /// Takes what has happened, and handles at most one file. A failure leaves the file in processing/, where the next
    /// step, or the next start, takes it up again: FailureKind::storage if the store or the folder cannot be written,
    /// or the folder is not where it was any more (then only open() helps); FailureKind::internal if the file cannot be
    /// opened for now, FailureKind::stopped if events.progress() has broken it off.
    [[nodiscard]] Result<Next> step(Instant now);

    /// Readable when something has happened; -1 = only time tells. A file that is being written makes it readable all
    /// the time: twenty looks a second are enough.
    [[nodiscard]] int descriptor() const { return watch_->descriptor(); }
    [[nodiscard]] WatchMode mode() const { return mode_; }
    [[nodiscard]] const std::filesystem::path& path() const { return directory_.path(); }

    struct Staying {
        std::string name;
        std::string why;
    };
    /// The batches in the folder that are not taken yet, in order of their names.
    [[nodiscard]] std::vector<Staying> staying() const;

private:
    DropFolder(DropSettings settings, DropDirectory directory, std::unique_ptr<FolderWatch> watch, WatchMode mode,
               BatchStore& store, DropEvents& events);

    // drop_folder.cpp: which file is next
    /// A name in the folder that could be a batch.
    struct Candidate {
        SettlingFile file;
        std::optional<Instant> due; ///< in due_; absent = held until something happens
        std::string why;            ///< it is not taken yet
        Instant since{};            ///< … and since when for this reason
        bool told = false;          ///< … and whether that was said
    };
    using Candidates = std::map<std::string, Candidate>;
    void take_up_claimed(const std::vector<std::string>& names);
    [[nodiscard]] Result<void> scan(Instant now);
    [[nodiscard]] Result<void> take_events(Instant now);
    void take_event(const FolderEvent& event, Instant now);
    void look_at(Candidates::iterator candidate, std::optional<Instant> due);
    void forget(Candidates::iterator candidate);
    /// Decides about one candidate that is due; claims it if it is ready.
    void consider(Candidates::iterator candidate, Instant now);
    void put_off(Candidates::iterator candidate, const SettleDecision& decision, Instant now);
    [[nodiscard]] Next next(Instant now) const;

    // drop_batch.cpp: one claimed file
    struct Claimed {
        std::string kept;     ///< in processing/
        std::string name;     ///< it was dropped under
        Instant not_before{}; ///< it changed under our eyes
        bool begun = false;   ///< its import, now or before the start: its job may be there already
        bool told = false;    ///< that it changes
        bool left_over = false;
    };
    /// True if it is over, false if it is to be read again later.
    [[nodiscard]] Result<bool> handle(Claimed& batch, Instant now);
    [[nodiscard]] Result<DropReport> read(Claimed& batch, const FileLook& look, bool& changed);
    [[nodiscard]] bool is_changed(const Claimed& batch, const FileLook& before) const;
    [[nodiscard]] Result<std::string> hash(const Claimed& batch, FileInput& file);
    [[nodiscard]] Result<void> import(const Claimed& batch, FileInput file, const FileLook& look,
                                      const spool::JobSpec& spec, DropReport& report, bool& changed);
    [[nodiscard]] Result<void> finish(const Claimed& batch, DropReport& report);

    DropSettings settings_;
    DropDirectory directory_;
    std::unique_ptr<FolderWatch> watch_;
    WatchMode mode_;
    BatchStore& store_;
    DropEvents& events_;
    std::string layout_json_;

    Candidates candidates_; ///< as many as there are files
    std::set<std::pair<Instant, std::string>> due_;
    std::deque<Claimed> claimed_;
    std::optional<Instant> scan_at_; ///< absent = at once
    std::vector<FolderEvent> read_events_;
};

} // namespace linefeed::intake
