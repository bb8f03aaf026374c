// A job: an immutable snapshot of a source, record by record, as it will go to the printer.
#pragma once

#include "base/record_number.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace linefeed::spool {

enum class JobId : std::int64_t {};
enum class RunId : std::int64_t {};

/// Where the records came from: enough to see without reading it again whether a file is still the same.
struct SourceFingerprint {
    std::string path; ///< absolute
    std::uint64_t size_bytes = 0;
    std::int64_t modified_ns = 0; ///< since the Unix epoch
    std::uint64_t inode = 0;
    /// The same three of a second file that belongs to the source (the -wal of an SQLite database), or empty.
    std::string companion;

    friend bool operator==(const SourceFingerprint&, const SourceFingerprint&) = default;
};

/// What makes two imports the same job: the source and how it was read. `layout` is canonical JSON of every option that
/// changes the records (columns, table or query, charsets, profile, base, …).
struct JobSpec {
    SourceFingerprint source;
    std::string layout;
    /// Record k has number base + k.
    RecordNumber base;
    /// SHA-256 of the bytes of the source, hex; empty = not known (only the drop folder reads a file twice).
    std::string source_sha256{};
};

enum class ImportState {
    importing, ///< pages are being added. If that is broken off, the job goes when the spool is opened again, unless it
               ///< stands in the ledger: then the import can go on
    stopped,   ///< a bad row has ended the import while the records before it were being printed
    ready,     ///< complete and immutable
};

/// A job as stored.
struct Job {
    JobId id{};
    JobSpec spec;
    ImportState state = ImportState::importing;
    RecordRange records;        ///< base + 1 … base + count; so far, while importing
    std::string content_sha256; ///< of all frames in order, hex; empty while more may come
    std::uint64_t frame_bytes = 0;
    std::int64_t created_ns = 0; ///< wall time, ns since the Unix epoch
    std::string import_report;   ///< JSON: bad rows that were left out
};

} // namespace linefeed::spool
