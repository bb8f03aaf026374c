#include "feeder/reconcile.hpp"

#include <algorithm>

namespace linefeed::feeder {

namespace {

RecordRange behind(RecordNumber number, RecordNumber last) {
    return number == RecordNumber::max() ? RecordRange{} : RecordRange::closed(number.next(), last);
}

Verdict all_in_doubt(const OpenRun& run) {
    return {.in_doubt = behind(run.printed_through, run.issued_through), .basis = Basis::none};
}

Verdict printed_through(const OpenRun& run, RecordNumber last, bool last_finished, Basis basis) {
    Verdict verdict;
    verdict.basis = basis;
    const bool last_is_doubtful = !last_finished && last > run.printed_through;
    const RecordNumber surely = last_is_doubtful ? last.previous() : last;
    verdict.printed = behind(run.printed_through, surely);
    if (last_is_doubtful) {
        verdict.in_doubt = RecordRange{last, RecordCount{1}};
    }
    verdict.unused = behind(last, run.issued_through);
    return verdict;
}

/// How many prints the total counter has seen since the run began; it wraps at 32 bits.
std::optional<std::uint32_t> prints_since(const OpenRun& run, const Evidence& evidence) {
    if (!run.total_before || !evidence.printer.total_prints) {
        return std::nullopt;
    }
    return *evidence.printer.total_prints - *run.total_before;
}

/// The counter alone. Behind a loss of memory it has seen the prints of whoever used the printer, so it only bounds
/// this run from above; and the print during which the memory was lost may be counted or not.
Verdict by_counter(const OpenRun& run, const Evidence& evidence) {
    const auto prints = prints_since(run, evidence);
    if (!prints || run.unclear) {
        return all_in_doubt(run);
    }
    const std::uint64_t in_progress = std::uint64_t{run.first.value()} + *prints;
    if (in_progress <= run.printed_through.value() || in_progress > std::uint64_t{run.issued_through.value()} + 1) {
        return all_in_doubt(run); // fewer prints than are known, or more than records were sent
    }
    const RecordNumber last{
        static_cast<std::uint32_t>(std::min(in_progress, std::uint64_t{run.issued_through.value()}))};
    return {.in_doubt = behind(run.printed_through, last),
            .unused = behind(last, run.issued_through),
            .basis = Basis::counter};
}

/// What the counter makes of the claim that records up to `last` are printed.
enum class CounterSays {
    agrees,
    more_was_printed, ///< something else was printed besides
    one_less,         ///< the print that was broken off is not counted, or the numbers have skipped a record
    too_few,          ///< the numbers have skipped records
    nothing,          ///< it is not reported, or does not move
};

CounterSays compare_counter(const OpenRun& run, const Evidence& evidence, RecordNumber last) {
    const auto prints = prints_since(run, evidence);
    LINEFEED_ASSERT(last >= run.first);
    const std::uint64_t claimed = (last - run.first).value() + 1;
    if (!prints) {
        return CounterSays::nothing;
    }
    if (*prints > claimed) {
        return CounterSays::more_was_printed;
    }
    if (*prints == claimed) {
        return CounterSays::agrees;
    }
    if (*prints == 0) {
        return CounterSays::nothing;
    }
    const bool one_less = *prints + std::uint64_t{1} == claimed && !evidence.mail.last_print_finished;
    return one_less ? CounterSays::one_less : CounterSays::too_few;
}

/// The number behind the last record: the blank end marker has it, which is sent when all records are.
bool is_marker_number(const OpenRun& run, RecordNumber number) {
    return run.last && run.issued_through == *run.last && *run.last < RecordNumber::max() && number == run.last->next();
}

/// The printer's number is believed. That of the end marker, finished or not, says that every record is printed.
Verdict printed_as_reported(const OpenRun& run, const Evidence& evidence, Basis basis) {
    const RecordNumber reported = evidence.mail.last_printed;
    return is_marker_number(run, reported) ? printed_through(run, run.issued_through, true, basis)
                                           : printed_through(run, reported, evidence.mail.last_print_finished, basis);
}

/// No record behind the reported one is printed. Up to it one may have been skipped.
Verdict doubtful_as_reported(const OpenRun& run, RecordNumber reported) {
    const RecordNumber last = std::min(reported, run.issued_through); // not that of the end marker
    return {.in_doubt = behind(run.printed_through, last),
            .unused = behind(last, run.issued_through),
            .basis = Basis::mail_status};
}

/// Nothing of the run is confirmed, and the printer reports the number that it had before the run. Either no record was
/// printed, or the printer was switched off, or exactly this record was the last one. The counter knows.
Verdict by_left_over_number(const OpenRun& run, const Evidence& evidence) {
    const RecordNumber reported = evidence.mail.last_printed;
    const bool within = run.first <= reported && reported <= run.issued_through;
    const bool marker = is_marker_number(run, reported);
    if (evidence.uninterrupted && !within && !marker) {
        return printed_through(run, run.printed_through, true, Basis::mail_status);
    }
    const auto prints = prints_since(run, evidence);
    if (prints && *prints == 0) {
        return printed_through(run, run.printed_through, true, Basis::mail_status_and_counter);
    }
    const bool agrees = (within || marker) && compare_counter(run, evidence, reported) == CounterSays::agrees;
    return agrees ? printed_as_reported(run, evidence, Basis::mail_status_and_counter) : all_in_doubt(run);
}

/// The printer reports no number: it has lost its memory, or nothing was printed since it had.
Verdict without_number(const OpenRun& run, const Evidence& evidence) {
    const bool nothing_confirmed = run.printed_through < run.first;
    const auto prints = prints_since(run, evidence);
    if (nothing_confirmed && prints && *prints == 0 &&
        (evidence.uninterrupted || run.last_printed_before == RecordNumber{})) {
        return printed_through(run, run.printed_through, true, Basis::mail_status_and_counter);
    }
    if (nothing_confirmed && evidence.uninterrupted) {
        // Under our eyes the printer printed none of these. If its counter moved all the same, one of the two is wrong.
        return prints ? all_in_doubt(run) : printed_through(run, run.printed_through, true, Basis::mail_status);
    }
    return by_counter(run, evidence);
}

/// The number lies within what was issued and not yet confirmed, or is that of the end marker. Another job that was
/// printed meanwhile and continues both the numbers and the count of this run exactly cannot be told from it.
Verdict by_number(const OpenRun& run, const Evidence& evidence) {
    const CounterSays counter = compare_counter(run, evidence, evidence.mail.last_printed);
    if (evidence.restarted && counter != CounterSays::agrees) {
        return all_in_doubt(run);
    }
    const bool unanswered = run.total_before && !evidence.printer.total_prints;
    if (unanswered && evidence.restart_unseen) {
        return all_in_doubt(run); // it could tell whether records were skipped
    }
    switch (counter) {
    case CounterSays::agrees:
        return printed_as_reported(run, evidence, Basis::mail_status_and_counter);
    case CounterSays::nothing: // While we were away it may have left records out, or printed others with such numbers.
        return evidence.uninterrupted ? printed_as_reported(run, evidence, Basis::mail_status) : all_in_doubt(run);
    case CounterSays::one_less:
        return evidence.uninterrupted && !evidence.restart_unseen
                   ? printed_as_reported(run, evidence, Basis::mail_status_and_counter)
                   : doubtful_as_reported(run, evidence.mail.last_printed);
    case CounterSays::too_few:          // A stop has emptied the FIFO, and it went on behind what it had thrown away.
    case CounterSays::more_was_printed: // Is this number still ours?
        return all_in_doubt(run);
    }
    assertion_failed("CounterSays", __FILE__, __LINE__);
}

Verdict without_broken_off(const Verdict& verdict, RecordNumber broken_off) {
    if (!verdict.printed.contains(broken_off)) {
        return verdict;
    }
    Verdict doubtful = verdict;
    doubtful.printed = RecordRange{verdict.printed.first(), broken_off - verdict.printed.first()};
    doubtful.in_doubt =
        behind(broken_off.previous(), verdict.in_doubt.empty() ? verdict.printed.last() : verdict.in_doubt.last());
    return doubtful;
}

Verdict by_all_evidence(const OpenRun& run, const Evidence& evidence) {
    if (run.issued_through == run.printed_through) {
        Verdict verdict;
        verdict.basis = Basis::nothing_issued;
        return verdict;
    }
    const bool of_another = evidence.fed_by_another && prints_since(run, evidence) != 0U; // if anything is printed
    if (is_another_printer(run, evidence.printer) || of_another) {
        return all_in_doubt(run);
    }
    if (evidence.end_message && compare_counter(run, evidence, run.issued_through) != CounterSays::too_few) {
        return printed_through(run, run.issued_through, true, Basis::end_message);
    }
    const RecordNumber reported = evidence.mail.last_printed;
    if (reported == RecordNumber{}) {
        return without_number(run, evidence);
    }
    if (run.printed_through < run.first && reported == run.last_printed_before) {
        return by_left_over_number(run, evidence);
    }
    const RecordNumber least = std::max(run.first, run.printed_through);
    const bool within = least <= reported && reported <= run.issued_through;
    return within || is_marker_number(run, reported) ? by_number(run, evidence) : all_in_doubt(run);
}

} // namespace

bool is_another_printer(const OpenRun& run, const PrinterFacts& printer) {
    return !run.serial_number.empty() && printer.version && !printer.version->serial_number.empty() &&
           printer.version->serial_number != run.serial_number;
}

std::string_view to_string(Basis basis) {
    switch (basis) {
    case Basis::mail_status_and_counter:
        return "mail status and total print counter";
    case Basis::end_message:
        return "end message 1223";
    case Basis::mail_status:
        return "mail status";
    case Basis::counter:
        return "total print counter";
    case Basis::nothing_issued:
        return "nothing was issued";
    case Basis::none:
        return "no evidence";
    }
    assertion_failed("Basis", __FILE__, __LINE__);
}

std::ostream& operator<<(std::ostream& out, const Verdict& verdict) {
    return out << "printed " << verdict.printed << ", in doubt " << verdict.in_doubt << ", unused " << verdict.unused
               << " by " << to_string(verdict.basis);
}

Verdict reconcile(const OpenRun& run, const Evidence& evidence) {
    LINEFEED_ASSERT(run.first.value() > 0 && run.first.previous() <= run.printed_through);
    LINEFEED_ASSERT(run.printed_through <= run.issued_through);
    return without_broken_off(by_all_evidence(run, evidence), evidence.broken_off);
}

} // namespace linefeed::feeder
