// Where a drop folder puts its batches. The command line writes the spool itself; the service has one thread that does,
// and hands this interface's calls over to it, page by page.
#pragma once

#include "base/failure.hpp"
#include "intake/import.hpp"
#include "spool/spool.hpp"

#include <optional>

namespace linefeed::intake {

/// A job that has the records of a file already.
struct KnownBatch {
    spool::Job job;
    /// It was imported from this very file, not from another of the same content.
    bool this_file = false;
};

struct BatchImport {
    ImportReport report;
    std::optional<spool::Job> job; ///< absent: refused because of bad rows, or `earlier`
    /// The job that has the same records, though it was made of other bytes; nothing new is stored then.
    std::optional<spool::Job> earlier;
};

/// Calls may take as long as they need; FailureKind::storage means that nothing more can be stored for now.
class BatchStore {
public:
    virtual ~BatchStore() = default;
    /// The job for a file of these bytes (spec.source_sha256) that was read in the same way, or came out of the same
    /// folder, however it was read: a change of the layout is no reason to print a batch again. Another folder may read
    /// the same bytes in another way, for another printer. Where images belong to the records, only this very file is
    /// known by its bytes.
    [[nodiscard]] virtual Result<std::optional<KnownBatch>> find(const spool::JobSpec& spec) = 0;
    /// As import_source(). The job becomes ready in one transaction, and not unless options.check_source allows it.
    [[nodiscard]] virtual Result<BatchImport> import(RowSource& source, const spool::JobSpec& spec,
                                                     const ImportOptions& options) = 0;
};

/// The job for a file of these bytes, see BatchStore::find(). A job that gives way to an earlier one is not removed
/// yet: `gives_way` = it.
struct FoundBatch {
    std::optional<KnownBatch> known;
    std::optional<spool::JobId> gives_way;
};
[[nodiscard]] Result<FoundBatch> find_batch(spool::Spool& spool, const spool::JobSpec& spec);
/// The other job with the records of `job`, which has to go then; absent = it stays. It was read in the same way but
/// for the profile, or came out of the same folder. Whoever decides so begins to remove it before anybody else asks:
/// two of a kind would otherwise give way to each other.
[[nodiscard]] Result<std::optional<spool::Job>> earlier_job(spool::Spool& spool, const spool::Job& job);

/// For whoever owns the spool. The spool must outlive it.
class SpoolBatches final : public BatchStore {
public:
    explicit SpoolBatches(spool::Spool& spool)
        : spool_(spool) {}
    [[nodiscard]] Result<std::optional<KnownBatch>> find(const spool::JobSpec& spec) override;
    [[nodiscard]] Result<BatchImport> import(RowSource& source, const spool::JobSpec& spec,
                                             const ImportOptions& options) override;

private:
    spool::Spool& spool_;
};

} // namespace linefeed::intake
