// SQL that fails before it runs: the k-th thing that a statement asks leave for is refused (sqlite3_set_authorizer). So
// the preparation of every statement can be made to fail, which no fault of a disk does. And connections with hardly
// any cache, so that every statement has to read from the disk, where CrashVfs can make it fail.
#pragma once

#include <cstdint>

namespace linefeed::test {

/// For all connections that are opened during its life; one at a time, one thread.
class SqlFaults {
public:
    SqlFaults();
    ~SqlFaults();
    SqlFaults(const SqlFaults&) = delete;
    SqlFaults& operator=(const SqlFaults&) = delete;

    /// The question with this number, from 0 and from now on, is refused, and no other.
    void refuse(std::uint64_t question);
    void refuse_nothing();
    [[nodiscard]] bool has_refused() const;
};

} // namespace linefeed::test
