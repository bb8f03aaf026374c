// Directories, masks and files, see file_system.hpp.
#include "simulator/file_system.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace linefeed::simulator {
namespace {

constexpr std::uint64_t bytes_per_kbyte = 1024;
constexpr std::uint64_t free_at_first = 24576 * bytes_per_kbyte;
constexpr std::size_t no_file = SIZE_MAX;

/// Protocol, section 8: the files of the manual's examples, in their order.
constexpr std::array<std::string_view, 6> jobs{"COUNTER.JOB",   "DATE.JOB",  "DM.JOB",
                                               "Testprint.job", "LINIE.job", "LJ24 Test.job"};
constexpr std::array<std::string_view, 9> fonts{"ISO1_5x5.lft",   "ISO1_7x5.lft",   "ISO1_9x7.lft",
                                                "ISO1_12x8.lft",  "ISO1_14x10.lft", "ISO1_16x10.lft",
                                                "ISO1_24x18.lft", "ISO1_32x20.lft", "ISO1_5x7flue.lft"};
constexpr std::size_t font_bytes = 5000; ///< more than two blocks

char upper(char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

bool same(std::string_view a, std::string_view b) {
    return std::ranges::equal(a, b, {}, upper, upper);
}

std::string_view without_outer_backslashes(std::string_view path) {
    while (path.starts_with('\\')) {
        path.remove_prefix(1);
    }
    while (path.ends_with('\\')) {
        path.remove_suffix(1);
    }
    return path;
}

bool has_joker(std::string_view text) {
    return text.find_first_of("*?") != std::string_view::npos;
}

/// A job in the language of LJ scripts, of which the simulator knows no more than its lines and the texts of its
/// objects.
std::string job_script(std::string_view name) {
    std::string script = "JLPAR [60 1 0 3 10000 0 0 00:00 1 7000 0 0 1000 0 0]\r\nBEGINJOB [0 (";
    script.append(name).append(")]\r\nJOBPAR [0 0 0 100 0 0 0 0 () 1 1 55000 0 1]\r\nOBJ [1 0 0 0 (ISO1_7x5) (");
    script.append(name.substr(0, name.find('.'))).append(") 1 0 0 0 0 1 0 0 0 0 0 () () 0 0 ()]\r\nENDJOB []\r\n");
    return script;
}

/// Bytes that differ from font to font: no program reads them, but every one must come back.
std::string font_content(std::string_view name) {
    std::string content;
    content.reserve(font_bytes);
    for (std::size_t i = 0; i < font_bytes; ++i) {
        content.push_back(static_cast<char>(name[i % name.size()] + static_cast<char>(i * 7 % 251)));
    }
    return content;
}

} // namespace

bool matches(std::string_view name, std::string_view mask) {
    if (mask == "*.*") {
        return true;
    }
    std::size_t at = 0;
    std::size_t in_mask = 0;
    std::size_t star = std::string_view::npos; // the last `*` seen, and where the name stood then
    std::size_t behind_star = 0;
    while (at < name.size()) {
        if (in_mask < mask.size() && mask[in_mask] == '*') {
            star = in_mask++;
            behind_star = at;
        } else if (in_mask < mask.size() && (mask[in_mask] == '?' || upper(mask[in_mask]) == upper(name[at]))) {
            ++in_mask;
            ++at;
        } else if (star != std::string_view::npos) {
            in_mask = star + 1;
            at = ++behind_star;
        } else {
            return false;
        }
    }
    return mask.find_first_not_of('*', in_mask) == std::string_view::npos;
}

FileSystem::FileSystem(const protocol::Profile& profile) {
    std::vector<std::string> roots{"FFSDISK"};
    if (profile.has_sd_card()) {
        roots.emplace_back("Storage Card\\LJ3");
    }
    roots.emplace_back(profile.usb_root());
    for (const std::string& root : roots) {
        for (const char* const folder : {"\\Jobs", "\\Fonts", "\\Graphics"}) {
            directories_.push_back(root + folder);
        }
    }
    for (const std::string_view name : jobs) {
        files_.push_back({directories_[0], std::string{name}, job_script(name)});
    }
    for (const std::string_view name : fonts) {
        files_.push_back({directories_[1], std::string{name}, font_content(name)});
    }
    flash_capacity_ = flash_bytes() + free_at_first;
}

FileSystem::Place FileSystem::place_of(std::string_view path) {
    path = without_outer_backslashes(path);
    const std::size_t last = path.rfind('\\');
    return last == std::string_view::npos
               ? Place{{}, path}
               : Place{without_outer_backslashes(path.substr(0, last)), path.substr(last + 1)};
}

const std::string* FileSystem::directory(std::string_view path) const {
    path = without_outer_backslashes(path);
    const auto found =
        std::ranges::find_if(directories_, [path](const std::string& directory) { return same(directory, path); });
    const bool there = found != directories_.end() && (stick_present_ || !found->starts_with("USB-Stick"));
    return there ? &*found : nullptr;
}

std::vector<protocol::DirectoryEntry> FileSystem::entries_of(std::string_view parent, std::string_view mask) const {
    std::vector<protocol::DirectoryEntry> entries;
    for (const std::string& path : directories_) {
        if (directory(path) == nullptr ||
            (!parent.empty() && (path.size() <= parent.size() || !same(path.substr(0, parent.size()), parent) ||
                                 path[parent.size()] != '\\'))) {
            continue;
        }
        const std::string_view below = std::string_view{path}.substr(parent.empty() ? 0 : parent.size() + 1);
        const protocol::DirectoryEntry entry{std::string{below.substr(0, below.find('\\'))}, true};
        if (matches(entry.name, mask) && std::ranges::find(entries, entry) == entries.end()) {
            entries.push_back(entry);
        }
    }
    const std::string* const folder = directory(parent);
    for (const File& file : files_) {
        if (folder != nullptr && file.directory == *folder && matches(file.name, mask)) {
            entries.push_back({file.name, false});
        }
    }
    return entries;
}

std::vector<protocol::DirectoryEntry> FileSystem::list(std::string_view path) const {
    const Place place = place_of(path);
    if (!has_joker(place.name)) {
        return entries_of(place.directory, place.name);
    }
    const std::string_view whole = without_outer_backslashes(path);
    if (whole.ends_with('*')) {
        const std::string_view named = whole.substr(0, whole.size() - 1);
        if (!named.empty() && named.back() != '\\' && directory(named) != nullptr) {
            return entries_of(named, "*");
        }
    }
    return entries_of(place.directory, place.name);
}

std::size_t FileSystem::find(std::string_view path) const {
    const Place place = place_of(path);
    // A name alone is that of a job.
    const std::string* const folder = place.directory.empty() ? &directories_.front() : directory(place.directory);
    const auto found = std::ranges::find_if(files_, [&](const File& file) {
        return folder != nullptr && file.directory == *folder && same(file.name, place.name);
    });
    return found == files_.end() ? no_file : static_cast<std::size_t>(found - files_.begin());
}

const std::string* FileSystem::read(std::string_view path) const {
    const std::size_t index = find(path);
    return index == no_file ? nullptr : &files_[index].bytes;
}

bool FileSystem::write(std::string_view path, std::string bytes) {
    const Place place = place_of(path);
    const std::string* const folder = directory(place.directory);
    if (folder == nullptr || place.name.empty() || has_joker(place.name)) {
        return false;
    }
    const std::size_t index = find(path);
    const std::uint64_t replaced = index == no_file ? 0 : files_[index].bytes.size();
    const bool on_flash = folder->starts_with("FFSDISK");
    if (on_flash && flash_bytes() - replaced + bytes.size() > flash_capacity_) {
        return false;
    }
    if (index == no_file) {
        files_.push_back({*folder, std::string{place.name}, std::move(bytes)});
    } else {
        files_[index].bytes = std::move(bytes);
    }
    return true;
}

bool FileSystem::remove(std::string_view path) {
    const std::size_t index = find(path);
    if (index == no_file) {
        return false;
    }
    files_.erase(files_.begin() + static_cast<std::ptrdiff_t>(index));
    return true;
}

std::uint64_t FileSystem::flash_bytes() const {
    std::uint64_t bytes = 0;
    for (const File& file : files_) {
        bytes += file.directory.starts_with("FFSDISK") ? file.bytes.size() : 0;
    }
    return bytes;
}

std::uint32_t FileSystem::free_kbyte() const {
    return static_cast<std::uint32_t>((flash_capacity_ - flash_bytes()) / bytes_per_kbyte);
}

} // namespace linefeed::simulator
