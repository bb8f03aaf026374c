// Virtual time: one queue of events, ordered by instant and, at the same instant, by the order in which they were put
// in.
#pragma once

#include "base/time.hpp"

#include <cstdint>
#include <optional>
#include <queue>
#include <vector>

namespace linefeed::simulation {

enum class EventKind : std::uint8_t {
    chunk,         ///< bytes arrive; a = index of the chunk
    link_closed,   ///< the host learns that its connection is gone; a = connection
    peer_closed,   ///< the printer learns it; a = connection
    connected,     ///< the host's attempt to connect has ended; a = generation of the run, b = connection, 0 = failed
    write_step,    ///< the kernel takes the next part of a write; a = generation
    store_done,    ///< the store has finished an operation; a = generation
    store_wake,    ///< the store's gathering time is over; a = generation
    host_resumes,  ///< a pause of the host's process is over; a = generation
    next_fault,    ///< something breaks
    fault_ends,    ///< something is repaired; a = which, b = detail
    operator_acts, ///< the operator looks at the line; a = generation of his plan
    belt_changes,  ///< the belt pauses, goes on, or changes its speed
};

struct Event {
    Instant at;
    std::uint64_t sequence = 0;
    EventKind kind = EventKind::chunk;
    std::uint64_t a = 0;
    std::uint64_t b = 0;
};

class EventQueue {
public:
    void put(Instant at, EventKind kind, std::uint64_t a = 0, std::uint64_t b = 0) {
        heap_.push({at, ++sequence_, kind, a, b});
    }
    [[nodiscard]] bool empty() const { return heap_.empty(); }
    /// Instant::max() when empty.
    [[nodiscard]] Instant next_at() const { return heap_.empty() ? Instant::max() : heap_.top().at; }
    [[nodiscard]] Event take() {
        const Event event = heap_.top();
        heap_.pop();
        return event;
    }

private:
    struct Later {
        bool operator()(const Event& a, const Event& b) const {
            return a.at != b.at ? a.at > b.at : a.sequence > b.sequence;
        }
    };
    std::priority_queue<Event, std::vector<Event>, Later> heap_;
    std::uint64_t sequence_ = 0;
};

} // namespace linefeed::simulation
