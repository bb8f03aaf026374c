#include "spool/ledger.hpp"
#include "spool/ledger_codec.hpp"
#include "spool/ledger_history.hpp"
#include "spool_fixture.hpp"

#include <set>

namespace linefeed::spool {
namespace {

constexpr LedgerKind all_kinds[] = {LedgerKind::run_started, LedgerKind::intent,   LedgerKind::printed,
                                    LedgerKind::unused,      LedgerKind::in_doubt, LedgerKind::skipped,
                                    LedgerKind::released,    LedgerKind::reprint,  LedgerKind::run_ended};

TEST(LedgerNames, shouldReadBackEveryKind) {
    std::set<std::string_view> names;
    for (const LedgerKind kind : all_kinds) {
        EXPECT_EQ(ledger_kind_from_name(to_string(kind)), kind);
        names.insert(to_string(kind));
    }
    EXPECT_EQ(names.size(), std::size(all_kinds));
    EXPECT_EQ(ledger_kind_from_name("Intent"), std::nullopt);
    EXPECT_EQ(ledger_kind_from_name(""), std::nullopt);
}

TEST(LedgerNames, shouldReadBackEveryState) {
    for (const RecordState state : {RecordState::fresh, RecordState::open, RecordState::printed, RecordState::unused,
                                    RecordState::in_doubt, RecordState::skipped, RecordState::released}) {
        EXPECT_EQ(record_state_from_name(to_string(state)), state);
    }
    EXPECT_EQ(record_state_from_name("intent"), std::nullopt);
}

TEST(LedgerHash, shouldBeTheSha256OfOneFieldALine) {
    // printf '<64 zeros>\n1\n2\nintent\n3\n4\n5\n6\n2\n{}' | sha256sum
    const LedgerEntry entry{LedgerKind::intent, RunId{3}, range(4, 8), "{}"};
    EXPECT_EQ(ledger_hash(first_previous_hash, 1, JobId{2}, entry, 6),
              "35108ed0b33c8f1e0145b2a5cdc6c71e2a7efa7d1ef64b382abfa47e6607a796");
}

TEST(LedgerHash, shouldChangeWithEveryField) {
    const LedgerEntry entry{LedgerKind::intent, RunId{3}, range(4, 8), "{}"};
    std::set<std::string> hashes;
    const auto add = [&](std::string_view previous, std::int64_t sequence, JobId job, const LedgerEntry& changed,
                         std::int64_t time_ns) {
        EXPECT_TRUE(hashes.insert(ledger_hash(previous, sequence, job, changed, time_ns)).second);
    };
    add(first_previous_hash, 1, JobId{2}, entry, 6);
    add(std::string(64, '1'), 1, JobId{2}, entry, 6);
    add(first_previous_hash, 2, JobId{2}, entry, 6);
    add(first_previous_hash, 1, JobId{3}, entry, 6);
    add(first_previous_hash, 1, JobId{2}, entry, 7);
    add(first_previous_hash, 1, JobId{2}, {LedgerKind::printed, RunId{3}, range(4, 8), "{}"}, 6);
    add(first_previous_hash, 1, JobId{2}, {LedgerKind::intent, RunId{4}, range(4, 8), "{}"}, 6);
    add(first_previous_hash, 1, JobId{2}, {LedgerKind::intent, RunId{3}, range(5, 8), "{}"}, 6);
    add(first_previous_hash, 1, JobId{2}, {LedgerKind::intent, RunId{3}, range(4, 9), "{}"}, 6);
    add(first_previous_hash, 1, JobId{2}, {LedgerKind::intent, RunId{3}, range(4, 8), "{ }"}, 6);
    add(first_previous_hash, 1, JobId{2}, {LedgerKind::intent, RunId{3}, range(4, 8), ""}, 6);
}

TEST(LedgerEntry, shouldDifferByEveryField) {
    const LedgerEntry entry{LedgerKind::intent, RunId{3}, range(4, 8), "{}"};
    EXPECT_EQ(entry, (LedgerEntry{LedgerKind::intent, RunId{3}, range(4, 8), "{}"}));
    EXPECT_NE(entry, (LedgerEntry{LedgerKind::printed, RunId{3}, range(4, 8), "{}"}));
    EXPECT_NE(entry, (LedgerEntry{LedgerKind::intent, RunId{4}, range(4, 8), "{}"}));
    EXPECT_NE(entry, (LedgerEntry{LedgerKind::intent, RunId{3}, range(4, 9), "{}"}));
    EXPECT_NE(entry, (LedgerEntry{LedgerKind::intent, RunId{3}, range(4, 8), ""}));
}

TEST(LedgerSegment, shouldDifferByEveryField) {
    const LedgerSegment segment{range(1, 2), RecordState::open, RunId{3}};
    EXPECT_EQ(segment, (LedgerSegment{range(1, 2), RecordState::open, RunId{3}}));
    EXPECT_NE(segment, (LedgerSegment{range(1, 3), RecordState::open, RunId{3}}));
    EXPECT_NE(segment, (LedgerSegment{range(1, 2), RecordState::unused, RunId{3}}));
    EXPECT_NE(segment, (LedgerSegment{range(1, 2), RecordState::open, RunId{4}}));
}

TEST(HistoryStretch, shouldDifferByEveryField) {
    const HistoryStretch stretch{range(1, 2), RecordState::open, RunId{3}, 4, 5, "{}"};
    EXPECT_EQ(stretch, (HistoryStretch{range(1, 2), RecordState::open, RunId{3}, 4, 5, "{}"}));
    EXPECT_NE(stretch, (HistoryStretch{range(1, 3), RecordState::open, RunId{3}, 4, 5, "{}"}));
    EXPECT_NE(stretch, (HistoryStretch{range(1, 2), RecordState::unused, RunId{3}, 4, 5, "{}"}));
    EXPECT_NE(stretch, (HistoryStretch{range(1, 2), RecordState::open, RunId{9}, 4, 5, "{}"}));
    EXPECT_NE(stretch, (HistoryStretch{range(1, 2), RecordState::open, RunId{3}, 9, 5, "{}"}));
    EXPECT_NE(stretch, (HistoryStretch{range(1, 2), RecordState::open, RunId{3}, 4, 9, "{}"}));
    EXPECT_NE(stretch, (HistoryStretch{range(1, 2), RecordState::open, RunId{3}, 4, 5, ""}));
}

} // namespace
} // namespace linefeed::spool
