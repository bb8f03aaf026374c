#include "config/problem.hpp"

#include "protocol/charset.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace linefeed::config {

namespace {

/// Appends up to `limit` characters of `text`, none of which can do anything to a terminal.
void append_escaped(std::string& out, std::string_view text, std::size_t limit) {
    for (std::size_t count = 0; !text.empty(); ++count) {
        if (count == limit) {
            out += "...";
            return;
        }
        const auto character = protocol::decode_utf8(text);
        const bool control = character && (character->code_point < 0x20 ||
                                           (character->code_point >= 0x7F && character->code_point < 0xA0));
        // Line and paragraph separators, and the marks that turn the direction of what follows.
        const bool invisible = character && ((character->code_point >= 0x2028 && character->code_point <= 0x202E) ||
                                             (character->code_point >= 0x2066 && character->code_point <= 0x2069));
        const std::size_t bytes = character ? character->bytes : 1;
        if (character && !control && !invisible) {
            out += text.substr(0, bytes);
        } else {
            constexpr std::string_view digits = "0123456789ABCDEF";
            for (const char byte : text.substr(0, bytes)) {
                const auto value = static_cast<unsigned char>(byte);
                out += "\\x";
                out += digits[value >> 4U];
                out += digits[value & 0xFU];
            }
        }
        text.remove_prefix(bytes);
    }
}

constexpr std::size_t no_limit = static_cast<std::size_t>(-1);

} // namespace

std::string in_quotes(std::string_view text) {
    constexpr std::size_t shown = 60;
    std::string out = "\"";
    append_escaped(out, text, shown);
    return out + '"';
}

std::string to_string(const Problem& problem) {
    std::string out;
    if (!problem.place.variable.empty()) {
        append_escaped(out, problem.place.variable, no_limit);
    } else {
        append_escaped(out, problem.file, no_limit);
        if (problem.place.line > 0) {
            out += ':' + std::to_string(problem.place.line) + ':' + std::to_string(problem.place.column);
        }
    }
    if (!problem.key.empty()) {
        out += ": ";
        append_escaped(out, problem.key, no_limit);
    }
    out += ": ";
    append_escaped(out, problem.message, no_limit); // a message of yaml-cpp may quote the file
    return out;
}

void Problems::add(Problem problem) {
    if (kept_.size() < max_kept) {
        kept_.push_back(std::move(problem));
    } else {
        ++more_;
    }
}

void Problems::append(const Problems& others) {
    for (const Problem& problem : others.kept_) {
        add(problem);
    }
    more_ += others.more_;
}

void Problems::sort() {
    std::stable_sort(kept_.begin(), kept_.end(), [](const Problem& one, const Problem& other) {
        const bool from_file = one.place.variable.empty();
        if (from_file != other.place.variable.empty()) {
            return from_file;
        }
        return std::pair{one.place.line, one.place.column} < std::pair{other.place.line, other.place.column};
    });
}

void throw_exception_from_error(const Problems& problems, const boost::source_location& /*place*/) {
    throw std::runtime_error{problems.empty() ? "the configuration is refused" : to_string(problems.kept().front())};
}

} // namespace linefeed::config
