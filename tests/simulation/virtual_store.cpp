#include "virtual_store.hpp"

namespace linefeed::simulation {

namespace {
using namespace std::chrono_literals;

constexpr Duration checkpoint_interval = 5s;

/// Whether the request needs the disk.
bool is_durable(const store::StoreRequest& request) {
    return std::holds_alternative<feeder::Settle>(request) || std::holds_alternative<feeder::BeginRun>(request) ||
           std::holds_alternative<feeder::AdoptRun>(request) || std::holds_alternative<feeder::End>(request);
}

} // namespace

VirtualStore::VirtualStore(Context& context, Random random, store::StoreWork work, std::uint64_t generation)
    : context_(context)
    , random_(random)
    , work_(std::move(work))
    , generation_(generation)
    , last_commit_(context.now)
    , last_checkpoint_(context.now) {}

void VirtualStore::push(store::StoreRequest request) {
    requests_.push_back(std::move(request));
    go_on();
}

void VirtualStore::go_on() {
    Operation operation{};
    if (!busy_ && choose(operation)) {
        begin(operation);
    }
}

bool VirtualStore::choose(Operation& operation) {
    while (!requests_.empty() && !work_.ended()) {
        if (is_durable(requests_.front())) {
            operation = Operation::take;
            return true;
        }
        work_.take(requests_.front());
        requests_.pop_front();
    }
    if (work_.ended()) {
        return false;
    }
    const Instant gathered = last_commit_ + context_.scenario.gather;
    if (work_.intent_waits() || (work_.wants_commit() && context_.now >= gathered)) {
        operation = Operation::commit;
        return true;
    }
    if (work_.wants_read_ahead()) {
        operation = Operation::read;
        return true;
    }
    if (context_.now - last_checkpoint_ >= checkpoint_interval) {
        operation = Operation::checkpoint;
        return true;
    }
    if (work_.wants_commit() && wake_at_ <= context_.now) {
        wake_at_ = gathered;
        context_.queue.put(gathered, EventKind::store_wake, generation_);
    }
    return false;
}

void VirtualStore::begin(Operation operation) {
    constexpr Duration read_time = 20us;
    busy_ = true;
    operation_ = operation;
    Duration takes = operation == Operation::read
                         ? read_time
                         : random_.between(context_.scenario.commit.low, context_.scenario.commit.high);
    if (slow_until_ > context_.now) {
        takes += slow_until_ - context_.now;
    }
    executed_ = random_.chance(0.5);
    if (executed_) {
        execute();
    }
    context_.after(takes, EventKind::store_done, generation_);
}

void VirtualStore::execute() {
    switch (operation_) {
    case Operation::take: {
        const store::StoreRequest request = std::move(requests_.front());
        requests_.pop_front();
        work_.take(request);
        return;
    }
    case Operation::commit:
        work_.commit();
        return;
    case Operation::read:
        work_.read_ahead();
        return;
    case Operation::checkpoint:
        work_.checkpoint();
        return;
    }
}

void VirtualStore::done() {
    if (!executed_) {
        execute();
    }
    busy_ = false;
    if (operation_ == Operation::commit) {
        last_commit_ = context_.now;
    } else if (operation_ == Operation::checkpoint) {
        last_checkpoint_ = context_.now;
    }
}

void VirtualStore::wake() {
    go_on();
}

void VirtualStore::die() {
    constexpr std::uint64_t writes_of_an_operation = 24;
    RamDisk::instance().stop_after(random_.below(writes_of_an_operation));
    if (busy_ && !executed_ && operation_ != Operation::read) {
        execute();
    }
    RamDisk::instance().stop_after(0);
}

} // namespace linefeed::simulation
