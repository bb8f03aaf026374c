#include "spool_fixture.hpp"

#include <gmock/gmock.h>

namespace linefeed::spool {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

using SpoolJournalTest = SpoolTest;

TEST_F(SpoolJournalTest, shouldNumberEventsOverRestarts) {
    Event first{.time_ns = 5, .kind = "job.queued", .printer = "line1", .job = JobId{3}, .message = "waits"};
    Event second{.time_ns = 6,
                 .kind = "printer.warning",
                 .printer = "",
                 .record = RecordNumber{4294967295},
                 .message = "\x01\xFF"};
    {
        Spool spool = open();
        ASSERT_TRUE(spool.add_events({&first, 1}));
    }
    Spool spool = open();
    ASSERT_TRUE(spool.add_events({&second, 1}));
    const auto events = spool.events(0, 10).value();
    ASSERT_THAT(events, SizeIs(2));
    first.id = 1;
    second.id = 2;
    EXPECT_EQ(events[0], first);
    EXPECT_EQ(events[1], second);
    EXPECT_EQ(spool.last_event().value(), 2U);
    EXPECT_EQ(spool.last_audit().value(), 0U);
    EXPECT_THAT(spool.events(1, 10).value(), SizeIs(1));
    EXPECT_THAT(spool.events(0, 1).value(), SizeIs(1));
    EXPECT_THAT(spool.events(2, 10).value(), IsEmpty());
}

TEST_F(SpoolJournalTest, shouldKeepTheNewestEvents) {
    Spool spool = open();
    const std::vector<Event> many(1000, Event{.kind = "x", .message = "y"});
    for (std::size_t i = 0; i < Spool::max_events / many.size() + 3; ++i) {
        ASSERT_TRUE(spool.add_events(many));
    }
    const auto oldest = spool.events(0, 1).value();
    ASSERT_THAT(oldest, SizeIs(1));
    const std::uint64_t newest = Spool::max_events + 3 * many.size();
    EXPECT_GE(newest - oldest.front().id + 1, Spool::max_events);
    EXPECT_LE(newest - oldest.front().id + 1, Spool::max_events + 2 * many.size());
    EXPECT_THAT(spool.events(newest - 1, 10).value(), SizeIs(1));
}

TEST_F(SpoolJournalTest, shouldOnlyAppendToTheAuditLog) {
    Spool spool = open();
    AuditEntry entry{.time_ns = 7,
                     .who = "anna (uid 1000)",
                     .what = "stop",
                     .object = "printer line1",
                     .detail = R"({"a":1})",
                     .done = false};
    ASSERT_TRUE(spool.add_audit(entry));
    const auto entries = spool.audit(0, 10).value();
    ASSERT_THAT(entries, SizeIs(1));
    entry.id = 1;
    EXPECT_EQ(entries.front(), entry);
    EXPECT_THAT(sql("UPDATE audit SET who = 'nobody'"), HasSubstr("append-only"));
    EXPECT_THAT(sql("DELETE FROM audit"), HasSubstr("append-only"));
    EXPECT_THAT(sql("PRAGMA recursive_triggers = ON; INSERT OR REPLACE INTO audit VALUES (1, 0, '', '', '', '', 1)"),
                HasSubstr("append-only"));
    EXPECT_THAT(spool.audit(1, 10).value(), IsEmpty());
}

TEST_F(SpoolJournalTest, shouldRememberAnAnswerForItsTime) {
    Spool spool = open();
    const Answer answer{"hash", 201, R"({"job":1})"};
    ASSERT_TRUE(spool.keep_answer("anna", "key", answer, 1000, 0));
    EXPECT_EQ(spool.answer("anna", "key", 1000).value(), answer);
    EXPECT_EQ(spool.answer("anna", "key", 1001).value(), std::nullopt);
    EXPECT_EQ(spool.answer("otto", "key", 0).value(), std::nullopt) << "keys are each caller's own";
    ASSERT_TRUE(spool.keep_answer("anna", "other", answer, 2000, 1500));
    EXPECT_EQ(spool.answer("anna", "key", 0).value(), std::nullopt) << "forgotten";
}

} // namespace
} // namespace linefeed::spool
