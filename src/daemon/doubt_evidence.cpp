#include "daemon/doubt_evidence.hpp"

#include "daemon/record_ranges.hpp"
#include "store/evidence_json.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace linefeed::daemon {

namespace {

using Json = nlohmann::ordered_json;
using spool::LedgerKind;
using spool::LedgerRow;
using spool::RecordState;

/// What the in_doubt row of the ledger remembers of the printer's words (settle_json).
struct SettleWords {
    std::string serial_number;
    RecordNumber last_printed;
    bool last_print_finished = false;
    std::optional<std::uint32_t> total_prints;
    bool restarted = false;
};

SettleWords read_settle(const std::string& evidence) {
    SettleWords words;
    const Json json = Json::parse(evidence, nullptr, false);
    if (!json.is_object()) {
        return words;
    }
    constexpr std::size_t sm_values = 5;
    constexpr std::size_t last_printed_at = 2;
    constexpr std::size_t finished_at = 4;
    if (const auto sm = json.find("sm");
        sm != json.end() && sm->is_array() && sm->size() == sm_values && sm->at(last_printed_at).is_number_unsigned()) {
        words.last_printed = RecordNumber{sm->at(last_printed_at).get<std::uint32_t>()};
        words.last_print_finished = sm->at(finished_at) == 1;
    }
    if (const auto total = json.find("total"); total != json.end() && total->is_number_unsigned()) {
        words.total_prints = total->get<std::uint32_t>();
    }
    if (const auto serial = json.find("serial_number"); serial != json.end() && serial->is_string()) {
        words.serial_number = serial->get<std::string>();
    }
    const auto restarted = json.find("restarted");
    words.restarted = restarted != json.end() && (*restarted == true || *restarted == 1);
    return words;
}

/// The run that left the records in doubt, and the row that says so.
struct DoubtRows {
    std::optional<LedgerRow> run_started;
    std::optional<LedgerRow> in_doubt;
};

Result<DoubtRows> find_rows(spool::Spool& spool, spool::JobId job, const spool::LedgerSegment& segment) {
    auto rows = spool.doubt_rows(job, segment.run);
    if (!rows) {
        return rows.error();
    }
    DoubtRows found;
    for (LedgerRow& row : *rows) {
        if (row.entry.kind == LedgerKind::run_started) {
            found.run_started = std::move(row);
        } else if (row.entry.range.contains(segment.range.first())) {
            found.in_doubt = std::move(row);
        }
    }
    return found;
}

/// The prints that the counter has seen since the run began; absent = it does not tell: not reported, of another
/// printer, or it does not move.
std::optional<std::uint32_t> prints_of(const store::RunStart& start, const SettleWords& words) {
    const bool same_printer =
        start.serial_number.empty() || words.serial_number.empty() || start.serial_number == words.serial_number;
    if (!same_printer || !start.total_before || !words.total_prints || *words.total_prints == *start.total_before) {
        return std::nullopt;
    }
    return *words.total_prints - *start.total_before; // wraps at 32 bits, as the counter does
}

void judge(DoubtEvidence& evidence, const DoubtRows& rows) {
    if (!rows.run_started || !rows.in_doubt) {
        return;
    }
    const SettleWords words = read_settle(rows.in_doubt->entry.evidence);
    if (words.restarted) {
        evidence.hole = "the printer was stopped and started again while records were on their way to it, and may have "
                        "thrown some of them away";
        return;
    }
    const auto start = store::parse_run_start(rows.run_started->entry.evidence);
    const auto prints = start ? prints_of(*start, words) : std::nullopt;
    if (!prints) {
        return;
    }
    // A print that was started and not finished, or during which the printer lost its memory, may not be counted yet.
    const bool exact = words.last_print_finished && words.last_printed != RecordNumber{};
    const std::uint64_t first = rows.run_started->entry.range.first().value();
    const std::uint64_t most = first + *prints - (exact ? 1 : 0);
    if (most < RecordNumber::max().value()) {
        evidence.most_printed = RecordNumber{static_cast<std::uint32_t>(most)};
    }
    const RecordRange& in_doubt = rows.in_doubt->entry.range;
    if (in_doubt.contains(words.last_printed) && words.last_printed.value() > most) {
        evidence.hole = "the printer names record " + std::to_string(words.last_printed.value()) +
                        " as the last, but has counted only " + std::to_string(*prints) + " prints since record " +
                        std::to_string(first) + ", so it has left records out";
    }
}

} // namespace

Result<DoubtEvidence> doubt_evidence(spool::Spool& spool, const spool::Job& job) {
    const auto state = spool.ledger_state(job.id);
    if (!state) {
        return state.error();
    }
    DoubtEvidence evidence;
    evidence.ranges = state->ranges(RecordState::in_doubt);
    for (const spool::LedgerSegment& segment : state->segments()) {
        if (segment.state == RecordState::in_doubt) {
            evidence.segments.push_back(segment);
        }
    }
    if (evidence.segments.size() > 1) {
        evidence.hole = "several stretches of records are in doubt, " + to_text(evidence.ranges) +
                        ", and one product cannot tell about all of them";
    } else if (!evidence.segments.empty()) {
        const auto rows = find_rows(spool, job.id, evidence.segments.front());
        if (!rows) {
            return rows.error();
        }
        judge(evidence, *rows);
    }
    return evidence;
}

} // namespace linefeed::daemon
