// A life of a spool, drawn from a seed: imports, runs with intents and confirmations, verdicts, operators' words, new
// fingerprints, removals, checkpoints, restarts. It always knows what the spool may say after a power failure at this
// moment: the world before the call in progress, or the world after it. Nothing in between, nothing else.
#pragma once

#include "support/crash_disk.hpp"
#include "world.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace linefeed::test {

class Life {
public:
    Life(std::filesystem::path path, std::string vfs, std::uint64_t seed);

    /// Lives it to its end, in which the spool is closed. Fails at the first call that fails.
    [[nodiscard]] Result<void> run();
    /// Imports one job larger than a transaction of the import.
    [[nodiscard]] Result<void> run_large_import();

    /// What has been acknowledged, …
    [[nodiscard]] const World& before() const { return before_; }
    /// … and what the call in progress makes of it.
    [[nodiscard]] const World& after() const { return after_; }

private:
    [[nodiscard]] Result<void> open();
    [[nodiscard]] Result<spool::JobId> import(std::uint64_t pages, std::uint64_t bytes_per_record);
    [[nodiscard]] Result<void> abandon_import();
    [[nodiscard]] Result<void> print(spool::JobId job, bool to_the_end);
    [[nodiscard]] Result<void> settle(spool::JobId job);
    [[nodiscard]] Result<void> decide(spool::JobId job);
    [[nodiscard]] Result<void> append(spool::JobId job, const std::vector<spool::LedgerEntry>& entries);
    [[nodiscard]] Result<void> update_source(spool::JobId job);
    [[nodiscard]] Result<void> remove(spool::JobId job);
    [[nodiscard]] Result<void> sometimes_checkpoint();
    [[nodiscard]] spool::JobSpec next_spec();
    [[nodiscard]] RecordPage page(RecordNumber first, std::uint64_t records, std::uint64_t bytes_per_record);
    [[nodiscard]] std::string evidence();
    [[nodiscard]] RecordNumber some_number(RecordNumber first, RecordNumber last);
    /// The call succeeded.
    void acknowledged() { before_ = after_; }

    std::filesystem::path path_;
    std::string vfs_;
    Chance chance_;
    std::int64_t clock_ns_ = 1'700'000'000'000'000'000;
    std::optional<spool::Spool> spool_;
    World before_;
    World after_;
    int sources_ = 0;
    spool::RunId run_{};
};

} // namespace linefeed::test
