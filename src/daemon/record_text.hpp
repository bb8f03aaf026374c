// A record as a person reads it: back from its frame, by the charsets of its job.
#pragma once

#include "base/record_page.hpp"
#include "protocol/charset.hpp"
#include "protocol/escapes.hpp"
#include "spool/job.hpp"

#include <string>
#include <vector>

namespace linefeed::daemon {

/// How the records of a job are encoded; kept with the job at its import.
struct RecordFormat {
    std::vector<protocol::Charset> charsets{protocol::Charset::latin1}; ///< one for each field
    protocol::EscapeMode escapes = protocol::EscapeMode::backslash;
    bool properties = false; ///< every record is mirrored or turned
};

[[nodiscard]] RecordFormat record_format(const spool::Job& job);

/// The fields of a record of `page` in UTF-8.
[[nodiscard]] std::vector<std::string> record_fields(const RecordPage& page, RecordNumber number,
                                                     const RecordFormat& format);

/// The fields as one text, `separator` between them.
[[nodiscard]] std::string joined(const std::vector<std::string>& fields, const std::string& separator);

} // namespace linefeed::daemon
