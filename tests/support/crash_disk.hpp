// A disk in memory that can lose power. It keeps, for every file, what is durable and which changes since then are not,
// and says what could be found after a power failure at this moment. Tests put SQLite on it (crash_vfs.hpp).
//
// The model of power loss. What is certain to survive:
//   - the content of a file as it was at its last successful sync, and the names as they were at the last sync of the
//     directory (SQLite syncs it with the first sync of a new journal or WAL, and when it deletes with `syncDir`).
// What may or may not survive, each for itself and in any order between two syncs of the file:
//   - every write, or the parts of it that lie in different sectors (512 or 4096 bytes), or a part of a sector;
//   - every truncation, every new or removed name.
// What does not happen: bytes next to a write that was cut short do not change (SQLite's "powersafe overwrite", which
// its unix VFS assumes and so does linefeed), a synced byte does not rot, and no byte appears that was never written:
// a hole reads as zeros.
// A failed sync drops the changes for good while readers go on seeing them, and the next sync succeeds without them: as
// Linux does. When only the process dies, everything stays, and unsynced changes remain unsynced.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::test {

/// Own random numbers (SplitMix64), the same with every library.
class Chance {
public:
    explicit Chance(std::uint64_t seed)
        : state_(seed) {}
    [[nodiscard]] std::uint64_t next();
    /// 0 … bound − 1. Precondition: bound > 0.
    [[nodiscard]] std::uint64_t below(std::uint64_t bound) { return next() % bound; }

private:
    std::uint64_t state_;
};

/// What happens to changes that were not synced when the power fails.
enum class Survival {
    nothing,    ///< all are lost
    everything, ///< all are kept
    prefix,     ///< the first of them, over all files; the one at the edge is torn
    subset,     ///< some, whole, in any order
    torn,       ///< some sectors of some
};
inline constexpr Survival all_survivals[] = {Survival::nothing, Survival::everything, Survival::prefix,
                                             Survival::subset, Survival::torn};

/// Content by path.
using DiskImage = std::map<std::string, std::string>;

/// The files of the disk. Not thread safe.
class CrashDisk {
public:
    using Regions = std::vector<std::unique_ptr<char[]>>;
    /// Locks and shared memory that SQLite keeps for an open file; gone with the processes that hold them.
    struct Sharing {
        int readers = 0;
        const void* reserved = nullptr;
        const void* pending = nullptr;
        const void* exclusive = nullptr;
        static constexpr int shm_locks = 8;
        int shm_readers[shm_locks] = {};
        bool shm_writer[shm_locks] = {};
        int shm_users = 0;
        std::shared_ptr<Regions> shm_regions = std::make_shared<Regions>();
    };

    struct Change {
        std::uint64_t order = 0;
        std::uint64_t offset = 0;        ///< or the new size
        std::optional<std::string> data; ///< absent = truncation
    };
    struct File {
        std::string content; ///< as readers see it
        std::string durable;
        std::vector<Change> unsynced;
        bool temporary = false; ///< has no name: nobody looks for it after a power failure
        Sharing sharing;
    };
    using FilePtr = std::shared_ptr<File>;

    [[nodiscard]] FilePtr find(const std::string& path) const;
    [[nodiscard]] FilePtr create(const std::string& path);
    void remove(const std::string& path);
    void sync_directory();

    void write(File& file, std::uint64_t offset, std::string_view data);
    void truncate(File& file, std::uint64_t size);
    void sync(File& file);
    /// What a failed sync does.
    void forget_unsynced(File& file);

    /// Bytes of all files.
    [[nodiscard]] std::uint64_t used_bytes() const { return used_bytes_; }
    [[nodiscard]] std::size_t unsynced_changes() const;
    /// What can be found if the power fails now. The same seed gives the same image.
    [[nodiscard]] DiskImage image(Survival survival, std::uint64_t seed) const;
    /// Replaces everything; all of it is durable.
    void load(const DiskImage& image);
    /// All processes are gone: nobody holds a lock.
    void release_all();

private:
    struct NameChange {
        std::uint64_t order = 0;
        std::string path;
        FilePtr file; ///< null = removed
    };

    std::map<std::string, FilePtr> names_;
    std::map<std::string, FilePtr> durable_names_;
    std::vector<NameChange> unsynced_names_;
    std::uint64_t order_ = 0;
    std::uint64_t used_bytes_ = 0;
};

} // namespace linefeed::test
