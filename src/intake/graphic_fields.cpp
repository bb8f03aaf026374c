#include "intake/graphic_fields.hpp"

#include "intake/file_input.hpp"
#include "intake/image_file.hpp"

#include <cerrno>
#include <fcntl.h>
#include <system_error>
#include <unistd.h>

namespace linefeed::intake {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t max_known = 256;

Failure refused(std::string why) {
    return {FailureKind::input, std::move(why)};
}

/// An open directory.
class Directory {
public:
    explicit Directory(int descriptor)
        : descriptor_(descriptor) {}
    ~Directory() {
        if (descriptor_ >= 0) {
            ::close(descriptor_);
        }
    }
    Directory(const Directory&) = delete;
    Directory& operator=(const Directory&) = delete;
    Directory(Directory&&) = delete;
    Directory& operator=(Directory&&) = delete;

    [[nodiscard]] int get() const { return descriptor_; }
    /// One step further down, never through a symbolic link.
    void enter(const std::string& name) {
        const int next = ::openat(descriptor_, name.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW);
        const int error = errno;
        ::close(descriptor_);
        descriptor_ = next;
        errno = error;
    }

private:
    int descriptor_;
};

/// Why a name cannot be that of an image in the folder; empty: it can.
std::string name_problem(const fs::path& name) {
    if (name.native().find('\0') != std::string::npos || name.filename().empty()) {
        return "no name of a file";
    }
    if (name.is_absolute()) {
        return "an absolute path: name it relative to the folder of the images";
    }
    for (const fs::path& part : name) {
        if (part == "..") {
            return "a path with .., which could lead out of the folder of the images";
        }
    }
    return {};
}

Result<std::string> read_in_folder(const fs::path& folder, const fs::path& name) {
    Directory directory{::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
    for (const fs::path& part : name.parent_path()) {
        if (directory.get() >= 0 && part != ".") {
            directory.enter(part.string());
        }
    }
    if (directory.get() < 0) {
        return refused((folder / name).string() + ": " + std::generic_category().message(errno));
    }
    auto file = FileInput::open_in(directory.get(), name.filename().string(), folder / name);
    if (!file) {
        return file.error();
    }
    if (file->size() > max_image_bytes) {
        return refused((folder / name).string() + ": too large for an image of a record");
    }
    std::string bytes(file->size(), '\0');
    std::size_t size = 0;
    while (size < bytes.size()) {
        const auto more = file->read({bytes.data() + size, bytes.size() - size});
        if (!more) {
            return more.error();
        }
        if (*more == 0) {
            break;
        }
        size += *more;
    }
    bytes.resize(size);
    return bytes;
}

} // namespace

std::optional<GraphicFields::Problem> GraphicFields::apply(std::vector<std::string_view>& fields) {
    texts_.resize(options_.columns.size());
    for (std::size_t i = 0; i < options_.columns.size(); ++i) {
        const std::size_t column = options_.columns[i];
        if (column >= fields.size() || fields[column].empty()) {
            continue;
        }
        auto text = graphic_text(std::string{fields[column]});
        if (!text) {
            return Problem{column, text.error().message};
        }
        texts_[i] = *std::move(text);
        fields[column] = texts_[i];
    }
    return std::nullopt;
}

Result<std::string> GraphicFields::graphic_text(const std::string& field) {
    if (field.starts_with('(')) {
        const auto graphic = protocol::parse_graphic(field);
        if (!graphic) {
            return refused("this is no graphic: (height width hex) is wanted, up to " +
                           std::to_string(options_.max_height) +
                           " dots high, with two hex digits for each 8 dots of each stroke");
        }
        if (graphic->height > options_.max_height) {
            return refused("the graphic is " + std::to_string(graphic->height) + " dots high, the printer takes " +
                           std::to_string(options_.max_height));
        }
        return field;
    }
    if (const auto known = known_.find(field); known != known_.end()) {
        return known->second;
    }
    auto text = image_text(field);
    if (text) {
        if (known_.size() == max_known) {
            known_.clear();
        }
        known_.emplace(field, *text);
    }
    return text;
}

Result<std::string> GraphicFields::image_text(const std::string& name) const {
    if (options_.folder.empty()) {
        return refused("an image file, and the layout has no folder for images: set graphics_folder");
    }
    if (const std::string problem = name_problem(name); !problem.empty()) {
        return refused("this is " + problem);
    }
    const auto bytes = read_in_folder(options_.folder, name);
    if (!bytes) {
        return bytes.error();
    }
    const auto graphic = read_image(*bytes, options_.max_height);
    if (!graphic) {
        return refused((options_.folder / name).string() + ": " + graphic.error().message);
    }
    std::string text;
    protocol::append_graphic(text, *graphic);
    return text;
}

} // namespace linefeed::intake
