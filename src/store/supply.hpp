// Records that are still being imported while a run prints them, as the store sees them: it writes them to the spool,
// since it is the only writer, and may hand out only those that are durable there.
#pragma once

#include "base/failure.hpp"
#include "base/record_number.hpp"
#include "store/event_signal.hpp"

#include <optional>

namespace linefeed::store {

/// All on the thread that owns the spool, unless said otherwise.
class Supply {
public:
    Supply() = default;
    Supply(const Supply&) = delete;
    Supply& operator=(const Supply&) = delete;
    virtual ~Supply() = default;

    /// Something waits to be written.
    [[nodiscard]] virtual bool wants_step() = 0;
    /// Writes some of it, durable at return.
    virtual void step() = 0;
    /// The records that a power failure leaves in the job. Grows, from its first record on.
    [[nodiscard]] virtual RecordRange durable() const = 0;
    /// No record follows the durable ones.
    [[nodiscard]] virtual bool end_known() const = 0;
    /// Why there will be no more records, although the end is not known.
    [[nodiscard]] virtual const std::optional<Failure>& failure() const = 0;
    /// `waiting` is notified, by any thread, when wants_step() may have become true; nullptr = nobody waits any more.
    virtual void wake(EventSignal* waiting) = 0;
};

} // namespace linefeed::store
