// The CSV reader on any bytes: the same rows whether they come at once or in pieces, memory bounded, lines and offsets
// sane. The first bytes of the input choose delimiter, limits and piece sizes.
#include "base/assert.hpp"
#include "intake/csv_reader.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

namespace {

using linefeed::intake::CsvDelimiter;
using linefeed::intake::CsvLimits;
using linefeed::intake::CsvProblem;
using linefeed::intake::CsvReader;
using linefeed::intake::CsvRow;

/// Everything the reader says about the text, in one string.
std::string read_all(std::string_view text, std::string_view piece_sizes, bool guess, CsvDelimiter delimiter,
                     CsvLimits limits) {
    std::size_t at = 0;
    std::size_t piece = 0;
    CsvReader reader{[&](std::span<char> out) -> linefeed::Result<std::size_t> {
                         std::size_t size = std::min(out.size(), text.size() - at);
                         if (!piece_sizes.empty()) {
                             const auto wanted = static_cast<unsigned char>(piece_sizes[piece++ % piece_sizes.size()]);
                             size = std::min(size, std::size_t{wanted} + 1);
                         }
                         if (size > 0) {
                             std::memcpy(out.data(), text.data() + at, size);
                         }
                         at += size;
                         return size;
                     },
                     limits};
    if (!reader.open()) {
        return "refused";
    }
    if (guess) {
        delimiter = reader.guess_delimiter().value();
    }
    reader.set_delimiter(delimiter);
    std::string result = delimiter ? std::string(1, *delimiter) : "none";
    CsvRow row;
    std::uint64_t last_line = 0;
    std::uint64_t last_offset = 0;
    while (reader.next(row).value()) {
        LINEFEED_ASSERT(row.line > last_line && (last_line == 0 || row.offset > last_offset));
        LINEFEED_ASSERT(reader.offset() > row.offset && reader.offset() <= text.size());
        LINEFEED_ASSERT(reader.window_bytes() <= limits.row_bytes + 3 * limits.block_bytes);
        LINEFEED_ASSERT((row.problem == CsvProblem::none) != row.fields.empty());
        last_line = row.line;
        last_offset = row.offset;
        result += "\n" + std::to_string(row.line) + ' ' + std::to_string(row.offset) + ' ' +
                  linefeed::intake::describe(row) + (row.empty_line ? " empty" : "");
        for (const std::string_view field : row.fields) {
            result.append(1, '\0').append(std::to_string(field.size())).append(1, ' ').append(field);
        }
    }
    LINEFEED_ASSERT(reader.offset() == text.size());
    LINEFEED_ASSERT(!reader.next(row).value());
    return result;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::size_t control_bytes = 6;
    if (size < control_bytes) {
        return 0;
    }
    const std::string_view input{reinterpret_cast<const char*>(data), size};
    constexpr std::array<CsvDelimiter, 4> delimiters{',', ';', '\t', std::nullopt};
    const auto choice = static_cast<unsigned char>(input[0]);
    const CsvDelimiter delimiter = delimiters[choice % delimiters.size()];
    const bool guess = (choice & 0x10U) != 0;
    const std::size_t row_bytes = std::size_t{static_cast<unsigned char>(input[1])} * 4 + 1;
    const std::string_view pieces = input.substr(2, control_bytes - 2);
    const std::string_view text = input.substr(control_bytes);
    const std::string whole = read_all(text, {}, guess, delimiter, {row_bytes, 16 * 1024});
    const std::string in_pieces = read_all(text, pieces, guess, delimiter, {row_bytes, 32});
    LINEFEED_ASSERT(whole == in_pieces);
    return 0;
}
