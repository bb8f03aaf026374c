#include "daemon/job_run.hpp"

#include <boost/asio/bind_allocator.hpp>
#include <boost/asio/post.hpp>

#include <algorithm>
#include <chrono>
#include <unistd.h>
#include <utility>

namespace linefeed::daemon {

namespace asio = boost::asio;
using session::Effects;
using session::Session;

JobRun::JobRun(RunThreads threads, spool::Spool& spool, const spool::Job& job, RecordRange wanted,
               const std::optional<store::OpenIssue>& open, const JobRunSettings& settings, store::Supply* supply)
    : threads_(threads)
    , settings_(settings)
    , store_(store::StoreWork{
          spool, store::LedgerKeeper{spool, job.id, wanted, link::to_string(settings.printer), open}, supply})
    , session_(settings.session, store::make_plan(open, job.id, wanted), settings.frames)
    , at_work_(job.id)
    , job_(job.id) {
    if (settings.meters != nullptr) {
        measure_.emplace(*settings.meters, open ? open->facts.printed_through : RecordNumber{});
    }
}

JobRun::~JobRun() {
    if (fed_) {
        request_stop();
    }
    join();
}

void JobRun::start() {
    threads_.store.add(store_);
    fed_ = true;
    threads_.feed.let_in(*this);
}

JobRun::Edge::Edge(JobRun& run)
    : link(run.threads_.feed.context(), run.session_, run)
    , replies(run.threads_.feed.context(), ::dup(run.store_.replies_signal().descriptor())) {}

void JobRun::on_feed_thread() {
    edge_.emplace(*this);
    wait_for_replies();
    edge_->link.connect(settings_.endpoints, settings_.connect_timeout);
}

void JobRun::request_stop() {
    stop_requested_.store(true, std::memory_order_release);
    store_.replies_signal().notify();
}

void JobRun::offer_follower(const spool::Job& job) {
    LINEFEED_ASSERT(offers_.push({job.id, job.records}));
    store_.replies_signal().notify();
}

namespace {

bool went_wrong(feeder::OutcomeCode code) {
    using feeder::OutcomeCode;
    return code != OutcomeCode::finished && code != OutcomeCode::nothing_to_print &&
           code != OutcomeCode::stop_requested;
}

} // namespace

void JobRun::join() {
    fed_.wait(true);
    store_.join();
    if (finished() && settings_.frames != nullptr) {
        if (went_wrong(outcome_.code)) {
            settings_.frames->keep();
        }
        settings_.frames = nullptr; // the next run writes there now
    }
    if (!store_.failure().empty()) {
        detail_ = store_.failure();
    }
}

void JobRun::on_effect(const session::Effect& effect) {
    if (measure_) {
        measure_->on_effect(effect, session_.feeder());
    }
    if (const auto* confirm = std::get_if<feeder::ConfirmPrinted>(&effect)) {
        confirm_ = *confirm;
        push_cumulative();
    } else if (const auto* intent = std::get_if<feeder::AskIntent>(&effect)) {
        intent_ = *intent;
        push_cumulative();
    } else if (const auto* settle = std::get_if<feeder::Settle>(&effect)) {
        push_cumulative();
        push(*settle);
    } else if (const auto* begin = std::get_if<feeder::BeginRun>(&effect)) {
        push_cumulative(); // a follower may begin when the ledger knows what is printed
        push(*begin);
    } else if (const auto* adopt = std::get_if<feeder::AdoptRun>(&effect)) {
        push(*adopt);
    } else if (const auto* release = std::get_if<session::ReleasePage>(&effect)) {
        push(store::PageReturned{release->page});
    } else if (const auto* notice = std::get_if<feeder::Notice>(&effect)) {
        printing_ = printing_ || notice->code == feeder::NoticeCode::printing_started;
        if (notice->code == feeder::NoticeCode::follower_printing) {
            at_work_ = std::exchange(follower_, std::nullopt)->job;
        }
        notices_.push(*notice); // if nobody reads them, later ones are lost, and nothing else
        news_.notify();
    } else if (const auto* last = std::get_if<feeder::End>(&effect)) {
        end(*last);
    }
}

void JobRun::push(const store::StoreRequest& request) {
    // push_cumulative() leaves half of the ring to requests that must not wait; there are fewer of those.
    LINEFEED_ASSERT(store_.push(request));
}

/// Intents and confirmations grow: when the store is behind, only the latest matters.
void JobRun::push_cumulative() {
    const bool last_chance = session_.feeder().phase() == feeder::Phase::ended;
    const std::size_t room = last_chance ? 2 : store::Store::ring_capacity / 2;
    if (intent_ && store_.room() > room && store_.push(*intent_)) {
        intent_.reset();
    }
    if (confirm_ && store_.room() > room && store_.push(*confirm_)) {
        confirm_.reset();
    }
}

void JobRun::on_unreachable(const std::string& reason) {
    detail_ = link::to_string(settings_.printer) + ": " + reason;
    end({{.code = feeder::OutcomeCode::unreachable}});
}

void JobRun::end(const feeder::End& end) {
    LINEFEED_ASSERT(!finished());
    outcome_ = end.outcome;
    push_cumulative();
    push(end);
    // Before anybody looks at a run that is over: what the printer said last, such as that an error has gone.
    publish_printer(Instant{std::chrono::steady_clock::now().time_since_epoch()});
    publish_places();
    finished_.store(true, std::memory_order_release);
    news_.notify();
    asio::post(threads_.feed.context(), [this] {
        boost::system::error_code ignored;
        edge_->replies.close(ignored);
        edge_->link.abort();
        // What was under way on them has been queued by that, each with its error: they go behind it.
        asio::post(threads_.feed.context(), [this] { leave(); });
    });
}

void JobRun::leave() {
    edge_.reset();
    fed_ = false;
    fed_.notify_all(); // by the address: the run may be gone already
}

void JobRun::on_progress(Instant at) {
    publish_printer(at);
    if (measure_) {
        measure_->on_fact(session_, at);
    }
    publish_places();
}

/// By the numbers of the job at work.
void JobRun::publish_places() {
    const feeder::Feeder& feeder = session_.feeder();
    const RecordRange places = feeder.job_places();
    if (places.empty()) {
        return;
    }
    const feeder::Numbering& numbering = feeder.numbering();
    const RecordNumber first = numbering.number_of(places.first());
    const auto through = [&](RecordNumber place) {
        const bool none = place < places.first();
        return (none ? first.previous() : numbering.number_of(std::min(place, places.last()))).value();
    };
    const feeder::Refill& refill = feeder.refill();
    const std::uint32_t version = places_version_.load(std::memory_order_relaxed);
    places_version_.store(version + 1, std::memory_order_relaxed); // odd: being written
    std::atomic_thread_fence(std::memory_order_release);
    job_.store(at_work_, std::memory_order_relaxed);
    range_.store(std::uint64_t{first.value()} << 32 | through(places.last()), std::memory_order_relaxed);
    printed_through_.store(through(refill.printed_through()), std::memory_order_relaxed);
    sent_through_.store(through(refill.sent_through()), std::memory_order_relaxed);
    records_in_printer_.store(refill.level().value(), std::memory_order_relaxed);
    places_version_.store(version + 2, std::memory_order_release);
    rate_per_s_.store(feeder.rate(), std::memory_order_relaxed);
}

namespace {

/// A MachineStatus in one word, so that a reader never sees half of it; the speed is left out.
std::uint64_t pack(const protocol::MachineStatus& status) {
    return std::uint64_t{static_cast<std::uint32_t>(status.error.raw)} << 32 |
           std::uint64_t{status.cover_open ? 1U : 0U} << 16 |
           std::uint64_t{static_cast<std::uint8_t>(status.nozzle)} << 8 | static_cast<std::uint8_t>(status.machine);
}

protocol::MachineStatus unpack(std::uint64_t packed) {
    protocol::MachineStatus status;
    status.error.raw = static_cast<std::int32_t>(packed >> 32);
    status.cover_open = (packed >> 16 & 1U) != 0;
    status.nozzle = static_cast<protocol::NozzleState>(packed >> 8 & 0xFFU);
    status.machine = static_cast<protocol::MachineState>(packed & 0xFFU); // never 0
    return status;
}

} // namespace

void JobRun::publish_printer(Instant at) {
    const std::uint64_t frames = session_.statistics().frames_received;
    if (frames == frames_published_) {
        return;
    }
    frames_published_ = frames;
    heard_at_ns_.store(at.time_since_epoch().count(), std::memory_order_relaxed);
    const feeder::Feeder& feeder = session_.feeder();
    fifo_.store(std::uint64_t{feeder.mail().depth} << 32 | feeder.mail().entries, std::memory_order_relaxed);
    if (feeder.phase() != feeder::Phase::identifying) {
        machine_.store(pack(feeder.machine()), std::memory_order_relaxed);
    }
}

RecordCount RunProgress::credit() const {
    return RecordCount{fifo_depth} - std::min(RecordCount{fifo_depth}, records_in_printer);
}

std::optional<double> RunProgress::time_to_empty_s() const {
    return rate_per_s > 0 ? std::optional{static_cast<double>(records_in_printer.value()) / rate_per_s} : std::nullopt;
}

/// All of one moment, since they are of one job: again if they are being written.
void JobRun::read_places(RunProgress& progress) const {
    while (true) {
        const std::uint32_t version = places_version_.load(std::memory_order_acquire);
        progress.job = job_.load(std::memory_order_relaxed);
        const std::uint64_t range = range_.load(std::memory_order_relaxed);
        progress.printed_through = RecordNumber{printed_through_.load(std::memory_order_relaxed)};
        progress.sent_through = RecordNumber{sent_through_.load(std::memory_order_relaxed)};
        progress.records_in_printer = RecordCount{records_in_printer_.load(std::memory_order_relaxed)};
        std::atomic_thread_fence(std::memory_order_acquire);
        if (version % 2 == 0 && places_version_.load(std::memory_order_relaxed) == version) {
            progress.range = range == 0 ? RecordRange{}
                                        : RecordRange::closed(RecordNumber{static_cast<std::uint32_t>(range >> 32)},
                                                              RecordNumber{static_cast<std::uint32_t>(range)});
            return;
        }
    }
}

RunProgress JobRun::progress() const {
    RunProgress progress;
    progress.printing = printing_;
    read_places(progress);
    const std::uint64_t fifo = fifo_.load(std::memory_order_relaxed);
    progress.fifo_depth = static_cast<std::uint32_t>(fifo >> 32);
    progress.fifo_entries = static_cast<std::uint32_t>(fifo);
    if (const std::uint64_t machine = machine_.load(std::memory_order_relaxed); machine != 0) {
        progress.machine = unpack(machine);
    }
    if (const std::int64_t heard = heard_at_ns_.load(std::memory_order_relaxed); heard != 0) {
        progress.heard_at = Instant{Duration{heard}};
    }
    progress.rate_per_s = rate_per_s_.load(std::memory_order_relaxed);
    return progress;
}

std::vector<feeder::Notice> JobRun::take_notices() {
    std::vector<feeder::Notice> notices;
    feeder::Notice notice;
    while (notices_.pop(notice)) {
        notices.push_back(notice);
    }
    return notices;
}

void JobRun::wait_for_replies() {
    auto handler = [this](const boost::system::error_code& error) {
        if (error) {
            return;
        }
        store_.replies_signal().clear();
        take_stop_request();
        take_offer();
        take_replies();
        wait_for_replies();
    };
    edge_->replies.async_wait(asio::posix::stream_descriptor::wait_read,
                              asio::bind_allocator(link::HandlerAllocator<>{edge_->memory}, handler));
}

void JobRun::take_stop_request() {
    if (stop_requested_.exchange(false, std::memory_order_acquire) && !finished()) {
        edge_->link.call([](Session& session, Instant at, Effects& effects) { session.request_stop(at, effects); });
    }
}

void JobRun::take_offer() {
    store::OfferFollower follower;
    if (!finished() && offers_.pop(follower)) {
        follower_ = follower;
        push(follower);
    }
}

void JobRun::take_replies() {
    store::StoreReply reply;
    while (!finished() && store_.pop(reply)) {
        edge_->link.call(
            [&reply](Session& session, Instant at, Effects& effects) { store::deliver(reply, session, at, effects); });
        push_cumulative();
    }
}

} // namespace linefeed::daemon
