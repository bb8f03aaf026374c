// Finds where a CSV row ends and splits it into fields (RFC 4180), with a resumable state machine: a row may arrive in
// any number of pieces. The reader uses it for rows with quotes; rows without need no state.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace linefeed::intake {

/// What can be wrong with the form of a row.
enum class CsvProblem {
    none,
    quote_in_field,   ///< `ab"c`: a quote inside a field that does not begin with one
    text_after_quote, ///< `"ab"c`: text behind the closing quote
    quote_not_closed, ///< the file ends inside a quoted field
    too_long,         ///< more than max_row_bytes
};

/// No separator: every line is one field.
using CsvDelimiter = std::optional<char>;

/// Walks over one row. Flow: scan() with the bytes that follow, until it finds the end of the row.
class CsvScanner {
public:
    explicit CsvScanner(CsvDelimiter delimiter)
        : delimiter_(delimiter) {}

    /// For the next row.
    void reset();
    /// Takes bytes up to the line break that ends the row, which it does not take. Returns how many bytes belong to the
    /// row; ended() says whether a line break follows them or they were all.
    std::size_t scan(std::string_view bytes);
    [[nodiscard]] bool ended() const { return ended_; }
    /// The file ends here: a quote that is still open is a problem.
    void end_of_file();

    [[nodiscard]] CsvProblem problem() const { return problem_; }
    /// Line breaks inside quoted fields so far; CR LF counts as one.
    [[nodiscard]] std::uint64_t line_breaks() const { return line_breaks_; }
    /// line_breaks() where the quote that is open, or the last one, was opened.
    [[nodiscard]] std::uint64_t line_breaks_at_quote() const { return line_breaks_at_quote_; }

private:
    enum class Place {
        field_start,
        unquoted,
        quoted,
        behind_quote, ///< a quote inside a quoted field: it ends the field or is the first of two
    };
    void note(CsvProblem problem);
    void count_line_break(char byte);

    CsvDelimiter delimiter_;
    Place place_ = Place::field_start;
    bool ended_ = false;
    bool after_cr_ = false;
    CsvProblem problem_ = CsvProblem::none;
    std::uint64_t line_breaks_ = 0;
    std::uint64_t line_breaks_at_quote_ = 0;
};

/// Splits a row without quotes and without its line break.
void split_plain_row(std::string_view row, CsvDelimiter delimiter, std::vector<std::string_view>& fields);

/// Splits a row of good form. Doubled quotes are undone in place, so the row's bytes change.
void split_quoted_row(char* begin, char* end, CsvDelimiter delimiter, std::vector<std::string_view>& fields);

/// What the first row suggests as separator.
struct DelimiterGuess {
    CsvDelimiter
        delimiter; ///< the most frequent of `,` `;` TAB outside quotes, in this order if equal; none if none occurs
    bool complete = false; ///< the row ends in what was looked at
};

/// Line breaks at the beginning are skipped.
[[nodiscard]] DelimiterGuess guess_delimiter(std::string_view beginning);

} // namespace linefeed::intake
