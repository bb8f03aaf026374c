// One import and one short run as the product does them: a CSV file through intake into the spool, then a run through
// StoreWork and LedgerKeeper, driven by a scripted feeder with a printer whose tape is the truth. Whatever fails in it,
// what was claimed durable until then is known, and the next run must continue behind the tape.
#pragma once

#include "spool/spool.hpp"
#include "store/store_work.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace linefeed::test {

/// What the storage said is durable.
struct Claims {
    std::optional<spool::Job> job;
    RecordNumber intents_through;
    RecordNumber printed_through;
    bool settled = false; ///< the last run's verdict
    bool ended = false;   ///< the last run's run_ended row
};

class ShortRun {
public:
    /// Writes the source. `options` say how the spool is opened.
    ShortRun(std::filesystem::path directory, spool::SpoolOptions options);

    /// The same command, once more: opens, imports unless that is done, prints the rest, closes.
    void start();
    /// The first failure of the last start, if there was one …
    [[nodiscard]] const std::optional<Failure>& failure() const { return failure_; }
    /// … and how often StoreWork reported it to the feeder.
    [[nodiscard]] int storage_failed_replies() const { return storage_failed_; }
    [[nodiscard]] const Claims& claims() const { return claims_; }
    /// The last record on a product.
    [[nodiscard]] RecordNumber tape() const { return tape_; }
    /// Empty, or how the printer would have printed something twice or left it out.
    [[nodiscard]] const std::string& misprint() const { return misprint_; }
    [[nodiscard]] std::filesystem::path spool_path() const { return directory_ / "spool.db"; }

    /// Opens the spool and compares it with the claims. Empty = all is there.
    [[nodiscard]] std::string missing();
    /// Forgets spool, claims and tape: as new.
    void reset();

    static constexpr std::uint32_t records = 700;

private:
    [[nodiscard]] Result<spool::Job> job_of(spool::Spool& spool);
    void print(spool::Spool& spool, const spool::Job& job);
    void settle_earlier(store::StoreWork& work, const store::OpenIssue& open);
    void print_granted(store::StoreWork& work);
    void move_products(std::uint32_t most);
    void pump(store::StoreWork& work);
    void take(store::StoreWork& work, const store::StoreReply& reply);
    void give_back_pages(store::StoreWork& work);

    std::filesystem::path directory_;
    spool::SpoolOptions options_;
    Claims claims_;
    RecordNumber tape_;
    std::string misprint_;

    // Of the run in progress
    std::optional<Failure> failure_;
    RecordRange granted_;
    RecordNumber durable_through_;
    RecordNumber reported_through_; ///< given to the store
    std::vector<const RecordPage*> pages_;
    int storage_failed_ = 0;
};

} // namespace linefeed::test
