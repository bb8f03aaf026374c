// What the feeder wants done. Inquiries, commands and records go to the printer; the rest goes to the ledger and to
// people. Records are named by their places (numbering.hpp) unless said otherwise.
#pragma once

#include "base/bounded_list.hpp"
#include "base/record_number.hpp"
#include "feeder/outcome.hpp"
#include "feeder/reconcile.hpp"
#include "protocol/commands.hpp"

#include <ostream>
#include <variant>

namespace linefeed::feeder {

/// `?XX`.
struct Inquire {
    protocol::Parameter what = protocol::Parameter::SM;
    friend bool operator==(const Inquire&, const Inquire&) = default;
};
/// `!XX`: GO, ST, NO, FF or EQ.
struct Command {
    protocol::Action what = protocol::Action::stop_print;
    friend bool operator==(const Command&, const Command&) = default;
};
/// `=CM`.
struct SetStopAt {
    RecordNumber number; ///< as it goes out
    friend bool operator==(const SetStopAt&, const SetStopAt&) = default;
};
/// `=MR` for each record, in one gather write.
struct SendRecords {
    RecordRange range;
    friend bool operator==(const SendRecords&, const SendRecords&) = default;
};
/// `=MR` with a blank field: keeps a printer that ignores `=CM` from running empty (field notes, "Firmware habits").
struct SendEndMarker {
    RecordNumber number; ///< as it goes out
    friend bool operator==(const SendEndMarker&, const SendEndMarker&) = default;
};
/// To the ledger: the fate of the records of an earlier run, or of this run at its end. Answered by
/// Feeder::on_settled.
struct Settle {
    Verdict verdict;
    Evidence evidence;
    bool earlier_run = false;
    /// Only what is surely printed is known so far; the rest stays open until the FIFO is empty.
    bool provisional = false;
    /// Confirmed before. The store may not have been told yet: confirmations wait while it is busy, a verdict does not.
    RecordNumber confirmed_through{};
    friend bool operator==(const Settle&, const Settle&) = default;
};
/// To the ledger: grant records for a new run. Answered by Feeder::on_granted; for a follower, if it may begin, by
/// Feeder::on_follower_begun.
struct BeginRun {
    PrinterFacts printer;
    RecordNumber last_printed_before; ///< OpenRun::last_printed_before
    bool follower = false; ///< of the job that waits behind this run's: as things stand when all of that is printed
    friend bool operator==(const BeginRun&, const BeginRun&) = default;
};
/// To the ledger: the earlier run is still printing and goes on. Answered by Feeder::on_granted.
struct AdoptRun {
    RecordNumber printed_through; ///< surely printed
    RecordNumber sent_through;    ///< the last record in the printer
    protocol::MailStatus evidence;
    friend bool operator==(const AdoptRun&, const AdoptRun&) = default;
};
/// To the ledger: records up to `through` may go out. Answered by Feeder::on_durable.
struct AskIntent {
    RecordNumber through;
    friend bool operator==(const AskIntent&, const AskIntent&) = default;
};
/// To the ledger: the printer reports that records up to `through` are printed.
struct ConfirmPrinted {
    RecordNumber through;
    protocol::MailStatus evidence;
    friend bool operator==(const ConfirmPrinted&, const ConfirmPrinted&) = default;
};
/// To people; printing goes on.
enum class NoticeCode {
    printing_started,   ///< the printer is in state printing
    follower_printing,  ///< the first record of the next job is printed, behind all of the one before it
    stop_point_ignored, ///< `=CM` is not kept: an end marker will follow the last record, and the next product may come
                        ///< out blank
    error_acknowledged, ///< a mailing error of an earlier run was acknowledged
    printer_warning,    ///< the printer shows a warning or message and prints on
    taken_over,         ///< the printer was still printing the earlier run, which goes on without a stop
    found_printing,     ///< the printer was still printing the earlier run: it is stopped to learn the truth
    nozzle_opening,     ///< waiting for the nozzle
    supply_low,         ///< the FIFO runs empty soon, and no record is at hand
    entries_differ,     ///< the FIFO holds another number of entries than was sent
};
struct Notice {
    NoticeCode code = NoticeCode::printing_started;
    protocol::PrinterError error{};
    friend bool operator==(const Notice&, const Notice&) = default;
};
/// The run is over; nothing follows.
struct End {
    Outcome outcome;
    friend bool operator==(const End&, const End&) = default;
};

using Action = std::variant<std::monostate, Inquire, Command, SetStopAt, SendRecords, SendEndMarker, Settle, BeginRun,
                            AdoptRun, AskIntent, ConfirmPrinted, Notice, End>;
std::ostream& operator<<(std::ostream& out, const Action& action);

/// Most actions that one fact can cause.
inline constexpr std::size_t max_actions = 16;
using Actions = BoundedList<Action, max_actions>;

/// One line for the operator.
[[nodiscard]] std::string describe(const Notice& notice);

} // namespace linefeed::feeder
