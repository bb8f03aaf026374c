#include "config/names.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace linefeed::config {

namespace {

/// Levenshtein with neighbours swapped as one step. Precondition: both are short.
std::size_t distance(std::string_view one, std::string_view other) {
    std::vector<std::size_t> before_last(other.size() + 1);
    std::vector<std::size_t> last(other.size() + 1);
    std::vector<std::size_t> row(other.size() + 1);
    std::iota(last.begin(), last.end(), 0U);
    for (std::size_t i = 1; i <= one.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= other.size(); ++j) {
            const std::size_t changed = last[j - 1] + (one[i - 1] == other[j - 1] ? 0 : 1);
            row[j] = std::min({changed, last[j] + 1, row[j - 1] + 1});
            if (i > 1 && j > 1 && one[i - 1] == other[j - 2] && one[i - 2] == other[j - 1]) {
                row[j] = std::min(row[j], before_last[j - 2] + 1);
            }
        }
        std::swap(before_last, last);
        std::swap(last, row);
    }
    return last[other.size()];
}

} // namespace

std::string one_of(const std::vector<std::string>& words) {
    std::string list;
    for (std::size_t i = 0; i < words.size(); ++i) {
        list += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
    }
    return list;
}

std::string nearest(std::string_view wanted, const std::vector<std::string>& words) {
    constexpr std::size_t longest = 100; // a slip in something longer is not looked for
    if (wanted.size() > longest) {
        return {};
    }
    const std::string given = variable_word(wanted);
    const std::size_t near_enough = given.size() <= 3 ? 1 : given.size() <= 8 ? 2 : 3;
    std::size_t best = near_enough + 1;
    std::string found;
    for (const std::string& word : words) {
        if (word.size() > longest) {
            continue;
        }
        const std::size_t steps = distance(given, variable_word(word));
        if (steps < best) {
            best = steps;
            found = word;
        } else if (steps == best) {
            found.clear();
        }
    }
    return found;
}

std::string did_you_mean(std::string_view wanted, const std::vector<std::string>& words) {
    const std::string word = nearest(wanted, words);
    return word.empty() ? std::string{} : "; did you mean \"" + word + "\"?";
}

std::string variable_word(std::string_view key) {
    std::string word{key};
    for (char& character : word) {
        if (character >= 'a' && character <= 'z') {
            character = static_cast<char>(character - 'a' + 'A');
        } else if (!(character >= 'A' && character <= 'Z') && !(character >= '0' && character <= '9')) {
            character = '_';
        }
    }
    return word;
}

} // namespace linefeed::config
