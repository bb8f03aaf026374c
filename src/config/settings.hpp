// Everything that the service can be told, as plain values. Whoever has a Settings may rely on what is written here:
// the loader (config/load.hpp) has checked ranges and references.
#pragma once

#include "base/bounded_list.hpp"
#include "base/real_time_settings.hpp"
#include "base/time.hpp"
#include "config/error_table.hpp"
#include "feeder/feeder.hpp"
#include "link/printer_address.hpp"
#include "protocol/charset.hpp"
#include "protocol/profile.hpp"
#include "protocol/record_properties.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::config {

/// What happens between two jobs of a queue.
enum class Chain {
    stop,     ///< the line stops at the end of each job
    seamless, ///< the next job follows in the same FIFO, with a number-0 start, where printer and job allow it
};

struct QueueSettings {
    /// A job starts by itself when the printer is free; otherwise an operator starts it.
    bool autostart = false;
    Chain chain = Chain::stop;
};

struct PrinterSettings {
    std::string name; ///< unique, also without regard to case and punctuation
    link::PrinterAddress address;
    protocol::Profile profile = protocol::profiles.front();
    /// The printer's job file that must be loaded, e.g. `FFSDISK\JOBS\names.job`; absent = whichever is.
    std::optional<std::string> job_file{};
    /// Open the nozzle for a start if it is closed (30 to 60 s), instead of refusing to start.
    bool open_nozzle = false;
    /// Per error number, instead of what the table says.
    std::map<std::uint32_t, ErrorPolicy> errors{};
    /// Poll bounds: poll_min 400 µs…100 ms, poll_max 1 ms…1 s, poll_min ≤ poll_max. The rest is not a setting.
    feeder::PacingSettings pacing{};
    /// Products a second, 1…10000, that the conveyor is to bring: a start warns where the line to the printer carries
    /// less. Absent = not known.
    std::optional<std::uint32_t> expected_rate{};
    Duration connect_timeout = std::chrono::seconds{3}; ///< 100 ms…10 min
    Duration reply_timeout = std::chrono::seconds{2};   ///< 100 ms…10 min
    /// How often it is looked at while linefeed does nothing with it; 0 (never), or 1 s…1 h.
    Duration watch_interval = std::chrono::seconds{5};
    QueueSettings queue{};
};

/// How a file becomes records: the options of `linefeed print` of the same names.
struct LayoutSettings {
    std::string name;
    std::vector<std::string> columns{}; ///< names or numbers from 1; empty = all
    std::optional<std::string> table{}; ///< SQLite; never together with query
    std::optional<std::string> query{};
    std::optional<char> delimiter{}; ///< CSV; absent = found out from the first line
    bool header = true;
    bool skip_bad = false;
    protocol::Charset encoding = protocol::Charset::latin1;
    std::map<std::string, protocol::Charset> column_encodings{}; ///< by column name, instead of `encoding`
    std::vector<std::string> graphics{};                         ///< columns that are graphics
    std::optional<std::filesystem::path> graphics_folder{};      ///< where images are; absent = beside the file
    std::uint32_t base = 0;                                      ///< record k has number base + k
    bool mirrored = false;
    std::optional<protocol::Orientation> orientation{};

    [[nodiscard]] protocol::RecordProperties properties() const { return {mirrored, orientation, std::nullopt}; }
};

/// How a drop folder learns of files.
enum class Watch {
    inotify, ///< local disks; rescanned every poll_interval besides
    poll,    ///< network shares, which do not tell
};

/// How the other side says that a file is whole.
enum class Settle {
    in_place,       ///< it is written where it lies, and closed
    rename,         ///< it is written elsewhere on the disk and renamed into the folder
    done_companion, ///< FILE is whole once FILE.done is there
};

/// What is done about a file that begins with all the records of an earlier one of the same folder and has more.
enum class GrownFiles {
    refuse, ///< it fails, and the report names the earlier one
    print,  ///< all of it, the earlier records once more
};

struct FolderSettings {
    std::string name;
    std::filesystem::path path; ///< absolute; no two lie in each other, and no file of the service lies in it
    std::string layout;         ///< name of a layout
    std::string printer;        ///< name of a printer
    /// File names that are taken: `*` stands for any characters, `?` for one, `[abc]` for one of them; a leading dot
    /// must be written. Never `.done`. Not simply `*`: that takes what a copying program calls NAME.part meanwhile.
    std::string pattern = "*.csv";
    /// Its jobs may start by themselves, as with the printer's queue.autostart; both must say so.
    bool autostart = false;
    Watch watch = Watch::inotify;
    Settle settle = Settle::in_place;
    Duration poll_interval = std::chrono::seconds{5}; ///< 100 ms…1 h
    GrownFiles grown_files = GrownFiles::refuse;
};

struct HttpSettings {
    /// Numeric IPv4 or IPv6 address. Beyond loopback only with a tokens_file.
    std::string listen = "127.0.0.1";
    std::uint16_t port = 8631; ///< 1…65535
    /// Hashed tokens with their roles.
    std::optional<std::filesystem::path> tokens_file{};
    std::vector<std::string> hosts{};                    ///< accepted in `Host:` besides the address and localhost
    std::vector<std::string> origins{};                  ///< web pages of these origins may call (CORS); empty = none
    std::uint64_t max_body = 16U << 20U;                 ///< bytes; 1 KiB…4 GiB
    std::uint64_t max_header = 16U << 10U;               ///< bytes; 1 KiB…1 MiB
    std::uint32_t max_connections = 256;                 ///< 1…10000
    Duration request_timeout = std::chrono::seconds{30}; ///< for a whole request; 1 s…10 min
};

/// The Unix socket of the command line.
struct ControlSettings {
    std::filesystem::path socket = "/run/linefeed/linefeed.sock"; ///< at most 107 bytes
    std::string group = "linefeed";                               ///< who of it may connect
};

enum class LogLevel { trace, debug, info, warning, error };
enum class LogTarget { journald, standard_error };

/// The parts of the service that have a log level of their own.
enum class LogComponent {
    service, ///< start, stop, reload
    printer, ///< feed thread, sessions, links
    store,   ///< spool and ledger
    intake,  ///< imports
    folder,  ///< drop folders
    api,     ///< Unix socket and HTTP
};
inline constexpr std::size_t log_components = 6;

struct LoggingSettings {
    LogLevel level = LogLevel::info; ///< of components without one of their own
    LogTarget target = LogTarget::journald;
    std::array<std::optional<LogLevel>, log_components> levels{}; ///< indexed by LogComponent

    [[nodiscard]] LogLevel level_of(LogComponent component) const {
        return levels[static_cast<std::size_t>(component)].value_or(level);
    }
};

struct Settings {
    std::filesystem::path spool = "/var/lib/linefeed/spool.db"; ///< absolute
    /// The table of error numbers; absent = none is listed.
    std::optional<std::filesystem::path> errors_file{};
    ErrorTable errors{}; ///< what stands in errors_file
    RealTimeSettings real_time{};
    ControlSettings control{};
    HttpSettings http{};
    LoggingSettings logging{};
    std::vector<LayoutSettings> layouts{};
    std::vector<PrinterSettings> printers{};
    std::vector<FolderSettings> folders{};

    /// By name; nullptr = there is none.
    [[nodiscard]] const PrinterSettings* printer(std::string_view name) const;
    [[nodiscard]] const LayoutSettings* layout(std::string_view name) const;
    /// What to do about an error of that printer: its own policy, the table's, or that for unlisted numbers.
    [[nodiscard]] ErrorPolicy policy(const PrinterSettings& printer, const protocol::PrinterError& error) const;
    /// The numbers that may be acknowledged at that printer (FeederSettings::acknowledge).
    [[nodiscard]] decltype(feeder::FeederSettings::acknowledge) acknowledged(const PrinterSettings& printer) const;
    /// Those that stop that printer (FeederSettings::stop_on).
    [[nodiscard]] feeder::StoppingErrors stopping(const PrinterSettings& printer) const;
};

} // namespace linefeed::config
