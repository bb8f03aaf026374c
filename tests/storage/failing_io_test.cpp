// The k-th call to the disk fails, for every k over one import and one short run; and the disk is full at every size.
// Each time: an error in words, once; nothing claimed durable is missing afterwards, neither after a restart of the
// program nor after a power failure; and the same command again prints the rest.
#include "long_tests.hpp"
#include "scratch_directory.hpp"
#include "short_run.hpp"
#include "start_judge.hpp"
#include "support/crash_vfs.hpp"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <chrono>
#include <iostream>

namespace linefeed::test {
namespace {

class FailingIo : public testing::Test {
protected:
    [[nodiscard]] std::string judge_everything() {
        disk.set_fault(std::nullopt);
        disk.set_capacity_bytes(std::nullopt);
        return judge.judge();
    }

    void begin_again() {
        disk.load({});
        run.reset();
    }

    /// Every call of the kinds fails in turn, until a start does not reach the k-th.
    void fail_each_call(const std::vector<DiskCall>& kinds, bool persists, std::optional<int> code) {
        const auto start = std::chrono::steady_clock::now();
        std::uint64_t k = 0;
        for (;; ++k) {
            begin_again();
            const std::uint64_t failed_before = disk.failed_calls();
            disk.set_fault(DiskFault{kinds, k, persists, code});
            run.start();
            if (disk.failed_calls() == failed_before) {
                ASSERT_FALSE(run.failure().has_value()) << run.failure()->message;
                break;
            }
            const std::string problem = judge_everything();
            ASSERT_EQ(problem, "") << "call " << k << (persists ? " and all after it" : "");
        }
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        std::cout << k << " calls failed" << (persists ? ", with all after them" : ", once each") << "; "
                  << judge.unharmed() << " of them without effect; " << seconds.count() << " s\n";
        EXPECT_GT(k, 20U);
    }

    ScratchDirectory scratch{"failing-io"};
    CrashVfs disk{"failing-io"};
    ShortRun run{scratch.path(), {[this] { return ++clock; }, disk.name()}};
    std::int64_t clock = 0;
    StartJudge judge{disk, run};
};

TEST_F(FailingIo, shouldEndInACleanErrorWhicheverCallFailsOnce) {
    fail_each_call({}, false, std::nullopt);
}

TEST_F(FailingIo, shouldEndInACleanErrorFromWhicheverCallOnAllFail) {
    fail_each_call({}, true, std::nullopt);
}

TEST_F(FailingIo, shouldEndInACleanErrorWhicheverWriteFindsTheDiskFull) {
    fail_each_call({DiskCall::write, DiskCall::shared_memory}, false, SQLITE_FULL);
}

TEST_F(FailingIo, shouldEndInACleanErrorFromWhicheverWriteOnTheDiskIsFull) {
    fail_each_call({DiskCall::write, DiskCall::shared_memory}, true, SQLITE_FULL);
}

TEST_F(FailingIo, shouldResumeWhenThereIsSpaceAgain) {
    const std::uint64_t step = long_tests() ? 256 : 2048;
    std::uint64_t sizes = 0;
    for (std::uint64_t capacity = 0;; capacity += step) {
        begin_again();
        disk.set_capacity_bytes(capacity);
        run.start();
        if (!run.failure()) {
            break;
        }
        ++sizes;
        EXPECT_NE(run.failure()->message.find("the disk is full (SQLITE_FULL)"), std::string::npos)
            << run.failure()->message;
        const std::string problem = judge_everything();
        ASSERT_EQ(problem, "") << "capacity " << capacity;
    }
    std::cout << "disk full at " << sizes << " sizes\n";
    EXPECT_GT(sizes, 20U);
}

} // namespace
} // namespace linefeed::test
