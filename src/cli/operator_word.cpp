#include "cli/operator_word.hpp"

#include "cli/record_text.hpp"

#include <nlohmann/json.hpp>

#include <charconv>
#include <pwd.h>
#include <unistd.h>
#include <vector>

namespace linefeed::cli {

namespace {

using spool::LedgerEntry;
using spool::LedgerKind;
using spool::RecordState;

std::string who() {
    const passwd* user = ::getpwuid(::getuid());
    return user != nullptr ? user->pw_name : "uid " + std::to_string(::getuid());
}

std::string evidence(const std::string& said) {
    return nlohmann::ordered_json{{"operator", who()}, {"said", said}}.dump(
        -1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

/// The records that may be on the last product: those in doubt, and the one before the first.
std::vector<RecordNumber> candidates(const spool::Job& job, const std::vector<RecordRange>& doubt) {
    std::vector<RecordNumber> numbers;
    const RecordNumber first = doubt.front().first();
    if (first > job.records.first()) {
        numbers.push_back(first.previous());
    }
    for (const RecordRange& range : doubt) {
        for (std::uint64_t i = 0; i < range.count().value(); ++i) {
            numbers.push_back(range.first() + RecordCount{i});
        }
    }
    return numbers;
}

/// The record on the last product, by number or text. 0 = none of the job has been printed.
Result<RecordNumber> last_printed(spool::Spool& spool, const spool::Job& job, const std::vector<RecordRange>& doubt,
                                  const std::string& said) {
    const RecordFormat format = record_format(job);
    const std::vector<RecordNumber> possible = candidates(job, doubt);
    std::vector<RecordNumber> by_number;
    std::vector<RecordNumber> by_text;
    std::uint32_t number = 0;
    const auto [stop, error] = std::from_chars(said.data(), said.data() + said.size(), number);
    const bool is_number = error == std::errc{} && stop == said.data() + said.size();
    for (const RecordNumber candidate : possible) {
        if (is_number && candidate == RecordNumber{number}) {
            by_number.push_back(candidate);
        }
        const auto page = spool.read_page(job.id, candidate);
        if (!page) {
            return page.error();
        }
        if (joined(record_fields(*page, candidate, format), " ") == said) {
            by_text.push_back(candidate);
        }
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
        std::to_string(possible.front().value()) + " to " + std::to_string(doubt.back().last().value());
    return Failure{FailureKind::usage,
                   found.empty() ? "--last-printed " + said + ": no record from " + range + " has this number or text"
                                 : "--last-printed " + said + ": several records from " + range +
                                       " have this text; say the number"};
}

} // namespace

Result<void> settle_by_operator(spool::Spool& spool, const spool::Job& job, const OperatorWord& word) {
    const auto state = spool.ledger_state(job.id);
    if (!state) {
        return state.error();
    }
    const std::vector<RecordRange> doubt = state->ranges(RecordState::in_doubt);
    if (doubt.empty()) {
        return {};
    }
    std::optional<RecordNumber> last;
    if (!word.last_printed.empty()) {
        const auto found = last_printed(spool, job, doubt, word.last_printed);
        if (!found) {
            return found.error();
        }
        last = *found;
    }
    std::vector<LedgerEntry> entries;
    for (const spool::LedgerSegment& segment : state->segments()) {
        if (segment.state != RecordState::in_doubt) {
            continue;
        }
        if (!last) {
            const bool skip = word.policy == InDoubtPolicy::skip;
            entries.push_back({skip ? LedgerKind::skipped : LedgerKind::released, segment.run, segment.range,
                               evidence(skip ? "do not print again" : "print again")});
            continue;
        }
        const std::string said = evidence("last printed: " + word.last_printed);
        const RecordRange printed = RecordRange::closed(segment.range.first(), std::min(*last, segment.range.last()));
        const RecordRange rest =
            *last >= segment.range.last()
                ? RecordRange{}
                : RecordRange::closed(std::max(segment.range.first(), last->next()), segment.range.last());
        if (!printed.empty()) {
            entries.push_back({LedgerKind::printed, segment.run, printed, said});
        }
        if (!rest.empty()) {
            entries.push_back({LedgerKind::unused, segment.run, rest, said});
        }
    }
    return spool.append(job.id, entries);
}

} // namespace linefeed::cli
