#include "intake/drop_names.hpp"

#include <climits>

#include <algorithm>
#include <array>
#include <fnmatch.h>

namespace linefeed::intake {

namespace {

constexpr std::size_t longest_kept = NAME_MAX - report_ending.size();
/// Longer ones are not taken for an extension.
constexpr std::size_t longest_extension = 16;
constexpr std::array<std::string_view, 3> sqlite_endings{"-wal", "-shm", "-journal"};

} // namespace

bool is_batch_name(const std::string& name, const std::string& pattern) {
    return ::fnmatch(pattern.c_str(), name.c_str(), FNM_PERIOD | FNM_NOESCAPE) == 0 && marked_name(name).empty() &&
           !is_sqlite_companion(name);
}

std::string marked_name(std::string_view name) {
    return std::string{name.ends_with(done_mark_ending) ? name.substr(0, name.size() - done_mark_ending.size()) : ""};
}

bool is_sqlite_companion(std::string_view name) {
    return std::ranges::any_of(sqlite_endings, [&](std::string_view ending) { return name.ends_with(ending); });
}

std::string kept_name(const std::string& name, unsigned attempt) {
    const std::string number = attempt == 1 ? "" : '~' + std::to_string(attempt);
    const std::size_t dot = name.rfind('.');
    const bool has_extension = dot != std::string::npos && dot > 0 && name.size() - dot <= longest_extension;
    const std::string extension = has_extension ? name.substr(dot) : "";
    std::string stem = name.substr(0, name.size() - extension.size());
    std::size_t room = std::min(stem.size(), longest_kept - number.size() - extension.size());
    const auto is_middle_of_character = [&](std::size_t at) {
        return at < stem.size() && (static_cast<unsigned char>(stem[at]) & 0xC0U) == 0x80U;
    };
    while (room > 1 && is_middle_of_character(room)) {
        --room;
    }
    return stem.substr(0, room) + number + extension;
}

} // namespace linefeed::intake
