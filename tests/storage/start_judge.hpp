// Judges a start of ShortRun in which something failed, and the starts after it.
#pragma once

#include "short_run.hpp"
#include "support/crash_vfs.hpp"

#include <string>

namespace linefeed::test {

class StartJudge {
public:
    StartJudge(CrashVfs& disk, ShortRun& run)
        : disk_(disk)
        , run_(run) {}

    /// The fault is over. Empty = the failed start ended in a clean error or unharmed; all that it claimed durable is
    /// there, after a restart of the program and as if power had been lost instead; and both times the same command
    /// prints the rest. Otherwise what is wrong.
    [[nodiscard]] std::string judge();
    /// As judge(); the start ended in an exception, so it has reported nothing.
    [[nodiscard]] std::string judge_after_exception();

    /// Starts that the fault did not harm.
    [[nodiscard]] std::uint64_t unharmed() const { return unharmed_; }

private:
    [[nodiscard]] std::string judge_failed_start();
    [[nodiscard]] std::string judge_what_is_left();
    [[nodiscard]] std::string judge_next_start();

    CrashVfs& disk_;
    ShortRun& run_;
    std::uint64_t unharmed_ = 0;
};

} // namespace linefeed::test
