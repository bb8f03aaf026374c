// `linefeed import FILE`: the service makes a job of a file.
#pragma once

#include "client/command.hpp"

#include <filesystem>
#include <string>

namespace linefeed::client {

struct ImportOptions {
    CommonOptions common;
    std::filesystem::path file;
    std::string name;    ///< shown instead of the file's; empty = the file's
    std::string layout;  ///< name in the configuration of the service; empty = the default layout
    std::string printer; ///< queue it there; empty = no queue
    bool autostart = false;
    bool again = false;
    bool upload = false; ///< send the content, also over the socket
};

/// Over the socket the service reads the file itself, unless options.upload; over TCP it is sent.
[[nodiscard]] ExitCode run_import(const ImportOptions& options);

} // namespace linefeed::client
