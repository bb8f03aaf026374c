// A printer's files for whoever backs them up or restores them: over a conversation of one's own, or through the
// service.
#pragma once

#include "base/failure.hpp"
#include "printer/file_transfer.hpp"
#include "printer/printer_client.hpp"
#include "protocol/file_messages.hpp"
#include "protocol/machine_messages.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace linefeed::printer {

/// Fails as the functions of file_transfer.hpp.
class PrinterFiles {
public:
    virtual ~PrinterFiles() = default;
    /// What `?VS` tells.
    [[nodiscard]] virtual Result<protocol::VersionInfo> identity() = 0;
    /// Name of the loaded job; empty = it does not tell, e.g. in standby.
    [[nodiscard]] virtual Result<std::string> loaded_job() = 0;
    [[nodiscard]] virtual Result<std::vector<protocol::DirectoryEntry>> list(const std::string& directory) = 0;
    /// Empty if there is none, or nothing in it.
    [[nodiscard]] virtual Result<std::string> read(const std::string& path) = 0;
    [[nodiscard]] virtual Result<bool> exists(const std::string& path) = 0;
    /// Replaces.
    [[nodiscard]] virtual Result<void> write(const std::string& path, std::string_view bytes) = 0;
};

/// Over a conversation, which must outlive it.
class ConversationFiles : public PrinterFiles {
public:
    explicit ConversationFiles(PrinterClient& printer, TransferOptions options = {})
        : printer_(printer)
        , options_(std::move(options)) {}
    [[nodiscard]] Result<protocol::VersionInfo> identity() override;
    [[nodiscard]] Result<std::string> loaded_job() override;
    [[nodiscard]] Result<std::vector<protocol::DirectoryEntry>> list(const std::string& directory) override;
    [[nodiscard]] Result<std::string> read(const std::string& path) override;
    [[nodiscard]] Result<bool> exists(const std::string& path) override;
    [[nodiscard]] Result<void> write(const std::string& path, std::string_view bytes) override;

private:
    PrinterClient& printer_;
    TransferOptions options_;
};

} // namespace linefeed::printer
