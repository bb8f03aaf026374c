// LedgerState against a model that keeps one state a record: random rows, lawful or not, must give the same everywhere.
#include "spool/ledger.hpp"
#include "spool_fixture.hpp"

#include <array>
#include <random>

namespace linefeed::spool {
namespace {

constexpr std::uint32_t record_count = 40;

struct Fate {
    RecordState state = RecordState::fresh;
    RunId run{};
    friend bool operator==(const Fate&, const Fate&) = default;
};

/// One state for each record, and the law written down a second time.
struct Model {
    std::array<Fate, record_count> records;

    static std::optional<RecordState> next(LedgerKind kind, RecordState state) {
        const bool printable =
            state == RecordState::fresh || state == RecordState::unused || state == RecordState::released;
        const bool undecided = state == RecordState::open || state == RecordState::in_doubt;
        switch (kind) {
        case LedgerKind::intent:
            return printable ? std::optional{RecordState::open} : std::nullopt;
        case LedgerKind::printed:
            return undecided ? std::optional{RecordState::printed} : std::nullopt;
        case LedgerKind::unused:
            return undecided ? std::optional{RecordState::unused} : std::nullopt;
        case LedgerKind::in_doubt:
            return state == RecordState::open ? std::optional{RecordState::in_doubt} : std::nullopt;
        case LedgerKind::skipped:
            return state == RecordState::in_doubt ? std::optional{RecordState::skipped} : std::nullopt;
        case LedgerKind::released:
            return state == RecordState::in_doubt ? std::optional{RecordState::released} : std::nullopt;
        case LedgerKind::reprint:
            return state == RecordState::printed || state == RecordState::skipped ? std::optional{RecordState::released}
                                                                                  : std::nullopt;
        case LedgerKind::run_started:
        case LedgerKind::run_ended:
            return state;
        }
        return std::nullopt;
    }
    bool apply(const LedgerEntry& entry) {
        auto changed = records;
        for (std::uint32_t i = 0; i < record_count; ++i) {
            if (entry.range.contains(RecordNumber{i})) {
                const auto state = next(entry.kind, records[i].state);
                if (!state) {
                    return false;
                }
                changed[i] = {*state, entry.run};
            }
        }
        records = changed;
        return true;
    }
};

void expect_same(const LedgerState& state, const Model& model) {
    std::uint64_t known = 0;
    const LedgerSegment* before = nullptr;
    for (const LedgerSegment& segment : state.segments()) {
        ASSERT_FALSE(segment.range.empty());
        ASSERT_NE(segment.state, RecordState::fresh);
        if (before != nullptr) {
            ASSERT_LT(before->range.last(), segment.range.first());
            const bool touching = before->range.last().next() == segment.range.first();
            ASSERT_FALSE(touching && before->state == segment.state && before->run == segment.run) << "not joined";
        }
        before = &segment;
        for (std::uint64_t i = 0; i < segment.range.count().value(); ++i) {
            const RecordNumber number = segment.range.first() + RecordCount{i};
            ASSERT_EQ((Fate{segment.state, segment.run}), model.records[number.value()]) << number;
            ++known;
        }
    }
    std::uint64_t expected = 0;
    for (std::uint32_t i = 0; i < record_count; ++i) {
        expected += model.records[i].state == RecordState::fresh ? 0U : 1U;
        ASSERT_EQ(state.state_of(RecordNumber{i}), model.records[i].state) << i;
    }
    ASSERT_EQ(known, expected);
}

void expect_same_offer(const LedgerState& state, const Model& model, RecordRange wanted) {
    std::optional<RecordNumber> first;
    std::optional<RecordNumber> last;
    for (std::uint64_t i = 0; i < wanted.count().value(); ++i) {
        const RecordNumber number = wanted.first() + RecordCount{i};
        if (Model::next(LedgerKind::intent, model.records[number.value()].state)) {
            first = first ? first : number;
            last = number;
        } else if (first) {
            break;
        }
    }
    ASSERT_EQ(state.next_printable(wanted), first ? RecordRange::closed(*first, *last) : RecordRange{}) << wanted;
}

TEST(LedgerStateModel, shouldAgreeWithAStateForEachRecord) {
    std::mt19937_64 random{20240607};
    constexpr LedgerKind kinds[] = {LedgerKind::intent,   LedgerKind::printed,    LedgerKind::unused,
                                    LedgerKind::in_doubt, LedgerKind::skipped,    LedgerKind::released,
                                    LedgerKind::reprint,  LedgerKind::run_started};
    int applied = 0;
    for (int round = 0; round < 300; ++round) {
        LedgerState state;
        Model model;
        for (int step = 0; step < 150; ++step) {
            const auto first = static_cast<std::uint32_t>(random() % record_count);
            const auto last = std::min(record_count - 1, first + static_cast<std::uint32_t>(random() % 6));
            // run_started changes nothing, so the model must not take it into account either.
            const LedgerKind kind = kinds[random() % std::size(kinds)];
            const LedgerEntry entry{kind, RunId{static_cast<std::int64_t>(1 + random() % 3)}, range(first, last), {}};
            const bool allowed = kind == LedgerKind::run_started || model.apply(entry);
            ASSERT_EQ(state.apply(entry), allowed) << to_string(kind) << ' ' << entry.range;
            ASSERT_NO_FATAL_FAILURE(expect_same(state, model));
            ASSERT_NO_FATAL_FAILURE(expect_same_offer(state, model, range(first, last)));
            ASSERT_NO_FATAL_FAILURE(expect_same_offer(state, model, range(0, record_count - 1)));
            applied += allowed ? 1 : 0;
        }
    }
    EXPECT_GT(applied, 5000); // otherwise the rows were mostly refused and little was tried
}

} // namespace
} // namespace linefeed::spool
