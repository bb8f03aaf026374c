// Whoever keeps the last frames of a conversation, so that it can be read after something went wrong.
#pragma once

#include "base/record_number.hpp"
#include "base/time.hpp"

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace linefeed::session {

/// Called on the session's thread, in the order of the conversation; must neither block nor allocate.
class FrameObserver {
public:
    virtual ~FrameObserver() = default;
    /// A frame of the printer, from `^` up to and without its CR; of an overlong one, the beginning.
    virtual void on_frame_received(std::string_view frame, Instant at) = 0;
    /// So many bytes of the printer that are no frame.
    virtual void on_damage_received(std::uint64_t bytes, Instant at) = 0;
    /// A command, with its CR, has been put into the outbox: it is written at once, or behind what is being written.
    virtual void on_command_sent(std::string_view frame, Instant at) = 0;
    /// The same for consecutive records: `first` is the first one's frame, `bytes` the size of all.
    virtual void on_records_sent(RecordRange records, std::string_view first, std::size_t bytes, Instant at) = 0;
};

} // namespace linefeed::session
