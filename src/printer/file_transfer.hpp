// Directories and files of the printer (protocol, section 8): listed, read, written and deleted, a block at a time.
// Every block's number and sum is checked; a block that is damaged is asked for, or sent, again, but not for ever.
#pragma once

#include "base/failure.hpp"
#include "printer/printer_client.hpp"
#include "protocol/file_messages.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::printer {

/// Larger files are neither taken nor sent: no printer holds one.
inline constexpr std::uint64_t max_file_bytes = std::uint64_t{64} << 20U;

/// How far a transfer is.
struct TransferProgress {
    std::uint32_t blocks = 0; ///< done
    std::uint32_t total = 0;
    std::uint64_t repeated = 0; ///< blocks that had to go more than once
    friend bool operator==(const TransferProgress&, const TransferProgress&) = default;
};

struct TransferOptions {
    /// How often a block is sent, or asked for, before the transfer is given up.
    std::uint32_t attempts = 40;
    /// How long the other side may take for a block: at 9600 baud it is 4.3 s on the line. Not less than the reply
    /// time-out of the connection.
    Duration block_timeout = std::chrono::seconds{15};
    /// Called for each block; false cancels the transfer, which then fails with FailureKind::stopped.
    std::function<bool(const TransferProgress&)> on_progress = [](const TransferProgress&) { return true; };
};

/// What is at the path, which may have jokers; all blocks put together, names as the printer's bytes. Empty: nothing is
/// there. FailureKind::unreachable: no answer.
[[nodiscard]] Result<std::vector<protocol::DirectoryEntry>> list_files(PrinterClient& printer, const std::string& path);
/// What is in a directory. Asked as in the manual, `FFSDISK\Jobs*`, and where that tells nothing as `FFSDISK\Jobs\*`.
[[nodiscard]] Result<std::vector<protocol::DirectoryEntry>> list_directory(PrinterClient& printer,
                                                                           const std::string& path);

/// Takes the bytes of a file as they come; a failure cancels the transfer and is what it fails with.
using FileSink = std::function<Result<void>(std::string_view bytes)>;

/// What came of reading a file. A missing file and an empty one answer alike.
enum class FileFound { yes, empty_or_missing };

/// Reads a file. FailureKind::unreachable: no answer, or the connection broke; ::stopped: cancelled by either side;
/// ::input: blocks stay damaged, or the file is larger than max_file_bytes.
[[nodiscard]] Result<FileFound> download(PrinterClient& printer, const std::string& path, const FileSink& sink,
                                         const TransferOptions& options = {});
/// The same into memory.
[[nodiscard]] Result<std::string> download(PrinterClient& printer, const std::string& path,
                                           const TransferOptions& options = {});

/// Writes a file, replacing one of that name. Fails as download(); the printer cancels where it has no room or the
/// directory is none of its own.
[[nodiscard]] Result<void> upload(PrinterClient& printer, const std::string& path, std::string_view bytes,
                                  const TransferOptions& options = {});

/// As upload(), of which nobody says afterwards that he did not mean it: FailureKind::usage where a file of that name
/// is there and is not to be replaced; ::stopped where it is, and the machine prints.
[[nodiscard]] Result<void> put_file(PrinterClient& printer, const std::string& path, std::string_view bytes,
                                    bool replace, const TransferOptions& options = {});

/// Deletes a file and looks whether it is gone, as the printer does not answer. FailureKind::input: there is none;
/// ::stopped: it is still there.
[[nodiscard]] Result<void> remove_file(PrinterClient& printer, const std::string& path);

} // namespace linefeed::printer
