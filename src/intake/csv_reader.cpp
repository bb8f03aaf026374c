#include "intake/csv_reader.hpp"

#include "base/assert.hpp"

#include <algorithm>
#include <cstring>

namespace linefeed::intake {

std::string describe(const CsvRow& row) {
    switch (row.problem) {
    case CsvProblem::none:
        return {};
    case CsvProblem::quote_in_field:
        return "a quote inside a field that is not quoted (write \"\" inside a quoted field)";
    case CsvProblem::text_after_quote:
        return "text behind the closing quote of a field";
    case CsvProblem::quote_not_closed:
        return "the quote opened in line " + std::to_string(row.problem_line) +
               " is never closed: everything up to the end of the file belongs to this row";
    case CsvProblem::too_long:
        return "the row is longer than 1 MiB (is a quote missing?)";
    }
    assertion_failed("CsvProblem", __FILE__, __LINE__);
}

std::size_t CsvReader::Finder::find(const char* data, std::size_t from, std::size_t end) {
    if (found_ && known_ >= from) {
        return known_;
    }
    const std::size_t start = std::max(from, found_ ? known_ + 1 : known_);
    found_ = false;
    known_ = std::max(start, end);
    if (start < end) {
        const void* at = std::memchr(data + start, byte_, end - start);
        if (at != nullptr) {
            found_ = true;
            known_ = static_cast<std::size_t>(static_cast<const char*>(at) - data);
        }
    }
    return known_;
}

void CsvReader::Finder::shift(std::size_t bytes) {
    if (known_ < bytes) {
        known_ = 0;
        found_ = false;
    } else {
        known_ -= bytes;
    }
}

CsvReader::CsvReader(ReadBytes read_bytes, CsvLimits limits)
    : read_bytes_(std::move(read_bytes))
    , limits_(limits)
    , window_(2 * limits.block_bytes) {}

void CsvReader::discard_front(std::size_t bytes) {
    std::memmove(window_.data(), window_.data() + bytes, end_ - bytes);
    begin_ -= std::min(begin_, bytes);
    end_ -= bytes;
    offset_ += bytes;
    line_feed_.shift(bytes);
    carriage_return_.shift(bytes);
    quote_.shift(bytes);
}

Result<void> CsvReader::read_more() {
    if (begin_ > 0) {
        discard_front(begin_);
    }
    if (window_.size() - end_ < limits_.block_bytes) {
        window_.resize(window_.size() + limits_.block_bytes);
    }
    LINEFEED_ASSERT(window_.size() <= limits_.row_bytes + 3 * limits_.block_bytes);
    const auto got = read_bytes_(std::span{window_}.subspan(end_, limits_.block_bytes));
    if (!got) {
        return got.error();
    }
    LINEFEED_ASSERT(*got <= limits_.block_bytes);
    end_ += *got;
    end_of_file_ = *got == 0;
    return {};
}

Result<void> CsvReader::open() {
    while (end_ < 3 && !end_of_file_) {
        if (auto done = read_more(); !done) {
            return done;
        }
    }
    const std::string_view beginning{window_.data(), end_};
    if (beginning.starts_with("\xFF\xFE") || beginning.starts_with("\xFE\xFF")) {
        return Failure{FailureKind::input, "the file is UTF-16: save it as UTF-8"};
    }
    if (beginning.starts_with("\xEF\xBB\xBF")) {
        begin_ = 3;
    }
    return {};
}

void CsvReader::set_delimiter(CsvDelimiter delimiter) {
    delimiter_ = delimiter;
    scanner_ = CsvScanner{delimiter};
}

Result<CsvDelimiter> CsvReader::guess_delimiter() {
    while (true) {
        // Begins anew with each block: a few times at most.
        const auto guess =
            intake::guess_delimiter({window_.data() + begin_, std::min(end_ - begin_, limits_.row_bytes)});
        if (guess.complete || end_of_file_ || end_ - begin_ >= limits_.row_bytes) {
            return guess.delimiter;
        }
        if (auto done = read_more(); !done) {
            return done.error();
        }
    }
}

void CsvReader::finish_row(std::size_t end) {
    begin_ = end;
    if (begin_ < end_) {
        const bool pair = window_[begin_] == '\r' && begin_ + 1 < end_ && window_[begin_ + 1] == '\n';
        begin_ += pair ? 2 : 1;
        ++line_;
    }
}

Result<bool> CsvReader::next(CsvRow& row) {
    row.fields.clear();
    row.problem = CsvProblem::none;
    row.empty_line = false;
    row.line = line_;
    while (true) {
        row.offset = offset_ + begin_;
        const char* data = window_.data();
        const std::size_t line_end =
            std::min(line_feed_.find(data, begin_, end_), carriage_return_.find(data, begin_, end_));
        if (quote_.find(data, begin_, end_) < line_end) {
            return next_quoted(row);
        }
        // A CR at the end of what is known may be the first half of a line break.
        const bool complete = line_end < end_ && (data[line_end] == '\n' || line_end + 1 < end_);
        if (complete || end_of_file_) {
            if (begin_ == end_) {
                return false;
            }
            const std::string_view text{data + begin_, line_end - begin_};
            if (text.size() > limits_.row_bytes) {
                row.problem = CsvProblem::too_long;
            } else {
                split_plain_row(text, delimiter_, row.fields);
                row.empty_line = text.empty();
            }
            finish_row(line_end);
            return true;
        }
        if (end_ - begin_ > limits_.row_bytes) {
            return next_quoted(row);
        }
        if (auto done = read_more(); !done) {
            return done.error();
        }
    }
}

/// Rows with quotes, and rows that are too long to be kept.
Result<bool> CsvReader::next_quoted(CsvRow& row) {
    scanner_.reset();
    std::size_t scanned = begin_;
    std::size_t dropped = 0;
    while (true) {
        scanned += scanner_.scan({window_.data() + scanned, end_ - scanned});
        const bool half_line_break =
            scanner_.ended() && window_[scanned] == '\r' && scanned + 1 == end_ && !end_of_file_;
        if (scanner_.ended() && !half_line_break) {
            break;
        }
        if (end_of_file_) {
            scanner_.end_of_file();
            break;
        }
        if (scanned - begin_ > limits_.row_bytes) {
            dropped += scanned - begin_;
            begin_ = scanned;
        }
        const std::size_t row_bytes = scanned - begin_;
        if (auto done = read_more(); !done) {
            return done.error();
        }
        scanned = begin_ + row_bytes;
    }
    const std::uint64_t quote_line = line_ + scanner_.line_breaks_at_quote();
    line_ += scanner_.line_breaks();
    row.problem = scanner_.problem();
    row.problem_line = quote_line;
    if (dropped + (scanned - begin_) > limits_.row_bytes && row.problem != CsvProblem::quote_not_closed) {
        row.problem = CsvProblem::too_long;
    }
    if (row.problem == CsvProblem::none) {
        split_quoted_row(window_.data() + begin_, window_.data() + scanned, delimiter_, row.fields);
    }
    finish_row(scanned);
    return true;
}

} // namespace linefeed::intake
