#include "intake/csv_source.hpp"

#include "intake/columns.hpp"

#include <algorithm>

namespace linefeed::intake {

namespace {

/// A separator that the reader can tell from everything else.
bool is_possible_delimiter(char byte) {
    return byte != '"' && byte != '\r' && byte != '\n' && byte != '\0' && static_cast<unsigned char>(byte) < 0x80;
}

} // namespace

CsvSource::CsvSource(FileInput file)
    : file_(std::move(file))
    , reader_([this](std::span<char> out) { return file_.read(out); }) {}

Result<std::unique_ptr<RowSource>> CsvSource::open(FileInput file, const SourceOptions& options) {
    if (options.table || options.query) {
        return Failure{FailureKind::usage, file.path().string() +
                                               ": --table and --query are for SQLite databases, this is "
                                               "not one"};
    }
    if (options.delimiter && !is_possible_delimiter(*options.delimiter)) {
        return Failure{FailureKind::usage, "the delimiter must be an ASCII character other than quote and line break"};
    }
    std::unique_ptr<CsvSource> source{new CsvSource{std::move(file)}};
    if (auto started = source->start(options); !started) {
        return started.error();
    }
    return std::unique_ptr<RowSource>{std::move(source)};
}

Failure CsvSource::failure(FailureKind kind, const std::string& why) const {
    return {kind, file_.path().string() + ": " + why};
}

Result<void> CsvSource::start(const SourceOptions& options) {
    if (auto opened = reader_.open(); !opened) {
        return failure(opened.error().kind, opened.error().message);
    }
    CsvDelimiter delimiter = options.delimiter;
    if (!delimiter) {
        const auto guess = reader_.guess_delimiter();
        if (!guess) {
            return failure(guess.error().kind, guess.error().message);
        }
        delimiter = *guess;
    }
    reader_.set_delimiter(delimiter);
    std::vector<std::string> header;
    if (options.header) {
        const auto found = reader_.next(current_);
        if (!found) {
            return failure(found.error().kind, found.error().message);
        }
        if (!*found || current_.empty_line) {
            return failure(FailureKind::input, "line 1 is empty: a header with column names is expected there");
        }
        if (current_.problem != CsvProblem::none) {
            return failure(FailureKind::input, "the header in line 1 cannot be read: " + describe(current_));
        }
        header.assign(current_.fields.begin(), current_.fields.end());
    }
    width_ = header.size();
    if (auto chosen = options.header ? choose_columns(options, header) : Result<void>{}; !chosen) {
        return chosen;
    }
    if (auto advanced = advance(); !advanced) {
        return advanced.error();
    }
    if (!has_current_) {
        return failure(FailureKind::input,
                       options.header ? "the file has a header but no rows" : "the file has no rows");
    }
    if (options.header) {
        return {};
    }
    if (current_.problem != CsvProblem::none) {
        return failure(FailureKind::input, "line " + std::to_string(current_.line) + ": " + describe(current_) +
                                               "; without header, the first row must show the columns");
    }
    width_ = current_.fields.size();
    return choose_columns(options, header);
}

Result<void> CsvSource::choose_columns(const SourceOptions& options, const std::vector<std::string>& header) {
    auto chosen = choose(options.columns, header, width_,
                         [](std::string_view wanted, std::string_view column) { return wanted == column; });
    if (!chosen) {
        return failure(chosen.error().kind, chosen.error().message);
    }
    chosen_ = std::move(*chosen);
    for (const std::size_t index : chosen_) {
        const bool named = index < header.size() && !header[index].empty();
        names_.push_back(named ? header[index] : "column " + std::to_string(index + 1));
    }
    return {};
}

Result<bool> CsvSource::advance() {
    while (true) {
        const auto found = reader_.next(current_);
        if (!found) {
            return failure(found.error().kind, found.error().message);
        }
        current_is_used_ = false;
        has_current_ = *found;
        if (!has_current_ || !current_.empty_line) {
            return has_current_;
        }
        ++empty_lines_;
    }
}

void CsvSource::fill(Row& row) const {
    row.fields.clear();
    row.problem.clear();
    row.problem_column.clear();
    row.line = current_.line;
    if (current_.problem != CsvProblem::none) {
        row.problem = describe(current_);
        return;
    }
    if (current_.fields.size() != width_) {
        const std::size_t count = current_.fields.size();
        row.problem =
            std::to_string(count) + (count == 1 ? " field" : " fields") + " instead of " + std::to_string(width_);
        return;
    }
    bool all_empty = true;
    for (const std::size_t index : chosen_) {
        row.fields.push_back(current_.fields[index]);
        all_empty = all_empty && row.fields.back().empty();
    }
    if (all_empty) {
        row.fields.clear();
        row.problem = "the record is empty";
    }
}

Result<bool> CsvSource::next(Row& row) {
    if (!has_current_) {
        return false;
    }
    if (empty_lines_ > 0) {
        row.fields.clear();
        row.line = current_.line - empty_lines_; // they stand directly before it
        row.problem = "the line is empty";
        row.problem_column.clear();
        --empty_lines_;
        return true;
    }
    if (current_is_used_) {
        auto advanced = advance();
        if (!advanced || !*advanced) {
            return advanced;
        }
        if (empty_lines_ > 0) {
            return next(row);
        }
    }
    fill(row);
    current_is_used_ = true;
    return true;
}

/// A record is a byte and a line break at least, the last perhaps without.
std::uint64_t CsvSource::most_rows() const {
    return file_.size() / 2 + 1;
}

double CsvSource::progress() const {
    return std::min(1.0, static_cast<double>(reader_.offset()) / static_cast<double>(file_.size()));
}

} // namespace linefeed::intake
