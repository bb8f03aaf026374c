// The k-th `operator new` of the product fails, for every k over one import and one short run, once or from then on.
// std::bad_alloc may come out, as an exception that main turns into words; but nothing ends the process, nothing leaks,
// nothing is claimed that is not durable, and the same command prints the rest.
#include "scratch_directory.hpp"
#include "start_judge.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <new>

namespace {

/// The allocator of the whole process; one thread.
struct FailingNew {
    bool counts = false;
    bool persists = false;
    std::uint64_t calls = 0;
    std::uint64_t fail_at = 0;
    std::uint64_t failed = 0;
    std::int64_t live_blocks = 0;

    [[nodiscard]] bool next_fails() {
        if (!counts || linefeed::test::inside_crash_vfs > 0) {
            return false;
        }
        const std::uint64_t call = calls++;
        const bool fails = call == fail_at || (persists && call > fail_at);
        failed += fails ? 1 : 0;
        return fails;
    }
};

constinit FailingNew failing_new;

void* allocate(std::size_t size) noexcept {
    if (failing_new.next_fails()) {
        return nullptr;
    }
    void* block = std::malloc(size == 0 ? 1 : size);
    failing_new.live_blocks += block != nullptr ? 1 : 0;
    return block;
}

void* allocate_or_throw(std::size_t size) {
    void* block = allocate(size);
    if (block == nullptr) {
        throw std::bad_alloc{};
    }
    return block;
}

void release(void* block) noexcept {
    failing_new.live_blocks -= block != nullptr ? 1 : 0;
    std::free(block);
}

} // namespace

void* operator new(std::size_t size) {
    return allocate_or_throw(size);
}
void* operator new[](std::size_t size) {
    return allocate_or_throw(size);
}
void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
    return allocate(size);
}
void* operator new[](std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
    return allocate(size);
}
void operator delete(void* block) noexcept {
    release(block);
}
void operator delete[](void* block) noexcept {
    release(block);
}
void operator delete(void* block, std::size_t /*size*/) noexcept {
    release(block);
}
void operator delete[](void* block, std::size_t /*size*/) noexcept {
    release(block);
}

namespace linefeed::test {
namespace {

class FailingNewTest : public testing::Test {
protected:
    void fail_each_allocation(bool persists) {
        const auto start = std::chrono::steady_clock::now();
        ScratchDirectory scratch{"failing-new"};
        CrashVfs disk{"failing-new"};
        std::int64_t clock = 0;
        ShortRun run{scratch.path(), {[&clock] { return ++clock; }, disk.name()}};
        StartJudge judge{disk, run};
        std::uint64_t thrown = 0;
        std::uint64_t failed = 0;
        std::string problem;
        std::uint64_t k = 0;
        // Whatever is made once in a process is there behind a whole run and one that leaves records open.
        EXPECT_FALSE(start_with_fault(run, UINT64_MAX, false));
        EXPECT_EQ(judge.judge(), "");
        const std::uint64_t in_mid_run = failing_new.calls * 3 / 4;
        disk.load({});
        run.reset();
        EXPECT_TRUE(start_with_fault(run, in_mid_run, true));
        EXPECT_EQ(judge.judge_after_exception(), "");
        for (bool reached = true; reached && problem.empty(); ++k) {
            disk.load({});
            run.reset();
            const std::int64_t live_before = failing_new.live_blocks;
            const bool threw = start_with_fault(run, k, persists);
            reached = failing_new.failed > 0;
            failed += reached ? 1 : 0;
            thrown += threw ? 1 : 0;
            problem = threw ? judge.judge_after_exception() : judge.judge();
            disk.load({});
            run.reset();
            if (problem.empty() && failing_new.live_blocks != live_before) {
                problem = std::to_string(failing_new.live_blocks - live_before) + " blocks are lost";
            }
        }
        ASSERT_EQ(problem, "") << "allocation " << k - 1 << (persists ? " and all after it" : "");
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        std::cout << failed << " allocations failed" << (persists ? ", with all after them" : ", once each") << "; "
                  << thrown << " came out as exceptions; " << seconds.count() << " s\n";
        EXPECT_GT(failed, 100U);
    }

private:
    /// Whether it ended in an exception.
    static bool start_with_fault(ShortRun& run, std::uint64_t k, bool persists) {
        failing_new.persists = persists;
        failing_new.calls = failing_new.failed = 0;
        failing_new.fail_at = k;
        failing_new.counts = true;
        bool threw = false;
        try {
            run.start();
        } catch (const std::bad_alloc&) {
            threw = true;
        }
        failing_new.counts = false;
        return threw;
    }
};

TEST_F(FailingNewTest, shouldHarmNothingWhicheverAllocationFailsOnce) {
    fail_each_allocation(false);
}

TEST_F(FailingNewTest, shouldHarmNothingFromWhicheverAllocationOnAllFail) {
    fail_each_allocation(true);
}

} // namespace
} // namespace linefeed::test
