// A spool in a directory of its own with one job, for tests of what stands on it. Its clock can run out of memory: an
// allocation that fails in the middle of a transaction, without touching the allocator.
#pragma once

#include "spool/spool.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <optional>
#include <string>
#include <vector>

namespace linefeed::test {

inline RecordRange closed(std::uint32_t first, std::uint32_t last) {
    return RecordRange::closed(RecordNumber{first}, RecordNumber{last});
}

class SpoolJobTest : public testing::Test {
protected:
    static constexpr std::uint32_t records_of_job = 2000;
    static constexpr std::uint32_t records_of_page = 500;

    void SetUp() override {
        // In memory where possible: syncs of a real disk would only take time.
        const std::filesystem::path memory = "/dev/shm";
        const auto base = std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path();
        std::string name = base / "linefeed-job-XXXXXX";
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        directory_ = name;
        open_spool({});
        job_ = import_job();
    }
    void TearDown() override {
        spool_.reset();
        std::filesystem::remove_all(directory_);
    }

    /// Again, if it is open; `vfs` = SQLite VFS, empty = the default.
    void open_spool(const std::string& vfs) {
        spool_.reset();
        const auto clock = [this] {
            if (out_of_memory_) {
                throw std::bad_alloc{};
            }
            return ++clock_;
        };
        spool_.emplace(spool::Spool::open(directory_ / "spool.db", {clock, vfs}).value());
    }
    spool::JobId import_job(std::uint32_t pages = records_of_job / records_of_page,
                            std::uint32_t page_records = records_of_page) {
        spool::JobSpec spec;
        spec.source.path = "/data/names.csv";
        auto import = spool_->begin_import(spec).value();
        for (std::uint32_t first = 1; first <= pages * page_records; first += page_records) {
            RecordPage page{RecordNumber{first}, {}, {}};
            for (std::uint32_t number = first; number < first + page_records; ++number) {
                page.frames += "^0=MR" + std::to_string(number) + "\tx\r";
                page.ends.push_back(static_cast<std::uint32_t>(page.frames.size()));
            }
            EXPECT_TRUE(import.add(page));
        }
        return import.commit({}).value().id;
    }
    using Ranges = std::vector<RecordRange>;
    Ranges in_state(spool::RecordState state) { return spool_->ledger_state(job_).value().ranges(state); }
    std::vector<spool::LedgerKind> kinds() {
        std::vector<spool::LedgerKind> kinds;
        for (const spool::LedgerRow& row : spool_->ledger_rows(job_, 0, 1000).value()) {
            kinds.push_back(row.entry.kind);
        }
        return kinds;
    }

    std::filesystem::path directory_;
    std::int64_t clock_ = 0;
    std::atomic<bool> out_of_memory_{false};
    std::optional<spool::Spool> spool_;
    spool::JobId job_{};
};

} // namespace linefeed::test
