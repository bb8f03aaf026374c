// Imports of the service: rows are read, checked and encoded on the thread of whoever asks; what they make goes to the
// store thread in steps of bounded size, so that however large a file is, the runs' commits wait for one step at most.
#pragma once

#include "intake/batch_store.hpp"
#include "service/spool_access.hpp"

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>

namespace linefeed::service {

/// One thread at a time.
class Batches final : public intake::BatchStore {
public:
    /// `ticket` is written with each new job, in the same step: who it is for, and in which queue it goes (its job and
    /// name are filled in, and its place if `enqueue`). `records` counts what is imported.
    Batches(SpoolAccess& spool, spool::Ticket ticket, bool enqueue, std::atomic<std::uint64_t>& records)
        : spool_(spool)
        , ticket_(std::move(ticket))
        , enqueue_(enqueue)
        , records_(records) {}

    [[nodiscard]] Result<std::optional<intake::KnownBatch>> find(const spool::JobSpec& spec) override;
    [[nodiscard]] Result<intake::BatchImport> import(intake::RowSource& source, const spool::JobSpec& spec,
                                                     const intake::ImportOptions& options) override;
    /// Import records that are there already as a new job.
    void allow_again() { again_ = true; }

    /// The ticket of a job that has none yet and was never printed: it was imported, and then something came between.
    /// False if it needs none.
    [[nodiscard]] Result<bool> adopt(const spool::Job& job);

private:
    class Target;
    [[nodiscard]] Result<spool::Job> commit(spool::Spool& spool, spool::JobImport& job, const std::string& report);
    [[nodiscard]] Result<void> write_ticket(spool::Spool& spool, const spool::Job& job);

    SpoolAccess& spool_;
    spool::Ticket ticket_;
    bool enqueue_;
    std::atomic<std::uint64_t>& records_;
    bool again_ = false;
    std::optional<spool::Job> earlier_; ///< to which the import under way gives way
};

} // namespace linefeed::service
