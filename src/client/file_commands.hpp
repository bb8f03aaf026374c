// `linefeed printer P files get|put`, `backup`, `restore`, `script get|send`, `preview`: what has a file on this side.
#pragma once

#include "client/printer_commands.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

namespace linefeed::client {

struct FileOptions {
    PrinterOptions printer;
    std::string path;            ///< in the printer
    std::filesystem::path local; ///< here; empty = under the printer's name for it
    bool replace = false;
};
/// The file is there whole, or not at all.
[[nodiscard]] ExitCode run_file_get(const FileOptions& options);
[[nodiscard]] ExitCode run_file_put(const FileOptions& options);

struct FolderOptions {
    PrinterOptions printer;
    std::filesystem::path folder;
    bool other_printer = false;
    bool yes = false;
};
[[nodiscard]] ExitCode run_backup(const FolderOptions& options);
[[nodiscard]] ExitCode run_restore(const FolderOptions& options);

struct ScriptOptions {
    PrinterOptions printer;
    std::filesystem::path file; ///< empty = stdout
    bool replace = false;       ///< the file that is there
    bool yes = false;
};
[[nodiscard]] ExitCode run_script_get(const ScriptOptions& options);
[[nodiscard]] ExitCode run_script_send(const ScriptOptions& options);

struct PreviewOptions {
    PrinterOptions printer;
    std::filesystem::path png; ///< empty = none: on the terminal
    bool replace = false;      ///< the file that is there
    std::uint32_t scale = 4;   ///< pixels of a dot
    bool ascii = false;
};
[[nodiscard]] ExitCode run_preview(const PreviewOptions& options);

} // namespace linefeed::client
