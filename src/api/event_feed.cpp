#include "api/event_feed.hpp"

#include "api/views.hpp"

#include <boost/asio/post.hpp>

#include <exception>

namespace linefeed::api {

namespace {

constexpr std::chrono::seconds retry_interval{1};

/// What the core throws ends here: to a stream it is a store that cannot be read now.
template <typename Read>
auto guarded(Read&& read) -> decltype(read()) {
    try {
        return read();
    } catch (const std::exception& exception) {
        return Failure{FailureKind::internal, exception.what()};
    }
}

/// Events behind `after` are not kept any more; `first` is the oldest that there is. Without a number: who comes again
/// says what he has seen.
std::string to_server_sent_gap(std::uint64_t after, std::uint64_t first) {
    return "event: gap\ndata: " + dump({{"after", after}, {"first", first}}) + "\n\n";
}

} // namespace

std::string to_server_sent(const daemon::EventView& event) {
    std::string kind = visible(event.kind);
    for (char& c : kind) {
        c = c == '\n' || c == '\r' ? ' ' : c;
    }
    return "id: " + std::to_string(event.id) + "\nevent: " + kind + "\ndata: " + dump(to_json(event)) + "\n\n";
}

EventFeed::EventFeed(boost::asio::io_context& context, daemon::Operations& operations, Workers& workers)
    : context_(context)
    , operations_(operations)
    , workers_(workers)
    , retry_(context) {}

void EventFeed::start() {
    subscription_ = operations_.subscribe([&context = context_, noticed = noticed_, weak = weak_from_this()] {
        if (noticed->exchange(true)) {
            return; // it is on its way already
        }
        boost::asio::post(context, [noticed, weak] {
            noticed->store(false);
            if (const auto feed = weak.lock()) {
                feed->poll();
            }
        });
    });
    if (const auto newest = guarded([&] { return operations_.last_event(); })) {
        last_ = kept_after_ = *newest;
    }
    poll();
}

void EventFeed::stop() {
    stopped_ = true;
    operations_.unsubscribe(subscription_);
    retry_.cancel();
}

void EventFeed::poll() {
    if (polling_ || stopped_) {
        again_ = true;
        return;
    }
    polling_ = true;
    again_ = false;
    const bool posted = workers_.post(Lane::query, [self = shared_from_this(), known = last_] {
        auto newest = known ? Result<std::uint64_t>{*known} : guarded([&] { return self->operations_.last_event(); });
        auto events = newest ? guarded([&] { return self->operations_.events(*newest, max_batch); })
                             : Result<std::vector<daemon::EventView>>{newest.error()};
        boost::asio::post(self->context_, [self, newest = std::move(newest), events = std::move(events)]() mutable {
            self->take(std::move(newest), std::move(events));
        });
    });
    if (!posted) {
        take(Failure{}, Failure{});
    }
}

void EventFeed::take(Result<std::uint64_t> newest, Result<std::vector<daemon::EventView>> events) {
    polling_ = false;
    if (stopped_) {
        return;
    }
    if (!newest || !events) {
        retry_.expires_after(retry_interval);
        retry_.async_wait([self = shared_from_this()](const boost::system::error_code& cancelled) {
            if (!cancelled) {
                self->poll();
            }
        });
        return;
    }
    if (!last_) {
        last_ = kept_after_ = *newest;
    }
    for (const daemon::EventView& event : *events) {
        kept_.push_back({event.id, to_server_sent(event)});
        last_ = event.id;
    }
    while (kept_.size() > max_kept) {
        kept_after_ = kept_.front().id;
        kept_.pop_front();
    }
    if (!events->empty()) {
        const std::set<EventListener*> listeners = listeners_; // one that is cut off leaves
        for (EventListener* const listener : listeners) {
            if (listeners_.contains(listener)) {
                listener->on_new_events();
            }
        }
    }
    if (again_ || events->size() == max_batch) {
        poll();
    }
}

void EventFeed::read(std::uint64_t after, std::function<void(std::optional<EventBatch>)> done) {
    if (last_ && after >= kept_after_) {
        EventBatch batch{"", after};
        std::size_t count = 0;
        for (const Kept& kept : kept_) {
            if (kept.id > after && count++ < max_batch) {
                batch.text += kept.text;
                batch.last = kept.id;
            }
        }
        done(std::move(batch));
        return;
    }
    const bool posted = workers_.post(Lane::query, [self = shared_from_this(), after, done] {
        const auto events = guarded([&] { return self->operations_.events(after, max_batch); });
        std::optional<EventBatch> batch;
        if (events) {
            batch.emplace(EventBatch{"", after});
            if (after > 0 && !events->empty() && events->front().id > after + 1) {
                batch->text = to_server_sent_gap(after, events->front().id);
            }
            for (const daemon::EventView& event : *events) {
                batch->text += to_server_sent(event);
                batch->last = event.id;
            }
        }
        boost::asio::post(self->context_, [done, batch = std::move(batch)]() mutable { done(std::move(batch)); });
    });
    if (!posted) {
        done(std::nullopt);
    }
}

} // namespace linefeed::api
