// The k-th allocation inside SQLite fails, for every k over one import and one short run, once or from then on. Each
// time: an error in words, nothing claimed that is not durable, no memory lost, and the same command prints the rest.
#include "long_tests.hpp"
#include "scratch_directory.hpp"
#include "start_judge.hpp"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <chrono>
#include <iostream>

namespace linefeed::test {
namespace {

/// SQLite's allocator, with faults; for the whole process.
struct FailingMemory {
    sqlite3_mem_methods original{};
    bool counts = false;
    bool persists = false;
    std::uint64_t calls = 0;
    std::uint64_t fail_at = 0;
    std::uint64_t failed = 0;

    [[nodiscard]] bool next_fails() {
        if (!counts) {
            return false;
        }
        const std::uint64_t call = calls++;
        const bool fails = call == fail_at || (persists && call > fail_at);
        failed += fails ? 1 : 0;
        return fails;
    }
};

FailingMemory& memory() {
    static FailingMemory instance;
    return instance;
}

void* failing_malloc(int size) {
    return memory().next_fails() ? nullptr : memory().original.xMalloc(size);
}

void* failing_realloc(void* block, int size) {
    return memory().next_fails() ? nullptr : memory().original.xRealloc(block, size);
}

/// Before SQLite is used for the first time.
void install() {
    ASSERT_EQ(sqlite3_config(SQLITE_CONFIG_GETMALLOC, &memory().original), SQLITE_OK);
    sqlite3_mem_methods failing = memory().original;
    failing.xMalloc = failing_malloc;
    failing.xRealloc = failing_realloc;
    ASSERT_EQ(sqlite3_config(SQLITE_CONFIG_MALLOC, &failing), SQLITE_OK);
}

class FailingSqliteMemory : public testing::Test {
protected:
    static void SetUpTestSuite() { install(); }

    void fail_each_allocation(bool persists, std::uint64_t stride) {
        const auto start = std::chrono::steady_clock::now();
        ScratchDirectory scratch{"failing-sqlite-memory"};
        CrashVfs disk{"failing-sqlite-memory"};
        std::int64_t clock = 0;
        ShortRun run{scratch.path(), {[&clock] { return ++clock; }, disk.name()}};
        StartJudge judge{disk, run};
        run.start(); // whatever SQLite keeps for the whole process is there now
        const sqlite3_int64 used_before = sqlite3_memory_used();
        std::uint64_t tried = 0;
        for (std::uint64_t k = 0;; k += stride, ++tried) {
            disk.load({});
            run.reset();
            memory().persists = persists;
            memory().calls = memory().failed = 0;
            memory().fail_at = k;
            memory().counts = true;
            run.start();
            memory().counts = false;
            ASSERT_EQ(sqlite3_memory_used(), used_before) << "memory is lost when allocation " << k << " fails";
            if (memory().failed == 0) {
                ASSERT_FALSE(run.failure().has_value()) << run.failure()->message;
                break;
            }
            const std::string problem = judge.judge();
            ASSERT_EQ(problem, "") << "allocation " << k << (persists ? " and all after it" : "");
        }
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        std::cout << tried << " allocations of SQLite failed" << (persists ? ", with all after them" : ", once each")
                  << "; " << judge.unharmed() << " of them without effect; " << seconds.count() << " s\n";
        EXPECT_GT(tried, 300U);
    }
};

TEST_F(FailingSqliteMemory, shouldEndInACleanErrorWhicheverAllocationFailsOnce) {
    fail_each_allocation(false, 1);
}

TEST_F(FailingSqliteMemory, shouldEndInACleanErrorFromWhicheverAllocationOnAllFail) {
    fail_each_allocation(true, long_tests() ? 1 : 10);
}

} // namespace
} // namespace linefeed::test
