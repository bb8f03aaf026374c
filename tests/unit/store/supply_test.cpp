// The store of a run whose job is still being imported: what may be granted, lent and intended when, and what is told
// of the end.
#include "store/store.hpp"
#include "support/spool_job.hpp"

#include <gmock/gmock.h>
#include <sqlite3.h>

#include <functional>
#include <string>
#include <utility>

namespace linefeed::store {
namespace {

using test::closed;
using test::SpoolJobTest;
using testing::HasSubstr;
using testing::IsEmpty;

/// An import whose records the test writes itself.
class SupplyDouble final : public Supply {
public:
    explicit SupplyDouble(spool::JobImport import)
        : import_(std::move(import)) {}

    void add(std::uint32_t count, std::size_t text_bytes = 1) {
        RecordPage page{import_.durable().first() + import_.added(), {}, {}};
        for (std::uint32_t k = 0; k < count; ++k) {
            page.frames += "^0=MR" + std::to_string((page.first + RecordCount{k}).value()) + '\t' +
                           std::string(text_bytes, 'x') + '\r';
            page.ends.push_back(static_cast<std::uint32_t>(page.frames.size()));
        }
        import_.add(page).value();
        import_.flush().value();
    }
    void end() { ended_ = import_.commit({}).has_value(); }
    void fail(FailureKind kind) { failure_ = Failure{kind, "it is broken"}; }

    [[nodiscard]] spool::JobId job() const { return import_.id(); }
    [[nodiscard]] bool wants_step() override { return next_.operator bool(); }
    void step() override { std::exchange(next_, {})(); }
    [[nodiscard]] RecordRange durable() const override { return import_.durable(); }
    [[nodiscard]] bool end_known() const override { return ended_; }
    [[nodiscard]] const std::optional<Failure>& failure() const override { return failure_; }
    void wake(EventSignal* waiting) override { waiting_ = waiting; }
    [[nodiscard]] const EventSignal* waiting() const { return waiting_; }

    std::function<void()> next_; ///< the next step

private:
    spool::JobImport import_;
    bool ended_ = false;
    std::optional<Failure> failure_;
    EventSignal* waiting_ = nullptr;
};

class SupplyTest : public SpoolJobTest {
protected:
    void SetUp() override {
        SpoolJobTest::SetUp();
        supply_.emplace(spool_->begin_import({}).value());
        job_ = supply_->job();
    }
    void TearDown() override {
        supply_.reset();
        SpoolJobTest::TearDown();
    }
    StoreWork work() {
        return StoreWork{*spool_,
                         LedgerKeeper{*spool_, job_, closed(1, 10'000), "tcp://10.0.0.5:3000",
                                      find_open_issue(*spool_, job_).value()},
                         &*supply_};
    }
    void step(StoreWork& store, std::function<void()> what) {
        supply_->next_ = std::move(what);
        EXPECT_TRUE(store.wants_supply_step());
        store.supply_step();
    }
    template <typename Reply>
    static Reply only(const std::vector<StoreReply>& replies) {
        EXPECT_EQ(replies.size(), 1U);
        return std::get<Reply>(replies.at(0));
    }
    static std::vector<RecordRange> read_all(StoreWork& store) {
        std::vector<RecordRange> pages;
        while (store.wants_read_ahead()) {
            store.read_ahead();
            pages.push_back(only<PageReady>(store.take_replies()).page->range());
        }
        return pages;
    }

    std::optional<SupplyDouble> supply_;
};

TEST_F(SupplyTest, shouldGrantTheWholeRunAndIntendOnlyWhatIsThere) {
    supply_->add(300);
    StoreWork store = work();
    EXPECT_THAT(store.take_replies(), IsEmpty());
    store.take(feeder::BeginRun{});
    const auto granted = only<Granted>(store.take_replies());
    EXPECT_EQ(granted.range, closed(1, 10'000));
    EXPECT_EQ(granted.durable_through, RecordNumber{300});
    EXPECT_EQ(read_all(store), Ranges{closed(1, 300)});

    store.take(feeder::AskIntent{RecordNumber{800}});
    EXPECT_FALSE(store.wants_commit()) << "it waits for the records";
    step(store, [this] { supply_->add(400); });
    EXPECT_TRUE(store.intent_waits());
    store.commit();
    EXPECT_EQ(only<Durable>(store.take_replies()).through, RecordNumber{700});
    step(store, [this] { supply_->add(400); });
    store.commit();
    EXPECT_EQ(only<Durable>(store.take_replies()).through, RecordNumber{800}) << "as far as was asked";
    EXPECT_EQ(read_all(store), (Ranges{closed(301, 700), closed(701, 1100)}));
    EXPECT_FALSE(store.wants_supply_step());
}

TEST_F(SupplyTest, shouldGrantNothingThatIsNotThere) {
    supply_->add(10);
    {
        StoreWork store = work();
        store.take(feeder::BeginRun{});
        static_cast<void>(store.take_replies());
        feeder::Settle settle;
        settle.verdict.printed = closed(1, 10);
        store.take(settle);
        store.take(feeder::End{});
    }
    StoreWork store = work();
    store.take(feeder::BeginRun{});
    EXPECT_EQ(only<Refused>(store.take_replies()).why, feeder::OutcomeCode::nothing_to_print);
}

TEST_F(SupplyTest, shouldLendTheSmallPagesOfASlowSourceTogether) {
    supply_->add(10);
    StoreWork store = work();
    store.take(feeder::BeginRun{});
    static_cast<void>(store.take_replies());
    Ranges pages = read_all(store);
    std::uint32_t there = 10;
    while (pages.size() < session::max_pages / 2) { // one by one, as long as there is plenty of room
        step(store, [this] { supply_->add(10); });
        there += 10;
        for (const RecordRange& page : read_all(store)) {
            pages.push_back(page);
        }
    }
    EXPECT_EQ(pages.back(), closed(there - 9, there));
    for (int k = 0; k < 25; ++k) {
        step(store, [this] { supply_->add(10); });
        EXPECT_THAT(read_all(store), IsEmpty()) << k << ": too few to be worth a page";
    }
    step(store, [this] { supply_->add(10); });
    EXPECT_EQ(read_all(store), Ranges{closed(there + 1, there + 260)});
}

TEST_F(SupplyTest, shouldNotLendMoreBytesTogetherThanAPageHolds) {
    for (int k = 0; k < 3; ++k) {
        supply_->add(40, 2000); // more than 64 KiB
    }
    StoreWork store = work();
    store.take(feeder::BeginRun{});
    static_cast<void>(store.take_replies());
    EXPECT_EQ(read_all(store), (Ranges{closed(1, 40), closed(41, 80), closed(81, 120)}));
}

TEST_F(SupplyTest, shouldFailWhenASmallPageCannotBeRead) {
    supply_->add(10);
    supply_->add(10);
    StoreWork store = work();
    store.take(feeder::BeginRun{});
    static_cast<void>(store.take_replies());
    sqlite3* other = nullptr;
    ASSERT_EQ(sqlite3_open((directory_ / "spool.db").c_str(), &other), SQLITE_OK);
    ASSERT_EQ(sqlite3_exec(other, "DELETE FROM pages WHERE first = 11", nullptr, nullptr, nullptr), SQLITE_OK);
    sqlite3_close(other);
    store.read_ahead();
    only<StorageFailed>(store.take_replies());
    EXPECT_THAT(store.failure(), HasSubstr("no record 11"));
}

TEST_F(SupplyTest, shouldLetNoJobFollowOneThatIsStillImported) {
    supply_->add(300);
    StoreWork store = work();
    store.take(OfferFollower{spool::JobId{77}, closed(1, 10)});
    EXPECT_TRUE(store.take_replies().empty());
}

TEST_F(SupplyTest, shouldTellTheEndWhenItIsKnown) {
    supply_->add(300);
    StoreWork store = work();
    store.take(feeder::BeginRun{});
    static_cast<void>(store.take_replies());
    step(store, [this] {
        supply_->add(5);
        supply_->end();
    });
    EXPECT_EQ(only<EndKnown>(store.take_replies()).last, RecordNumber{305});
    EXPECT_EQ(read_all(store), (Ranges{closed(1, 300), closed(301, 305)}));
    EXPECT_FALSE(store.wants_supply_step());
    store.take(feeder::AskIntent{RecordNumber{305}});
    store.commit();
    EXPECT_EQ(only<Durable>(store.take_replies()).through, RecordNumber{305});
}

TEST_F(SupplyTest, shouldSayNothingOfAnEndThatWasKnownBeforeTheRun) {
    supply_->add(300);
    supply_->end();
    StoreWork store = work();
    EXPECT_THAT(store.take_replies(), IsEmpty());
    store.take(feeder::BeginRun{});
    EXPECT_EQ(only<Granted>(store.take_replies()).range, closed(1, 300));
}

TEST_F(SupplyTest, shouldStopTheRunWhenTheSourceFails) {
    supply_->add(300);
    StoreWork store = work();
    store.take(feeder::BeginRun{});
    static_cast<void>(store.take_replies());
    step(store, [this] { supply_->fail(FailureKind::input); });
    only<SupplyFailed>(store.take_replies());
    EXPECT_EQ(store.failure(), "") << "the ledger is still written";
    EXPECT_FALSE(store.wants_supply_step());
    store.take(feeder::ConfirmPrinted{RecordNumber{20}, {}});
    store.commit();
    EXPECT_EQ(in_state(spool::RecordState::printed), Ranges{closed(1, 20)});
}

TEST_F(SupplyTest, shouldFailWhenTheImportCannotBeWritten) {
    supply_->add(300);
    StoreWork store = work();
    store.take(feeder::BeginRun{});
    static_cast<void>(store.take_replies());
    step(store, [this] { supply_->fail(FailureKind::storage); });
    only<StorageFailed>(store.take_replies());
    EXPECT_THAT(store.failure(), HasSubstr("it is broken"));
    EXPECT_FALSE(store.wants_supply_step());
}

TEST_F(SupplyTest, shouldWakeWhoeverServesTheRunUntilItEnds) {
    supply_->add(300);
    EventSignal requests;
    Store store{work()};
    store.begin(requests);
    EXPECT_EQ(supply_->waiting(), &requests);
    store.end();
    EXPECT_EQ(supply_->waiting(), nullptr);
}

} // namespace
} // namespace linefeed::store
