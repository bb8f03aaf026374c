// Encodes one record as a `^0=MR…` frame (protocol, section 5) and reads one back. The printer truncates silently what
// is too long and takes a CR for the end; so a value that does not fit is an error that names record, field, character
// and reason. Nothing is truncated or replaced.
#pragma once

#include "base/record_number.hpp"
#include "protocol/charset.hpp"
#include "protocol/escapes.hpp"
#include "protocol/record_properties.hpp"

#include <boost/system/result.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::protocol {

/// The printer takes this many fields in a record.
inline constexpr std::size_t max_fields = 255;

/// Why a record cannot be sent.
enum class RecordErrc {
    invalid_utf8,      ///< the value is not UTF-8
    control_character, ///< U+0000…U+001F, U+007F…U+009F: CR ends a frame, TAB separates fields, NUL is printed as a
                       ///< blank
    not_in_charset,    ///< the charset of the field does not have the character
    outside_bmp,       ///< the character needs two UTF-16 units; the printer takes one
    not_escapable,     ///< `^` or `\` for firmware that knows no escapes
    looks_like_properties, ///< the last field reads as a property block `{…}`: the printer would obey instead of print
                           ///< it
    too_many_fields,      ///< more than 255
    no_fields,            ///< a record without any field
    too_long,             ///< the string behind `=MR` exceeds 2048 bytes
    repetitions_numbered, ///< `rN` with a number other than 0
};

/// One reason with its place. Fields count from 1; 0 = concerns the whole record.
struct RecordError {
    RecordErrc code = RecordErrc::invalid_utf8;
    RecordNumber record{};
    std::uint32_t field = 0;
    std::uint32_t character = 0; ///< which character of the field, from 1; 0 = none in particular
    char32_t code_point = 0;     ///< the offending character, or the offending byte for invalid_utf8
    std::uint64_t length = 0;    ///< bytes for too_long, fields for too_many_fields

    friend bool operator==(const RecordError&, const RecordError&) = default;
};

/// The reason alone, in words, e.g. "character 3 is U+0009 (TAB), a control character". Says what to do where that
/// helps.
[[nodiscard]] std::string describe(const RecordError& error);

/// Encodes the records of one job. Flow: construct once, call append() for each record.
class MailRecordEncoder {
public:
    /// `charsets` has one entry per field, or a single one for all. Precondition: not empty. `properties` end each
    /// record, unless they are empty.
    MailRecordEncoder(std::vector<Charset> charsets, EscapeMode escapes, RecordProperties properties = {});

    /// Appends `^0=MR<number>TAB<field>…[TAB{…}]CR` to `out`. On an error `out` is as before.
    /// Precondition: no more fields than charsets, unless there is a single one for all.
    [[nodiscard]] boost::system::result<void, RecordError> append(std::string& out, RecordNumber number,
                                                                  std::span<const std::string_view> utf8_fields) const;

private:
    std::vector<Charset> charsets_;
    EscapeMode escapes_;
    RecordProperties properties_;
};

/// Called by result::value() on an error: throws std::runtime_error.
[[noreturn]] void throw_exception_from_error(const RecordError& error, const boost::source_location& place);

/// A record as the printer reads it.
struct MailRecord {
    RecordNumber number{};
    std::vector<std::string> fields{}; ///< escapes undone, charset as received
    RecordProperties properties{};

    friend bool operator==(const MailRecord&, const MailRecord&) = default;
};

/// Reads the string behind `=MR` as the printer does: it takes 2048 bytes and drops the rest, takes 255 fields and
/// drops the rest, and shows NUL as a blank. std::nullopt if the number is missing, has leading zeros or is no unsigned
/// 32-bit decimal.
[[nodiscard]] std::optional<MailRecord> parse_mail_record(std::string_view text, EscapeMode escapes);

} // namespace linefeed::protocol
