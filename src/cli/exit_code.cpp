#include "cli/exit_code.hpp"

#include "base/assert.hpp"

namespace linefeed::cli {

ExitCode exit_code(FailureKind kind) {
    switch (kind) {
    case FailureKind::usage:
        return ExitCode::usage;
    case FailureKind::unreachable:
        return ExitCode::unreachable;
    case FailureKind::stopped:
        return ExitCode::stopped;
    case FailureKind::input:
        return ExitCode::input_rejected;
    case FailureKind::in_doubt:
        return ExitCode::in_doubt;
    case FailureKind::storage:
    case FailureKind::internal:
        return ExitCode::other;
    }
    assertion_failed("FailureKind", __FILE__, __LINE__);
}

ExitCode exit_code(const feeder::Outcome& outcome) {
    using feeder::OutcomeCode;
    switch (outcome.code) {
    case OutcomeCode::finished:
    case OutcomeCode::nothing_to_print:
        return ExitCode::done;
    case OutcomeCode::unreachable:
        return ExitCode::unreachable;
    case OutcomeCode::no_answer:
    case OutcomeCode::not_secured:
    case OutcomeCode::link_lost:
        return outcome.issued ? ExitCode::stopped : ExitCode::unreachable;
    case OutcomeCode::records_in_doubt:
        return ExitCode::in_doubt;
    case OutcomeCode::stop_requested:
    case OutcomeCode::stopped_at_printer:
    case OutcomeCode::printer_error:
    case OutcomeCode::not_ready:
    case OutcomeCode::cover_open:
    case OutcomeCode::busy:
    case OutcomeCode::error_pending:
    case OutcomeCode::fifo_not_flushed:
    case OutcomeCode::records_not_taken:
    case OutcomeCode::did_not_start:
    case OutcomeCode::did_not_stop:
    case OutcomeCode::impossible_report:
    case OutcomeCode::printer_restarted:
    case OutcomeCode::ran_dry:
    case OutcomeCode::line_noise:
        return ExitCode::stopped;
    case OutcomeCode::storage_failed:
        return outcome.issued ? ExitCode::stopped : ExitCode::other;
    }
    assertion_failed("OutcomeCode", __FILE__, __LINE__);
}

} // namespace linefeed::cli
