// One run of one job on one printer: its link and session on the feed thread, its way to the store thread, and what
// people may see of it.
#pragma once

#include "daemon/feed_thread.hpp"
#include "daemon/frame_history.hpp"
#include "daemon/run_measure.hpp"
#include "feeder/outcome.hpp"
#include "link/handler_memory.hpp"
#include "link/printer_address.hpp"
#include "link/printer_link.hpp"
#include "session/session.hpp"
#include "spool/spool.hpp"
#include "store/store_thread.hpp"

#include <boost/asio/posix/stream_descriptor.hpp>

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace linefeed::daemon {

struct JobRunSettings {
    link::PrinterAddress printer;
    link::Endpoints endpoints; ///< of the printer, resolved
    session::SessionSettings session;
    Duration connect_timeout = std::chrono::seconds{3};
    // Of the printer, if anybody wants them; both live longer than the run.
    LineMeters* meters = nullptr;
    FrameHistory* frames = nullptr; ///< keep() is called when the run has ended otherwise than wanted
};

/// A glance at the run, from any thread.
struct RunProgress {
    bool printing = false;
    spool::JobId job{}; ///< at work: the run's, or the last that has followed without a stop
    // By the numbers of that job
    RecordRange range; ///< of this run; empty until granted
    RecordNumber printed_through;
    RecordNumber sent_through;
    RecordCount records_in_printer; ///< at most, of any job
    double rate_per_s = 0;
    std::uint32_t fifo_depth = 0;                   ///< entries, as the printer reports it
    std::uint32_t fifo_entries = 0;                 ///< last reported
    std::optional<protocol::MachineStatus> machine; ///< as last reported in this run
    std::optional<Instant> heard_at;                ///< of the last frame; monotonic time of this machine

    /// Records that may still be sent, if they are at hand.
    [[nodiscard]] RecordCount credit() const;
    /// Until the FIFO is empty if nothing follows, at the measured rate; absent while the line stands.
    [[nodiscard]] std::optional<double> time_to_empty_s() const;
};

/// What all runs of a process share.
struct RunThreads {
    FeedThread& feed;
    store::StoreThread& store;
};

/// `supply` = the import of the job, if it is still running. Flow: construct, start(), poll progress() and
/// take_notices(), request_stop() if wanted, until finished(); then join() and outcome(). The spool and the supply
/// belong to the store thread from start() to join().
class JobRun final : private link::EffectHandler, private FeedThread::Guest {
public:
    JobRun(RunThreads threads, spool::Spool& spool, const spool::Job& job, RecordRange wanted,
           const std::optional<store::OpenIssue>& open, const JobRunSettings& settings,
           store::Supply* supply = nullptr);
    ~JobRun() override;
    JobRun(const JobRun&) = delete;
    JobRun& operator=(const JobRun&) = delete;

    void start();
    /// `job`, none of which is issued, may follow without a stop; any thread. It is on offer until the notice
    /// follower_printing comes, which tells that it has, and that another may be offered; or until the run ends.
    void offer_follower(const spool::Job& job);
    /// Stops the line and finds the truth; any thread.
    void request_stop();
    [[nodiscard]] bool finished() const { return finished_.load(std::memory_order_acquire); }
    /// Waits until something happens or the time has passed.
    void wait(int timeout_ms) { news_.wait(timeout_ms); }
    [[nodiscard]] RunProgress progress() const;
    [[nodiscard]] std::vector<feeder::Notice> take_notices();
    void join();

    // After join()
    /// Of the job at work.
    [[nodiscard]] const feeder::Outcome& outcome() const { return outcome_; }
    /// Why there was no connection, or what is wrong with the storage; empty = nothing to add.
    [[nodiscard]] const std::string& detail() const { return detail_; }
    [[nodiscard]] const session::SessionStatistics& statistics() const { return session_.statistics(); }

private:
    void on_feed_thread() override;
    void on_effect(const session::Effect& effect) override;
    void on_unreachable(const std::string& reason) override;
    void on_progress(Instant at) override;
    void publish_printer(Instant at);
    void wait_for_replies();
    void take_stop_request();
    void take_offer();
    void publish_places();
    void read_places(RunProgress& progress) const;
    void take_replies();
    void push(const store::StoreRequest& request);
    void push_cumulative();
    void end(const feeder::End& end);
    void leave();

    /// Lives and dies on the feed thread.
    struct Edge {
        explicit Edge(JobRun& run);
        link::PrinterLink link;
        std::shared_ptr<link::HandlerMemory> memory = std::make_shared<link::HandlerMemory>();
        boost::asio::posix::stream_descriptor replies;
    };

    RunThreads threads_;
    JobRunSettings settings_;
    store::Store store_;
    session::Session session_;
    std::optional<RunMeasure> measure_;
    std::optional<Edge> edge_;
    std::atomic<bool> fed_{false}; ///< from start() until nothing of it is left on the feed thread

    std::optional<feeder::ConfirmPrinted> confirm_; ///< latest not yet handed to the store
    std::optional<feeder::AskIntent> intent_;
    std::optional<store::OfferFollower> follower_; ///< on offer
    spool::JobId at_work_;
    std::uint64_t frames_published_ = 0; ///< the last that the figures below include

    boost::lockfree::spsc_queue<feeder::Notice, boost::lockfree::capacity<64>> notices_;
    store::EventSignal news_;
    std::atomic<bool> stop_requested_{false}; ///< set by any thread, with the store's replies_signal()
    boost::lockfree::spsc_queue<store::OfferFollower, boost::lockfree::capacity<2>> offers_; ///< with the same signal
    std::atomic<bool> printing_{false};
    std::atomic<std::uint32_t> places_version_{0}; ///< of what read_places() reads; odd while that is written
    std::atomic<spool::JobId> job_;                ///< at work
    std::atomic<std::uint64_t> range_{0};          ///< first << 32 | last; 0 = none
    std::atomic<std::uint32_t> printed_through_{0};
    std::atomic<std::uint32_t> sent_through_{0};
    std::atomic<std::uint64_t> records_in_printer_{0};
    std::atomic<double> rate_per_s_{0};
    std::atomic<std::uint64_t> fifo_{0};       ///< depth << 32 | entries
    std::atomic<std::uint64_t> machine_{0};    ///< packed; 0 = not known
    std::atomic<std::int64_t> heard_at_ns_{0}; ///< 0 = never
    std::atomic<bool> finished_{false};
    feeder::Outcome outcome_;
    std::string detail_;
};

} // namespace linefeed::daemon
