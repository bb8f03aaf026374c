#include "printer/local_file.hpp"

#include "base/assert.hpp"

#include <openssl/evp.h>

#include <array>
#include <cerrno>
#include <fcntl.h>
#include <fstream>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace linefeed::printer {

namespace {

Failure storage(const std::filesystem::path& path, int error) {
    return {FailureKind::storage, path.string() + ": " + std::generic_category().message(error)};
}

std::filesystem::path directory_of(const std::filesystem::path& path) {
    const auto parent = path.parent_path();
    return parent.empty() ? std::filesystem::path{"."} : parent;
}

/// As a file that is made in the ordinary way.
constexpr mode_t usual_mode = 0644;

} // namespace

NewFile::NewFile(std::filesystem::path path, std::string temporary, int descriptor, Existing existing)
    : path_(std::move(path))
    , temporary_(std::move(temporary))
    , descriptor_(descriptor)
    , existing_(existing) {}

NewFile::NewFile(NewFile&& other) noexcept
    : path_(std::move(other.path_))
    , temporary_(std::exchange(other.temporary_, {}))
    , descriptor_(std::exchange(other.descriptor_, -1))
    , existing_(other.existing_) {}

NewFile::~NewFile() {
    if (descriptor_ >= 0) {
        ::close(descriptor_);
    }
    if (!temporary_.empty()) {
        ::unlink(temporary_.c_str());
    }
}

Failure name_taken(const std::filesystem::path& path) {
    return {FailureKind::usage, path.string() + ": there is something of that name already"};
}

Result<NewFile> NewFile::create(const std::filesystem::path& path, Existing existing) {
    struct stat status {};
    const bool taken = ::lstat(path.c_str(), &status) == 0;
    if (taken && (existing == Existing::refuse || !S_ISREG(status.st_mode))) {
        return name_taken(path);
    }
    std::string temporary = (directory_of(path) / ".linefeed-XXXXXX").string();
    const int descriptor = ::mkostemp(temporary.data(), O_CLOEXEC);
    if (descriptor < 0) {
        return storage(path, errno);
    }
    const mode_t mask = ::umask(0);
    ::umask(mask);
    ::fchmod(descriptor, usual_mode & ~mask);
    return NewFile{path, std::move(temporary), descriptor, existing};
}

Result<void> NewFile::write(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written >= 0) {
            bytes.remove_prefix(static_cast<std::size_t>(written));
        } else if (errno != EINTR) {
            return storage(path_, errno);
        }
    }
    return {};
}

Result<void> NewFile::commit() {
    LINEFEED_ASSERT(!temporary_.empty());
    if (::fsync(descriptor_) != 0) {
        return storage(path_, errno);
    }
    if (::close(std::exchange(descriptor_, -1)) != 0) {
        return storage(path_, errno);
    }
    // A link fails where the name has been taken meanwhile; a rename replaces.
    const bool named = existing_ == Existing::replace ? ::rename(temporary_.c_str(), path_.c_str()) == 0
                                                      : ::link(temporary_.c_str(), path_.c_str()) == 0;
    if (!named) {
        return errno == EEXIST ? name_taken(path_) : storage(path_, errno);
    }
    if (existing_ == Existing::refuse) {
        ::unlink(temporary_.c_str());
    }
    temporary_.clear();
    const int directory = ::open(directory_of(path_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (directory >= 0) {
        ::fsync(directory); // some file systems cannot
        ::close(directory);
    }
    return {};
}

Result<std::string> read_file(const std::filesystem::path& path, std::uint64_t max_bytes) {
    const auto refused = [&path](const std::string& why) {
        return Failure{FailureKind::input, path.string() + ": " + why};
    };
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) {
        return refused(error ? error.message() : "this is no file");
    }
    std::ifstream in{path, std::ios::binary};
    std::string bytes;
    std::array<char, std::size_t{64} * 1024> buffer{};
    while (in.read(buffer.data(), buffer.size()) || in.gcount() > 0) {
        bytes.append(buffer.data(), static_cast<std::size_t>(in.gcount()));
        if (bytes.size() > max_bytes) {
            return refused("the file has more than " + std::to_string(max_bytes) + " bytes");
        }
    }
    return in.eof() ? Result<std::string>{std::move(bytes)} : refused("it cannot be read");
}

std::string sha256_hex(std::string_view bytes) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned size = 0;
    const int done = EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr);
    LINEFEED_ASSERT(done == 1);
    std::string hex;
    for (unsigned i = 0; i < size; ++i) {
        hex.push_back(digits[digest[i] >> 4U]);
        hex.push_back(digits[digest[i] & 0xFU]);
    }
    return hex;
}

} // namespace linefeed::printer
