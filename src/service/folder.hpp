// A drop folder of the service: a thread that looks after it, and what people may see of it. A folder that cannot be
// used (not mounted, no rights, the disk full) is tried again and again, and says why meanwhile.
#pragma once

#include "config/settings.hpp"
#include "daemon/operations.hpp"
#include "intake/drop_folder.hpp"
#include "service/batches.hpp"
#include "service/event_log.hpp"
#include "store/event_signal.hpp"

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace linefeed::service {

/// What came of files and records since the service started; over all folders and imports.
struct IntakeCounts {
    std::atomic<std::uint64_t> records{0};
    std::atomic<std::uint64_t> imported{0};
    std::atomic<std::uint64_t> duplicates{0};
    std::atomic<std::uint64_t> failed{0};
};

struct FolderServices {
    SpoolAccess& spool;
    EventLog& events;
    IntakeCounts& counts;
    /// A job has been put into the queue of that printer; called on the folder's thread.
    std::function<void(const std::string& printer)> on_queued;
    std::int64_t started_ns = 0; ///< when the service was started, by the clock of files
    /// A file that came before the service was started becomes a job that may start by itself, once it is in
    /// the queue of that printer; called before it is, on the folder's thread.
    std::function<void(const std::string& printer, const std::string& words)> on_left_over;
};

/// Destroying it breaks off what it imports: it is taken up again at the next start.
class Folder final : private intake::DropEvents {
public:
    /// Precondition: `settings` are among `all`, with layout and printer.
    Folder(const FolderServices& services, const config::FolderSettings& settings, const config::Settings& all);
    ~Folder() override;
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    /// Any thread.
    [[nodiscard]] daemon::FolderView view() const;

private:
    void serve();
    [[nodiscard]] Result<void> watch();
    void wait(int descriptor, Instant until);
    void up(const intake::DropFolder& folder);
    void down(const Failure& why);
    void count(std::uint64_t& shown, std::atomic<std::uint64_t>& of_service);
    void adopt(spool::JobId id);
    void event(std::string_view kind, std::string message, std::optional<spool::JobId> job = {});

    void finished(const intake::DropReport& report) override;
    void note(const std::string& name, const std::string& words) override;
    void importing(const std::string& name, bool left_over) override;
    [[nodiscard]] bool progress(const std::string& name, std::uint64_t rows, double fraction) override;

    FolderServices services_;
    std::string name_;
    std::string printer_;
    bool autostart_;
    intake::DropSettings settings_;
    Batches batches_;
    store::EventSignal wake_;
    std::atomic<bool> closing_{false};

    mutable std::mutex mutex_; ///< for what follows
    daemon::FolderView view_;

    std::thread thread_;
};

} // namespace linefeed::service
