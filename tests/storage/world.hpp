// What a spool says when it is asked for everything: jobs with their content, and every row of the ledger. Storage
// tests compare it with what had been acknowledged before the fault.
#pragma once

#include "spool/spool.hpp"

#include <map>
#include <ostream>
#include <string>
#include <vector>

namespace linefeed::test {

struct KnownJob {
    spool::SourceFingerprint source;
    RecordRange records;
    std::string content_sha256;

    friend bool operator==(const KnownJob&, const KnownJob&) = default;
};

struct KnownRow {
    spool::JobId job{};
    spool::LedgerEntry entry;

    friend bool operator==(const KnownRow&, const KnownRow&) = default;
};

struct World {
    std::map<spool::JobId, KnownJob> jobs;
    std::vector<KnownRow> rows;

    friend bool operator==(const World&, const World&) = default;
    friend std::ostream& operator<<(std::ostream& out, const World& world);
};

[[nodiscard]] KnownJob known(const spool::Job& job);

/// Reads everything and checks that it agrees with itself: the hash chain, the stored states against the fold of the
/// rows, every page against its checksum and all pages against the content of their job, no half import. The failure
/// says what does not.
[[nodiscard]] Result<World> observe(spool::Spool& spool);

/// PRAGMA integrity_check by a connection of its own; "ok" or what is wrong.
[[nodiscard]] std::string integrity(const std::string& path, const std::string& vfs);

} // namespace linefeed::test
