#include "intake/csv_scanner.hpp"

#include <array>
#include <cstring>

namespace linefeed::intake {

namespace {

constexpr bool is_line_break(char byte) {
    return byte == '\n' || byte == '\r';
}

/// The first `wanted` in [begin, end), or end.
template <typename Byte>
Byte* find_byte(Byte* begin, Byte* end, char wanted) {
    if (begin == end) {
        return end;
    }
    auto* found = static_cast<Byte*>(std::memchr(begin, wanted, static_cast<std::size_t>(end - begin)));
    return found == nullptr ? end : found;
}

} // namespace

void CsvScanner::reset() {
    *this = CsvScanner{delimiter_};
}

void CsvScanner::note(CsvProblem problem) {
    if (problem_ == CsvProblem::none) {
        problem_ = problem;
    }
}

void CsvScanner::count_line_break(char byte) {
    if (byte == '\r' || (byte == '\n' && !after_cr_)) {
        ++line_breaks_;
    }
    after_cr_ = byte == '\r';
}

std::size_t CsvScanner::scan(std::string_view bytes) {
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const char byte = bytes[i];
        if (place_ == Place::quoted) {
            count_line_break(byte);
            if (byte == '"') {
                place_ = Place::behind_quote;
            }
            continue;
        }
        if (is_line_break(byte)) {
            ended_ = true;
            return i;
        }
        if (byte == delimiter_) {
            place_ = Place::field_start;
            continue;
        }
        switch (place_) {
        case Place::field_start:
            place_ = byte == '"' ? Place::quoted : Place::unquoted;
            line_breaks_at_quote_ = line_breaks_;
            after_cr_ = false;
            break;
        case Place::unquoted:
            if (byte == '"') {
                note(CsvProblem::quote_in_field);
            }
            break;
        case Place::behind_quote:
            place_ = byte == '"' ? Place::quoted : Place::unquoted;
            after_cr_ = false;
            if (byte != '"') {
                note(CsvProblem::text_after_quote);
            }
            break;
        case Place::quoted:
            break; // handled above
        }
    }
    return bytes.size();
}

void CsvScanner::end_of_file() {
    if (place_ == Place::quoted) {
        problem_ = CsvProblem::quote_not_closed; // whatever else: the row may have swallowed others
    }
    ended_ = true;
}

void split_plain_row(std::string_view row, CsvDelimiter delimiter, std::vector<std::string_view>& fields) {
    fields.clear();
    const char* begin = row.data();
    const char* const end = begin + row.size();
    while (delimiter) {
        const char* separator = find_byte(begin, end, *delimiter);
        if (separator == end) {
            break;
        }
        fields.emplace_back(begin, static_cast<std::size_t>(separator - begin));
        begin = separator + 1;
    }
    fields.emplace_back(begin, static_cast<std::size_t>(end - begin));
}

void split_quoted_row(char* begin, char* end, CsvDelimiter delimiter, std::vector<std::string_view>& fields) {
    fields.clear();
    while (true) {
        char* field_end = nullptr;
        if (begin != end && *begin == '"') {
            char* out = ++begin;
            char* in = begin;
            while (true) {
                char* quote = find_byte(in, end, '"');
                std::memmove(out, in, static_cast<std::size_t>(quote - in));
                out += quote - in;
                if (end - quote < 2 || quote[1] != '"') {
                    fields.emplace_back(begin, static_cast<std::size_t>(out - begin));
                    field_end = quote + 1;
                    break;
                }
                *out++ = '"';
                in = quote + 2;
            }
        } else {
            field_end = delimiter ? find_byte(begin, end, *delimiter) : end;
            fields.emplace_back(begin, static_cast<std::size_t>(field_end - begin));
        }
        if (field_end >= end) {
            return;
        }
        begin = field_end + 1; // behind the separator
    }
}

DelimiterGuess guess_delimiter(std::string_view beginning) {
    constexpr std::array<char, 3> candidates{',', ';', '\t'};
    std::array<std::size_t, candidates.size()> counts{};
    DelimiterGuess guess;
    bool quoted = false;
    bool begun = false;
    for (const char byte : beginning) {
        if (byte == '"') {
            quoted = !quoted;
        } else if (!quoted && is_line_break(byte)) {
            guess.complete = begun;
            if (begun) {
                break;
            }
            continue;
        }
        begun = true;
        for (std::size_t i = 0; i < candidates.size() && !quoted; ++i) {
            counts[i] += static_cast<std::size_t>(byte == candidates[i]);
        }
    }
    std::size_t best = 0;
    for (std::size_t i = 1; i < candidates.size(); ++i) {
        best = counts[i] > counts[best] ? i : best;
    }
    if (counts[best] > 0) {
        guess.delimiter = candidates[best];
    }
    return guess;
}

} // namespace linefeed::intake
