// What the printer model does to the world: bytes to its clients, ink on products, stops, errors. The model returns
// them in order; a driver (sockets or virtual time) carries them out. They compare and print, so that a test reads as a
// story.
#pragma once

#include "base/record_number.hpp"
#include "base/time.hpp"
#include "protocol/messages.hpp"

#include <compare>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <variant>

namespace linefeed::simulator {

/// One client's connection. The driver chooses the value and never uses one twice.
struct ConnectionId {
    std::uint64_t value = 0;
    friend auto operator<=>(const ConnectionId&, const ConnectionId&) = default;
};

/// Bytes for one client: one transmission, with the framing modes of the printer applied.
struct Reply {
    ConnectionId connection;
    std::string bytes;
    friend bool operator==(const Reply&, const Reply&) = default;
};

/// Where a print has its text from.
enum class PrintSource : std::uint8_t {
    record,            ///< the one whose turn it was
    last_record_again, ///< number 0, and none came after it
    extern_text,       ///< `=ET`; no record has come yet
    job,               ///< its static texts, and wildcards where nobody has sent a text yet
};

/// A product got a print: one line of the tape. Issued at the PrintGo.
struct Printed {
    Instant time;
    RecordNumber number;
    std::string text;                  ///< the fields joined by TAB, bytes as received
    std::optional<Duration> lead_time; ///< from the record's arrival to the PrintGo; none if it is not of a record
    PrintSource source = PrintSource::record;
    friend bool operator==(const Printed&, const Printed&) = default;
};

/// The running print was broken off: the last product carries part of the record.
struct PrintAborted {
    Instant time;
    RecordNumber number;
    friend bool operator==(const PrintAborted&, const PrintAborted&) = default;
};

/// A PrintGo found no record that had been there for the margin. In numbered operation error 5043 follows; before the
/// first record, the product gets what the job shows without (that is an underrun only if a record came too late).
struct Underrun {
    Instant time;
    std::optional<Duration> lead_time; ///< of the record that came too late; none: the FIFO was empty
    friend bool operator==(const Underrun&, const Underrun&) = default;
};

/// The panel shows an error, warning or message.
struct ErrorRaised {
    Instant time;
    protocol::PrinterError error;
    friend bool operator==(const ErrorRaised&, const ErrorRaised&) = default;
};

/// Machine, nozzle or cover changed.
struct StateChanged {
    Instant time;
    protocol::MachineState machine = protocol::MachineState::standby;
    protocol::NozzleState nozzle = protocol::NozzleState::invalid;
    bool cover_open = false;
    friend bool operator==(const StateChanged&, const StateChanged&) = default;
};

/// The printer restarted: every connection is gone.
struct ConnectionsLost {
    Instant time;
    friend bool operator==(const ConnectionsLost&, const ConnectionsLost&) = default;
};

using Effect = std::variant<Reply, Printed, PrintAborted, Underrun, ErrorRaised, StateChanged, ConnectionsLost>;

std::ostream& operator<<(std::ostream& out, const Reply& effect);
std::ostream& operator<<(std::ostream& out, const Printed& effect);
std::ostream& operator<<(std::ostream& out, const PrintAborted& effect);
std::ostream& operator<<(std::ostream& out, const Underrun& effect);
std::ostream& operator<<(std::ostream& out, const ErrorRaised& effect);
std::ostream& operator<<(std::ostream& out, const StateChanged& effect);
std::ostream& operator<<(std::ostream& out, const ConnectionsLost& effect);

} // namespace linefeed::simulator
