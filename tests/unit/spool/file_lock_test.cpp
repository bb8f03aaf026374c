#include "spool/file_lock.hpp"
#include "spool_fixture.hpp"

#include <gmock/gmock.h>

#include <sys/wait.h>
#include <unistd.h>

namespace linefeed::spool {
namespace {

using testing::HasSubstr;
using FileLockTest = SpoolTest;

TEST_F(FileLockTest, shouldRefuseASecondHolderAndNameTheFirst) {
    const auto first = FileLock::acquire(directory / "a.lock", "the spool a");
    ASSERT_TRUE(first.has_value());
    const auto second = FileLock::acquire(directory / "a.lock", "the spool a");
    ASSERT_FALSE(second.has_value());
    EXPECT_EQ(second.error(), (Failure{FailureKind::storage, "the spool a is in use by another linefeed (process " +
                                                                 std::to_string(::getpid()) + ")"}));
}

TEST_F(FileLockTest, shouldBeFreeAgainWhenTheHolderIsGone) {
    { ASSERT_TRUE(FileLock::acquire(directory / "a.lock", "a").has_value()); }
    EXPECT_TRUE(FileLock::acquire(directory / "a.lock", "a").has_value());
}

TEST_F(FileLockTest, shouldBeFreeAgainWhenTheHolderWasKilled) {
    const pid_t child = ::fork();
    if (child == 0) {
        const auto lock = FileLock::acquire(directory / "a.lock", "a");
        ::_exit(lock.has_value() ? 0 : 1);
    }
    int status = -1;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_EQ(status, 0);
    EXPECT_TRUE(FileLock::acquire(directory / "a.lock", "a").has_value());
}

TEST_F(FileLockTest, shouldMoveWithItsObject) {
    auto lock = FileLock::acquire(directory / "a.lock", "a");
    ASSERT_TRUE(lock.has_value());
    {
        const FileLock moved = std::move(*lock);
        EXPECT_FALSE(FileLock::acquire(directory / "a.lock", "a").has_value());
    }
    EXPECT_TRUE(FileLock::acquire(directory / "a.lock", "a").has_value());
}

TEST_F(FileLockTest, shouldSayWhyTheFileCannotBeCreated) {
    const auto lock = FileLock::acquire(directory / "missing" / "a.lock", "a");
    ASSERT_FALSE(lock.has_value());
    EXPECT_THAT(lock.error().message, HasSubstr("No such file or directory"));
}

} // namespace
} // namespace linefeed::spool
