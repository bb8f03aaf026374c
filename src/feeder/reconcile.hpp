// After any interruption the truth about the records that were issued is put together from evidence (design, section
// 1). One function decides the fate of every one of them; no default ever guesses.
#pragma once

#include "base/record_number.hpp"
#include "protocol/messages.hpp"

#include <cstdint>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>

namespace linefeed::feeder {

/// Which printer it is and what it said of itself; absent = it did not answer.
struct PrinterFacts {
    std::optional<protocol::VersionInfo> version; ///< `=VS`
    std::optional<std::uint32_t> total_prints;    ///< `=CC`, third parameter: never reset, moved by every print
    std::optional<std::string> job_name;          ///< `=JL`

    friend bool operator==(const PrinterFacts&, const PrinterFacts&) = default;
};

/// Records that were issued and whose fate is not known yet.
/// Invariant: first − 1 ≤ printed_through ≤ issued_through.
struct OpenRun {
    RecordNumber first;                        ///< the first record of the run
    RecordNumber printed_through;              ///< confirmed so far; first − 1 = none
    RecordNumber issued_through;               ///< no record behind this one can be in the printer
    std::string serial_number;                 ///< of the printer, as the run began; empty = unknown
    std::optional<std::uint32_t> total_before; ///< total print counter as the run began
    RecordNumber last_printed_before; ///< `=SM`, last printed record number as the run began: left over from before
    /// The last record of the run; absent = unknown. Behind it an end marker may have been printed.
    std::optional<RecordNumber> last{};
    /// Evidence::broken_off as it was last seen; 0 = none.
    RecordNumber broken_off{};
    /// Outcome::unclear: it was seen that records may have been left out.
    bool unclear = false;

    friend bool operator==(const OpenRun&, const OpenRun&) = default;
};

/// What a verdict rests on, strongest first.
enum class Basis {
    mail_status_and_counter, ///< fresh `=SM`, and the total print counter agrees
    end_message,             ///< message 1223: the printer stopped itself behind the stop-at record
    mail_status,             ///< fresh `=SM` alone, under our eyes: no counter is reported, or it does not move
    counter,                 ///< the total print counter alone, an upper bound: the printer has lost its memory
    nothing_issued,          ///< no record had been issued
    none,                    ///< no evidence: the records are in doubt
};
[[nodiscard]] std::string_view to_string(Basis basis);

/// What the printer said after the interruption.
struct Evidence {
    protocol::MailStatus mail; ///< the second of two answers
    PrinterFacts printer;
    bool end_message = false; ///< 1223 was raised during this run and the stop point was its last record
    /// The connection has not broken since the run began, so the printer was not switched off and restarted meanwhile.
    bool uninterrupted = false;
    /// The printer was stopped and started again while records were on their way to it: it may have thrown some away
    /// and gone on behind them. Its number counts only if the total print counter agrees.
    bool restarted = false;
    /// No stop point stood all the time, so such a restart may have gone unseen.
    bool restart_unseen = false;
    /// It has reported what was never sent, or had no room for what was: somebody else feeds it, so no number is surely
    /// ours.
    bool fed_by_another = false;
    /// A print that had not finished when the printer stood; 0 = none. A number behind it does not make it whole.
    RecordNumber broken_off{};

    friend bool operator==(const Evidence&, const Evidence&) = default;
};

/// The fate of every issued record: printed, in doubt and unused are consecutive, ascending, and together all that was
/// neither confirmed before nor never issued.
struct Verdict {
    RecordRange printed{};  ///< newly known to be printed
    RecordRange in_doubt{}; ///< nobody knows
    RecordRange unused{};   ///< surely not printed
    Basis basis = Basis::none;

    friend bool operator==(const Verdict&, const Verdict&) = default;
    friend std::ostream& operator<<(std::ostream& out, const Verdict& verdict);
};

/// Both serial numbers are known and differ.
[[nodiscard]] bool is_another_printer(const OpenRun& run, const PrinterFacts& printer);

/// Decides. Evidence counts, strongest first: a fresh `=SM` whose number lies within what was issued, by the same
/// printer that has printed nothing else; the counter as a bound, when the printer lost its memory. `last print
/// finished` = 0 makes exactly one record doubtful.
[[nodiscard]] Verdict reconcile(const OpenRun& run, const Evidence& evidence);

} // namespace linefeed::feeder
