// `linefeed print --dry-run`: what would be sent, without sending it and without changing anything. The file is
// imported into a spool that vanishes; the real one is only read, to say what a real run would find in it.
#pragma once

#include "base/failure.hpp"
#include "cli/exit_code.hpp"
#include "cli/print_options.hpp"
#include "spool/spool.hpp"

#include <filesystem>

namespace linefeed::cli {

/// A directory of its own for a spool that is gone with the object.
class TemporaryDirectory {
public:
    [[nodiscard]] static Result<TemporaryDirectory> make();
    TemporaryDirectory(TemporaryDirectory&& other) noexcept;
    ~TemporaryDirectory();
    TemporaryDirectory(const TemporaryDirectory&) = delete;
    TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
    TemporaryDirectory& operator=(TemporaryDirectory&&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    explicit TemporaryDirectory(std::filesystem::path path);
    std::filesystem::path path_;
};

/// Shows the first frames of `wanted`, and how many of these records options.spool knows as printed or in doubt. `job`
/// lies in `temporary`.
[[nodiscard]] Result<ExitCode> show_dry_run(const PrintOptions& options, spool::Spool& temporary, const spool::Job& job,
                                            RecordRange wanted);

} // namespace linefeed::cli
