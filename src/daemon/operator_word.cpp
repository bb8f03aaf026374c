#include "daemon/operator_word.hpp"

#include "base/assert.hpp"
#include "daemon/job_records.hpp"
#include "daemon/record_ranges.hpp"
#include "daemon/record_text.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <vector>

namespace linefeed::daemon {

namespace {

using spool::LedgerEntry;
using spool::LedgerKind;
using spool::RecordState;

std::string evidence(const std::string& who, const std::string& said) {
    return nlohmann::ordered_json{{"operator", who}, {"said", said}}.dump(
        -1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

/// The records that may be on the last product: those in doubt, and the one before the first.
std::vector<RecordRange> candidates(const spool::Job& job, const std::vector<RecordRange>& doubt) {
    std::vector<RecordRange> ranges = doubt;
    const RecordNumber first = doubt.front().first();
    if (first > job.records.first()) {
        ranges.front() = RecordRange::closed(first.previous(), doubt.front().last());
    }
    return ranges;
}

/// The record on the last product, by number or text. 0 = none of the job has been printed.
Result<RecordNumber> last_printed(spool::Spool& spool, const spool::Job& job, const std::vector<RecordRange>& doubt,
                                  const std::string& said) {
    const std::vector<RecordRange> possible = candidates(job, doubt);
    std::vector<RecordNumber> by_number;
    std::vector<RecordNumber> by_text;
    std::uint32_t number = 0;
    const auto [stop, error] = std::from_chars(said.data(), said.data() + said.size(), number);
    const bool is_number = error == std::errc{} && stop == said.data() + said.size();
    const auto read = for_each_record(spool, job, possible, [&](const DoubtView::Record& candidate) {
        if (is_number && candidate.number == RecordNumber{number}) {
            by_number.push_back(candidate.number);
        }
        if (joined(candidate.fields, " ") == said) {
            by_text.push_back(candidate.number);
        }
        return true;
    });
    if (!read) {
        return read.error();
    }
    if (is_number && number == doubt.front().first().previous().value()) {
        by_number = {doubt.front().first().previous()};
    }
    std::vector<RecordNumber> found = by_text;
    if (!by_number.empty() && (by_text.empty() || by_text == by_number)) {
        found = by_number;
    } else if (!by_number.empty()) {
        return Failure{FailureKind::usage, "--last-printed " + said + " is the number of record " +
                                               std::to_string(by_number.front().value()) + " and the text of record " +
                                               std::to_string(by_text.front().value()) +
                                               ": say the number of the record that is on the last product"};
    }
    if (found.size() == 1) {
        return found.front();
    }
    const std::string range =
        std::to_string(possible.front().first().value()) + " to " + std::to_string(doubt.back().last().value());
    return Failure{FailureKind::usage,
                   found.empty() ? "--last-printed " + said + ": no record from " + range + " has this number or text"
                                 : "--last-printed " + said + ": several records from " + range +
                                       " have this text; say the number"};
}

std::string how_to_name_all(const DoubtEvidence& doubt) {
    return "look which of the records in doubt, " + to_text(doubt.ranges) +
           ", are on products, and name all of these with --printed (N-M,N or none)";
}

/// The record on the last product tells about all of them.
Result<void> check_last_printed(const DoubtEvidence& doubt, const OperatorWord& word) {
    if (doubt.may_have_hole()) {
        return Failure{FailureKind::usage, "--last-printed " + word.last_printed + " is not enough to go on: " +
                                               doubt.hole + "; " + how_to_name_all(doubt)};
    }
    return {};
}

/// The records in doubt that are printed, by the last of them.
Result<std::vector<RecordRange>> printed_by_last(spool::Spool& spool, const spool::Job& job, const DoubtEvidence& doubt,
                                                 const OperatorWord& word) {
    if (const auto sound = check_last_printed(doubt, word); !sound) {
        return sound.error();
    }
    const auto last = last_printed(spool, job, doubt.ranges, word.last_printed);
    if (!last) {
        return last.error();
    }
    const RecordRange& in_doubt = doubt.ranges.front(); // there is only one, or there may be a hole
    if (doubt.most_printed && *last > *doubt.most_printed && in_doubt.contains(*last)) {
        return Failure{FailureKind::usage, "--last-printed " + word.last_printed +
                                               " cannot mean that all before it are printed: by its total print "
                                               "counter the printer came no further than record " +
                                               std::to_string(doubt.most_printed->value()) + "; " +
                                               how_to_name_all(doubt)};
    }
    const RecordRange printed = RecordRange::closed(in_doubt.first(), *last);
    return printed.empty() ? std::vector<RecordRange>{} : std::vector<RecordRange>{printed};
}

/// The records in doubt that are printed, all of them named.
Result<std::vector<RecordRange>> printed_by_name(const DoubtEvidence& doubt, const std::string& said) {
    auto printed = parse_record_ranges(said);
    if (!printed) {
        return Failure{FailureKind::usage, "--printed: " + printed.error().message};
    }
    for (const RecordRange& range : *printed) {
        const bool within = std::any_of(doubt.ranges.begin(), doubt.ranges.end(), [&](const RecordRange& in_doubt) {
            return in_doubt.contains(range.first()) && in_doubt.contains(range.last());
        });
        if (!within) {
            return Failure{FailureKind::usage, "--printed " + to_text(range) +
                                                   ": only these records are in doubt: " + to_text(doubt.ranges)};
        }
    }
    return printed;
}

/// Rows for one stretch: what of it is printed, and the rest, which is not.
void add_rows(const spool::LedgerSegment& segment, const std::vector<RecordRange>& printed, const std::string& said,
              std::vector<LedgerEntry>& entries) {
    const RecordRange all = segment.range;
    std::optional<RecordNumber> next = all.first(); // of what has no row yet
    const auto add = [&](LedgerKind kind, RecordNumber last) {
        if (const RecordRange part = RecordRange::closed(*next, last); !part.empty()) {
            entries.push_back({kind, segment.run, part, said});
        }
        next = last == all.last() ? std::nullopt : std::optional{last.next()};
    };
    for (const RecordRange& range : printed) {
        const RecordRange part =
            RecordRange::closed(std::max(range.first(), all.first()), std::min(range.last(), all.last()));
        if (part.empty()) {
            continue;
        }
        if (part.first() > *next) {
            add(LedgerKind::unused, part.first().previous());
        }
        add(LedgerKind::printed, part.last());
    }
    if (next) {
        add(LedgerKind::unused, all.last());
    }
}

} // namespace

Result<std::vector<LedgerEntry>> rows_by_operator(spool::Spool& spool, const spool::Job& job, const OperatorWord& word,
                                                  const std::string& who) {
    LINEFEED_ASSERT(word.given());
    const auto doubt = doubt_evidence(spool, job);
    if (!doubt) {
        return doubt.error();
    }
    std::vector<LedgerEntry> entries;
    if (doubt->segments.empty()) {
        return entries;
    }
    if (word.last_printed.empty() && !word.printed) {
        const bool skip = word.policy == InDoubtPolicy::skip;
        for (const spool::LedgerSegment& segment : doubt->segments) {
            entries.push_back({skip ? LedgerKind::skipped : LedgerKind::released, segment.run, segment.range,
                               evidence(who, skip ? "do not print again" : "print again")});
        }
        return entries;
    }
    const auto printed =
        word.printed ? printed_by_name(*doubt, *word.printed) : printed_by_last(spool, job, *doubt, word);
    if (!printed) {
        return printed.error();
    }
    const std::string said =
        evidence(who, word.printed ? "printed: " + *word.printed : "last printed: " + word.last_printed);
    for (const spool::LedgerSegment& segment : doubt->segments) {
        add_rows(segment, *printed, said, entries);
    }
    return entries;
}

Result<void> settle_by_operator(spool::Spool& spool, const spool::Job& job, const OperatorWord& word,
                                const std::string& who) {
    const auto rows = rows_by_operator(spool, job, word, who);
    if (!rows) {
        return rows.error();
    }
    return rows->empty() ? Result<void>{} : spool.append(job.id, *rows);
}

} // namespace linefeed::daemon
