// A file that is exported again and again and only grows: its first records were a batch before, and would be printed
// again. It is found while it is imported, page by page, without reading anything twice.
#pragma once

#include "intake/import.hpp"
#include "spool/spool.hpp"

#include <functional>
#include <string>
#include <vector>

namespace linefeed::intake {

/// Whether the records of `page` that `job` has too are the same there. Precondition: it has the first of them.
[[nodiscard]] Result<bool> has_records(spool::Spool& spool, const spool::Job& job, const RecordPage& page);

/// Flow: add() each page of an import, finish() before it is committed.
class GrownCheck {
public:
    /// Lets a spool be read, on whichever connection.
    using Read = std::function<Result<void>(const std::function<Result<void>(spool::Spool&)>&)>;
    /// `spec` is that of the import: only jobs out of the same folder count, which are printed or still to be.
    GrownCheck(const spool::JobSpec& spec, Read read)
        : spec_(spec)
        , read_(std::move(read)) {}

    [[nodiscard]] Result<void> add(const RecordPage& page);
    /// FailureKind::input if the import begins with all records of an earlier job and has more, naming it.
    [[nodiscard]] Result<void> finish() const;
    /// `options`, with this check in them. Must outlive their use.
    [[nodiscard]] ImportOptions in(const ImportOptions& options);

private:
    [[nodiscard]] Result<void> find(spool::Spool& spool, const RecordPage& page);
    [[nodiscard]] Result<void> compare(spool::Spool& spool, const RecordPage& page);

    const spool::JobSpec& spec_;
    Read read_;
    std::vector<spool::Job> alike_; ///< have begun with the same records so far; the shortest first
    RecordRange records_;           ///< added
};

} // namespace linefeed::intake
