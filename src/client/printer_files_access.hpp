// A printer's files for the command line: over the service if P is a name, directly if it is an address.
#pragma once

#include "client/printer_commands.hpp"
#include "client/task_command.hpp"
#include "printer/printer_files.hpp"

#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace linefeed::client {

/// Over the service. Failures are as Service's.
class ServiceFiles : public printer::PrinterFiles {
public:
    ServiceFiles(Service service, PrinterOptions options)
        : service_(std::move(service))
        , options_(std::move(options)) {}
    [[nodiscard]] Result<protocol::VersionInfo> identity() override;
    [[nodiscard]] Result<std::string> loaded_job() override;
    [[nodiscard]] Result<std::vector<protocol::DirectoryEntry>> list(const std::string& directory) override;
    [[nodiscard]] Result<std::string> read(const std::string& path) override;
    [[nodiscard]] Result<bool> exists(const std::string& path) override;
    [[nodiscard]] Result<void> write(const std::string& path, std::string_view bytes) override;
    /// The file `local` as `path`.
    [[nodiscard]] Result<void> send(const std::string& path, const std::filesystem::path& local, bool replace);

private:
    [[nodiscard]] Result<Json> ask(std::string_view task, std::string_view path = {}) const;
    [[nodiscard]] std::string target(const std::string& path) const;

    Service service_;
    PrinterOptions options_;
};

/// Connects to the service.
[[nodiscard]] Result<ServiceFiles> service_files(const PrinterOptions& options);

} // namespace linefeed::client
