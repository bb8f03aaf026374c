#include "feeder/outcome.hpp"

#include "feeder/mailing_error.hpp"

namespace linefeed::feeder {

std::string_view to_string(OutcomeCode code) {
    switch (code) {
    case OutcomeCode::finished:
        return "finished";
    case OutcomeCode::nothing_to_print:
        return "nothing_to_print";
    case OutcomeCode::stop_requested:
        return "stop_requested";
    case OutcomeCode::stopped_at_printer:
        return "stopped_at_printer";
    case OutcomeCode::printer_error:
        return "printer_error";
    case OutcomeCode::not_ready:
        return "not_ready";
    case OutcomeCode::cover_open:
        return "cover_open";
    case OutcomeCode::busy:
        return "busy";
    case OutcomeCode::error_pending:
        return "error_pending";
    case OutcomeCode::fifo_not_flushed:
        return "fifo_not_flushed";
    case OutcomeCode::records_not_taken:
        return "records_not_taken";
    case OutcomeCode::did_not_start:
        return "did_not_start";
    case OutcomeCode::did_not_stop:
        return "did_not_stop";
    case OutcomeCode::impossible_report:
        return "impossible_report";
    case OutcomeCode::printer_restarted:
        return "printer_restarted";
    case OutcomeCode::no_answer:
        return "no_answer";
    case OutcomeCode::not_secured:
        return "not_secured";
    case OutcomeCode::link_lost:
        return "link_lost";
    case OutcomeCode::unreachable:
        return "unreachable";
    case OutcomeCode::records_in_doubt:
        return "records_in_doubt";
    case OutcomeCode::ran_dry:
        return "ran_dry";
    case OutcomeCode::storage_failed:
        return "storage_failed";
    case OutcomeCode::line_noise:
        return "line_noise";
    }
    assertion_failed("OutcomeCode", __FILE__, __LINE__);
}

std::ostream& operator<<(std::ostream& out, const Outcome& outcome) {
    return out << to_string(outcome.code) << " (" << protocol::to_string(outcome.machine) << ", error "
               << outcome.error.raw << ")";
}

namespace {

std::string not_ready(protocol::MachineState machine) {
    const std::string state = "the printer is not ready: it is in state \"" + std::string{to_string(machine)} + "\"; ";
    switch (machine) {
    case protocol::MachineState::unknown:
        return state + "linefeed knows no such state of this firmware; look at the printer, and start again";
    case protocol::MachineState::standby:
        return state + "switch it on, open the nozzle, and start again";
    case protocol::MachineState::initialising:
        return state + "wait until it is ready for print start, and start again";
    case protocol::MachineState::service:
        return state + "leave the service panel or interval mode, and start again";
    case protocol::MachineState::ready:
        return state + "open the nozzle at the printer or start with --open-nozzle";
    case protocol::MachineState::ready_to_print:
    case protocol::MachineState::printing:
        return state + "look at the printer, and start again";
    }
    assertion_failed("MachineState", __FILE__, __LINE__);
}

/// What linefeed knows of an error that comes from mailing; empty = nothing.
std::string cause_of(const protocol::PrinterError& error) {
    if (breaks_numbers(error)) {
        return ": a record was lost on the line, or another program has sent one; if it comes before the first print, "
               "this printer wants a new sequence to begin with number 0, which linefeed does not do";
    }
    return {};
}

} // namespace

std::string describe(const Outcome& outcome) {
    switch (outcome.code) {
    case OutcomeCode::finished:
        return "finished: every record is printed";
    case OutcomeCode::nothing_to_print:
        return "nothing to print";
    case OutcomeCode::stop_requested:
        return "stopped on request";
    case OutcomeCode::stopped_at_printer:
        return "printing was stopped at the printer";
    case OutcomeCode::printer_error:
        return "the printer reports error " + protocol::describe(outcome.error) + cause_of(outcome.error);
    case OutcomeCode::not_ready:
        return not_ready(outcome.machine);
    case OutcomeCode::cover_open:
        return "the head cover of the printer is open: close it, and start again";
    case OutcomeCode::busy:
        return "the printer is printing something that linefeed did not send: stop it at the printer, and start again";
    case OutcomeCode::error_pending:
        return "an error is pending at the printer: " + protocol::describe(outcome.error) +
               ": see to it and acknowledge it there, or start with --acknowledge " +
               std::to_string(outcome.error.code());
    case OutcomeCode::fifo_not_flushed:
        return "the printer did not empty its mailing FIFO on request: does another program feed it?";
    case OutcomeCode::records_not_taken:
        return "the printer took no records: its job needs a text object EXTTXT with field number 1 or more (mail "
               "mode), "
               "\"activate database\" must be off, and the job must be loaded again after editing";
    case OutcomeCode::did_not_start:
        return "the printer did not start printing";
    case OutcomeCode::did_not_stop:
        return "the printer did not stop on request: stop it at its panel";
    case OutcomeCode::impossible_report:
        return "the printer reports record numbers that were not sent: another program is feeding it; the line is "
               "stopped";
    case OutcomeCode::printer_restarted:
        return "the printer lost its memory: it was switched off or restarted";
    case OutcomeCode::no_answer:
        return "the printer does not answer: is it in standby, or is this the address of another device?";
    case OutcomeCode::not_secured:
        return "the printer answers, but without CRC32: its firmware knows no =NR, or something on the line takes it "
               "away; take crc=on out of the printer's address";
    case OutcomeCode::link_lost:
        return "the connection to the printer was lost";
    case OutcomeCode::unreachable:
        return "the printer cannot be reached";
    case OutcomeCode::records_in_doubt:
        return "nobody knows whether some records were printed: an operator must decide";
    case OutcomeCode::ran_dry:
        return "the printer ran empty, because the records were read more slowly than the line prints them";
    case OutcomeCode::storage_failed:
        return "the print ledger could not be written: the line is stopped";
    case OutcomeCode::line_noise:
        return "the line to the printer is disturbed: a record may have arrived damaged, so the printer was stopped "
               "before it; look at cable, shield and adapter";
    }
    assertion_failed("OutcomeCode", __FILE__, __LINE__);
}

} // namespace linefeed::feeder
