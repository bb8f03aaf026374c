#include "intake/columns.hpp"

#include <algorithm>
#include <charconv>
#include <numeric>
#include <optional>

namespace linefeed::intake {

namespace {

std::optional<std::size_t> column_number(std::string_view text, std::size_t width) {
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || end != text.data() + text.size() || number < 1 || number > width) {
        return std::nullopt;
    }
    return number;
}

Failure unknown_column(const std::string& wanted, const std::vector<std::string>& names, std::size_t width) {
    std::string message = "there is no column \"" + wanted + "\", ";
    message += names.empty() ? "there are " + std::to_string(width) + " without names: choose by number, from 1"
                             : "there are " + quoted_list(names);
    return {FailureKind::usage, std::move(message)};
}

} // namespace

std::string quoted_list(const std::vector<std::string>& names) {
    constexpr std::size_t most = 20;
    std::string list;
    for (std::size_t i = 0; i < std::min(names.size(), most); ++i) {
        list += (i == 0 ? "\"" : ", \"") + names[i] + '"';
    }
    return names.size() > most ? list + " and " + std::to_string(names.size() - most) + " more" : list;
}

Result<std::vector<std::size_t>> choose(const std::vector<std::string>& wanted, const std::vector<std::string>& names,
                                        std::size_t width, const SameName& same_name) {
    std::vector<std::size_t> chosen;
    if (wanted.empty()) {
        chosen.resize(width);
        std::iota(chosen.begin(), chosen.end(), std::size_t{0});
        return chosen;
    }
    for (const std::string& name : wanted) {
        const auto is_it = [&](const std::string& column) { return same_name(name, column); };
        const auto found = std::find_if(names.begin(), names.end(), is_it);
        if (found == names.end()) {
            const auto number = column_number(name, width);
            if (!number) {
                return unknown_column(name, names, width);
            }
            chosen.push_back(*number - 1);
            continue;
        }
        if (std::find_if(std::next(found), names.end(), is_it) != names.end()) {
            return Failure{FailureKind::usage,
                           "more than one column is called \"" + name + "\": choose by number, from 1"};
        }
        chosen.push_back(static_cast<std::size_t>(found - names.begin()));
    }
    return chosen;
}

} // namespace linefeed::intake
