// Which kind of source a file is, and what a file looks like from outside.
#include "intake/row_source.hpp"

#include "intake/csv_source.hpp"
#include "intake/sqlite_source.hpp"

#include <cerrno>
#include <sys/stat.h>
#include <system_error>

namespace linefeed::intake {

Result<std::unique_ptr<RowSource>> open_source(const std::filesystem::path& file, const SourceOptions& options) {
    auto input = FileInput::open(file);
    if (!input) {
        return input.error();
    }
    return open_source(std::move(*input), options);
}

Result<std::unique_ptr<RowSource>> open_source(FileInput file, const SourceOptions& options) {
    return file.is_sqlite() ? SqliteSource::open(file.path(), options) : CsvSource::open(std::move(file), options);
}

Result<spool::SourceFingerprint> fingerprint(const std::filesystem::path& file) {
    const auto input = FileInput::open(file);
    if (!input) {
        return input.error();
    }
    std::error_code error;
    const std::filesystem::path absolute =
        std::filesystem::weakly_canonical(std::filesystem::absolute(file, error), error);
    struct stat status {};
    if (error || ::stat(absolute.c_str(), &status) != 0) {
        return Failure{FailureKind::input,
                       file.string() + ": " + std::generic_category().message(error ? error.value() : errno)};
    }
    spool::SourceFingerprint print;
    print.path = absolute.string();
    print.size_bytes = static_cast<std::uint64_t>(status.st_size);
    print.modified_ns = modified_ns(status);
    print.inode = status.st_ino;
    // An empty WAL holds nothing, and reading alone may create one.
    struct stat wal {};
    const std::string wal_path = print.path + "-wal";
    if (input->is_sqlite() && ::stat(wal_path.c_str(), &wal) == 0 && wal.st_size > 0) {
        print.companion =
            std::to_string(wal.st_size) + ':' + std::to_string(modified_ns(wal)) + ':' + std::to_string(wal.st_ino);
    }
    return print;
}

} // namespace linefeed::intake
