// How a run ended, and what the operator has to be told.
#pragma once

#include "base/record_number.hpp"
#include "protocol/messages.hpp"

#include <optional>
#include <ostream>
#include <string>
#include <string_view>

namespace linefeed::feeder {

enum class OutcomeCode {
    finished,           ///< every record of the run is printed
    nothing_to_print,   ///< the ledger granted no records: all printed before, or waiting for an operator
    stop_requested,     ///< linefeed was asked to stop
    stopped_at_printer, ///< print-ready was switched off at the printer
    printer_error,      ///< the printer stopped with an error, or reports one that ends the run
    not_ready,          ///< the printer's state does not allow a start
    cover_open,         ///< the head cover is open
    busy,               ///< the printer is printing something that is not this run
    error_pending,      ///< an error waits for its acknowledgement before the start
    fifo_not_flushed,   ///< entries remained after `!FF`
    records_not_taken,  ///< the FIFO is empty after the first fill
    did_not_start,      ///< no printing state after `!GO`
    did_not_stop,       ///< still printing after `!ST`
    impossible_report,  ///< the printer reports numbers that were never sent: somebody else feeds it
    printer_restarted,  ///< the printer lost its memory: it was switched off or restarted
    no_answer,          ///< an inquiry was not answered in time
    not_secured,        ///< answers come, but none secured by CRC32 as it was asked for
    link_lost,          ///< the connection broke
    unreachable,        ///< there never was a connection
    records_in_doubt,   ///< nobody knows whether some records were printed
    ran_dry,            ///< the printer ran empty: records were not at hand in time
    storage_failed,     ///< the ledger cannot be written
    line_noise,         ///< a record may have reached the printer damaged: the line was stopped before it was printed
};

/// The end of a run.
struct Outcome {
    OutcomeCode code = OutcomeCode::finished;
    protocol::MachineState machine = protocol::MachineState::standby; ///< as last reported
    protocol::PrinterError error{};                                   ///< as last reported
    /// At least one record of this run may have gone out; if not, the ledger calls those it had granted unused.
    bool issued = true;
    /// A print that had not finished when the printer stood, as last seen; 0 = none. If the run stays open, no later
    /// answer tells it: the printer may be started again behind it.
    RecordNumber broken_off{};
    /// Nobody knew which records were printed: the printer may have gone on behind some that it has thrown away. If the
    /// run stays open and the printer then loses its number, its counter alone does not tell them.
    bool unclear = false;

    friend bool operator==(const Outcome&, const Outcome&) = default;
    friend std::ostream& operator<<(std::ostream& out, const Outcome& outcome);
};

/// One line: what happened and what to do.
[[nodiscard]] std::string describe(const Outcome& outcome);

/// Name for logs and JSON, e.g. "printer_error".
[[nodiscard]] std::string_view to_string(OutcomeCode code);

} // namespace linefeed::feeder
