// A body that is a file to print: it goes to the disk piece by piece, beside the spool, and is removed whatever
// happens.
#pragma once

#include "api/problem.hpp"
#include "spool/checksum.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>

namespace linefeed::api {

/// Makes the folder of uploads, for its owner only, and removes what an earlier service left there when it was killed.
[[nodiscard]] Result<void> prepare_uploads(const std::filesystem::path& folder);

/// Flow: create(), append() …, close(); its file is there until it is destroyed. Blocks; one thread at a time.
class Upload {
public:
    /// ProblemType::disk_full or ::storage.
    [[nodiscard]] static Checked<std::unique_ptr<Upload>> create(const std::filesystem::path& folder);
    ~Upload();
    Upload(const Upload&) = delete;
    Upload& operator=(const Upload&) = delete;

    [[nodiscard]] Checked<void> append(std::string_view bytes);
    /// The file is whole; its SHA-256.
    [[nodiscard]] Checked<spool::Sha256Digest> close();
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    Upload(std::filesystem::path path, int fd)
        : path_(std::move(path))
        , fd_(fd) {}

    std::filesystem::path path_;
    int fd_ = -1;
    spool::Sha256 sha256_;
};

} // namespace linefeed::api
