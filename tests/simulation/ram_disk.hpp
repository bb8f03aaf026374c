// The host's disk in memory, as an SQLite VFS: fast, and it can die. A killed process stops writing in the middle of an
// operation; a power failure drops, keeps or tears each write that was not synced; a full disk refuses writes.
#pragma once

#include "random.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

struct sqlite3_file;
struct sqlite3_vfs;

namespace linefeed::simulation {

/// Name under which SQLite knows it.
inline constexpr const char* ram_disk_vfs = "linefeed-ram";

/// One file.
struct RamFile {
    /// A write that no sync has made durable yet.
    struct Unsynced {
        std::size_t offset = 0;
        std::string before; ///< what stood there
        std::string after;
        std::size_t size_before = 0;
        bool truncates = false; ///< the new size is `offset`
    };
    std::string bytes;
    std::vector<Unsynced> unsynced;
    std::vector<std::unique_ptr<char[]>> shared_memory; ///< of the WAL index; dies with the process
};

class RamDisk {
public:
    /// The one disk; registers the VFS at its first use.
    [[nodiscard]] static RamDisk& instance();

    /// Removes all files, and remembers unsynced writes from now on or not (only needed for power failures).
    void format(bool remembers_unsynced);
    /// The process dies behind the next `writes` writes and syncs: what it writes then does not reach the disk.
    void stop_after(std::uint64_t writes) { writes_left_ = writes; }
    /// The process is dead and gone: its shared memory with it. Another may use the disk.
    void process_gone();
    /// Each unsynced write is kept, dropped or torn at a sector.
    void lose_power(Random& random);
    void set_full(bool full) { full_ = full; }
    [[nodiscard]] std::uint64_t syncs() const { return syncs_; }
    /// Writes that found the disk full.
    [[nodiscard]] std::uint64_t refusals() const { return refusals_; }

    // For the VFS
    [[nodiscard]] std::shared_ptr<RamFile> open(const char* name);
    [[nodiscard]] bool exists(const std::string& name) const { return files_.contains(name); }
    void remove(const std::string& name);
    [[nodiscard]] int write(RamFile& file, std::size_t offset, const char* data, std::size_t size);
    [[nodiscard]] int truncate(RamFile& file, std::size_t size);
    [[nodiscard]] int sync(RamFile& file);

private:
    RamDisk();
    /// False when the process is dead already.
    [[nodiscard]] bool reaches_disk();

    static constexpr std::uint64_t forever = ~std::uint64_t{0};

    std::map<std::string, std::shared_ptr<RamFile>> files_;
    std::uint64_t writes_left_ = forever;
    std::uint64_t syncs_ = 0;
    std::uint64_t refusals_ = 0;
    bool remembers_unsynced_ = false;
    bool full_ = false;
};

} // namespace linefeed::simulation
