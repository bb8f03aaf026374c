// What the store does for a run, without its thread: requests in, rows and pages through the spool, replies out. The
// same code runs on the store thread in the service and under virtual time in the simulation.
#pragma once

#include "base/record_page.hpp"
#include "feeder/actions.hpp"
#include "session/session.hpp"
#include "spool/spool.hpp"
#include "store/ledger_keeper.hpp"
#include "store/supply.hpp"

#include <deque>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace linefeed::store {

/// Feed thread → store: the feeder's ledger actions, pages that are not needed any more, and the job that may follow
/// without a stop.
struct PageReturned {
    const RecordPage* page = nullptr;
};
struct OfferFollower {
    spool::JobId job{};
    RecordRange records; ///< all of the job
};
using StoreRequest = std::variant<std::monostate, feeder::Settle, feeder::BeginRun, feeder::AdoptRun, feeder::AskIntent,
                                  feeder::ConfirmPrinted, feeder::End, PageReturned, OfferFollower>;

/// Store → feed thread.
struct Granted {
    RecordRange range;
    RecordNumber durable_through;
};
struct Refused {
    feeder::OutcomeCode why = feeder::OutcomeCode::nothing_to_print;
};
struct Durable {
    RecordNumber through;
};
/// No record follows `last`.
struct EndKnown {
    RecordNumber last;
};
/// No record follows those that are there, although the source has not come to its end.
struct SupplyFailed {};
struct Settled {};
struct PageReady {
    const RecordPage* page = nullptr;
};
struct StorageFailed {};
/// See session::Session::on_follower_known(), on_follower_begun().
struct FollowerKnown {
    RecordCount count;
};
struct FollowerBegun {
    RecordRange places;
    RecordNumber number;
};
using StoreReply = std::variant<std::monostate, Granted, Refused, Durable, EndKnown, SupplyFailed, Settled, PageReady,
                                StorageFailed, FollowerKnown, FollowerBegun>;

/// Hands a reply to the session.
void deliver(const StoreReply& reply, session::Session& session, Instant now, session::Effects& effects);

/// The feeder's places become the numbers of the job that lies there, and back.
/// Flow: take() each request in order; commit() when wants_commit(), at once if intent_waits(), within 50 ms otherwise;
/// read_ahead() when nothing else is to do, then supply_step(); take_replies() after each. The End request is the last.
class StoreWork {
public:
    /// `supply` = the import of the job, if it is still running, with records that are durable; it must outlive this,
    /// and no job can follow then.
    StoreWork(spool::Spool& spool, LedgerKeeper keeper, Supply* supply = nullptr);

    void take(const StoreRequest& request);
    /// Rows wait to be written.
    [[nodiscard]] bool wants_commit() const;
    /// The feeder may be waiting for one of them.
    [[nodiscard]] bool intent_waits() const;
    /// Writes them in one transaction.
    void commit();
    /// The same in two steps, for a transaction with other runs: these rows are to be written, and then rows_written().
    [[nodiscard]] std::vector<spool::JobRows> pending_rows() const;
    void rows_written();
    [[nodiscard]] bool wants_read_ahead() const;
    /// Reads one page.
    void read_ahead();
    /// The import has something to write.
    [[nodiscard]] bool wants_supply_step() const;
    void supply_step();
    /// Copies the write-ahead log into the database.
    void checkpoint();

    [[nodiscard]] std::vector<StoreReply> take_replies();
    /// std::bad_alloc came out of one of the above. False if the storage had failed before; otherwise the caller has to
    /// deliver StorageFailed himself, since there is no memory for a reply.
    [[nodiscard]] bool fail_out_of_memory() noexcept;
    [[nodiscard]] Supply* supply() const { return supply_; }
    [[nodiscard]] bool ended() const { return ended_; }
    /// What went wrong with the storage; empty = nothing. Nothing is written after that.
    [[nodiscard]] const std::string& failure() const { return failure_; }

private:
    /// A job of this run.
    struct Part {
        LedgerKeeper keeper;
        JobPlaces places{};
        bool follows = false;  ///< its first record goes out with number 0
        RecordRange to_read{}; ///< records whose pages have not been read yet
    };

    void take_page_back(const RecordPage* page);
    void settle(const feeder::Settle& settle);
    void settle_parts(const feeder::Settle& settle);
    void grant(const feeder::BeginRun& begin);
    void adopt(const feeder::AdoptRun& adopted);
    void go_on(const LedgerKeeper::Grant& grant, RecordNumber read_behind);
    void end(const feeder::End& end);
    [[nodiscard]] RecordNumber intent_through() const;
    void report_durable();
    void fail(Failure failure);
    void take_supply();
    [[nodiscard]] RecordRange readable(const Part& part) const;

    // store_work_chain.cpp: two jobs
    void offer(const OfferFollower& follower);
    [[nodiscard]] bool may_be_followed(const Part& part, RecordRange records) const;
    void begin_follower(const feeder::BeginRun& begin);
    void extend_intents();
    void confirm(RecordNumber through, const protocol::MailStatus& evidence);
    void leave_printed_job();

    spool::Spool& spool_;
    std::deque<Part> parts_; ///< one, or the one that is printed and its follower
    feeder::Numbering numbering_;
    RecordNumber intent_wanted_;            ///< place
    std::optional<OfferFollower> follower_; ///< waits
    Supply* supply_;
    bool supply_over_ = false;                     ///< its end or failure has been told
    std::deque<std::unique_ptr<RecordPage>> lent_; ///< at most session::max_pages
    RecordNumber durable_reported_;
    std::vector<StoreReply> replies_;
    bool ended_ = false;
    std::string failure_;
};

} // namespace linefeed::store
