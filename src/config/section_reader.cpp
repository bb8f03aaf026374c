#include "config/section_reader.hpp"

#include <algorithm>
#include <arpa/inet.h>

namespace linefeed::config {

namespace {

bool is_letter_or_digit(char character) {
    return (character >= 'a' && character <= 'z') || (character >= 'A' && character <= 'Z') ||
           (character >= '0' && character <= '9');
}

bool consists_of(std::string_view text, std::string_view more) {
    return std::all_of(text.begin(), text.end(), [&](char character) {
        return is_letter_or_digit(character) || more.find(character) != std::string_view::npos;
    });
}

/// HOST or HOST:PORT, HOST being a name, an IPv4 address or an IPv6 address in brackets.
bool is_host(std::string_view text) {
    std::string_view rest = text;
    if (text.starts_with('[')) {
        const std::size_t end = text.find(']');
        if (end == std::string_view::npos || !ip_address_problem(text.substr(1, end - 1)).empty()) {
            return false;
        }
        rest = text.substr(end + 1);
        if (rest.empty()) {
            return true;
        }
    } else {
        rest = text.substr(std::min(text.find(':'), text.size()));
        const std::string_view name = text.substr(0, text.size() - rest.size());
        if (name.empty() || !is_letter_or_digit(name.front()) || !consists_of(name, ".-")) {
            return false;
        }
    }
    return rest.empty() || (rest.front() == ':' && rest.size() >= 2 && rest.size() <= 6 &&
                            rest.find_first_not_of("0123456789", 1) == std::string_view::npos);
}

} // namespace

bool check_section(const Node& node, const std::string& path, const std::vector<std::string>& known, Context& context) {
    if (node.kind != Node::Kind::mapping) {
        refuse_value(node, path, "a mapping", context,
                     node.kind == Node::Kind::nothing && !path.empty() ? "; write {} for none, or leave the key out"
                                                                       : "");
        return false;
    }
    for (const Entry& entry : node.entries) {
        if (std::find(known.begin(), known.end(), entry.key) == known.end()) {
            const std::string meant = did_you_mean(entry.key, known);
            context.refuse(entry.place, join(path, entry.key),
                           "unknown key" + (meant.empty() ? ";" : meant) + " allowed here: " + one_of(known));
        }
    }
    return true;
}

void check_unlike(const Entry& entry, const std::string& key, std::set<std::string>& words, Context& context) {
    if (!words.insert(variable_word(entry.key)).second) {
        context.refuse(entry.place, key, "differs from an earlier name only in case or punctuation");
    }
}

bool read_name(const Entry& entry, const std::string& key, Context& context, std::string& out) {
    if (entry.key.empty() || entry.key.size() > max_name || !is_letter_or_digit(entry.key.front()) ||
        !consists_of(entry.key, "-_")) {
        context.refuse(entry.place, key,
                       "expected a name of at most " + std::to_string(max_name) +
                           " letters, digits, - and _ that begins with a letter or digit, found " +
                           in_quotes(entry.key));
        return false;
    }
    out = entry.key;
    return true;
}

std::string pattern_problem(std::string_view text) {
    if (text.find('/') != std::string_view::npos) {
        return "a pattern for file names, without /";
    }
    if (text.ends_with(".done")) {
        return "a pattern that does not end in .done, which marks that a file is whole";
    }
    return {};
}

std::string ip_address_problem(std::string_view text) {
    in6_addr address{};
    const std::string terminated{text};
    const bool good = ::inet_pton(AF_INET, terminated.c_str(), &address) == 1 ||
                      ::inet_pton(AF_INET6, terminated.c_str(), &address) == 1;
    return good ? std::string{} : "a numeric IPv4 or IPv6 address such as 127.0.0.1 or ::1";
}

std::string host_problem(std::string_view text) {
    return is_host(text) ? std::string{} : "a host name as browsers send it, HOST or HOST:PORT";
}

std::string origin_problem(std::string_view text) {
    for (const std::string_view scheme : {"http://", "https://"}) {
        if (text.starts_with(scheme) && is_host(text.substr(scheme.size()))) {
            return {};
        }
    }
    return "an origin, http://HOST[:PORT] or https://HOST[:PORT], without a path";
}

std::string group_problem(std::string_view text) {
    return consists_of(text, "_-") && text.front() != '-' ? std::string{} : "the name of a group of users";
}

} // namespace linefeed::config
