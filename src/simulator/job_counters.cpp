// Counting, see job_counters.hpp.
#include "simulator/job_counters.hpp"

namespace linefeed::simulator {

void CounterSet::load(const std::vector<CounterDefinition>& definitions) {
    counters_.clear();
    for (const CounterDefinition& definition : definitions) {
        counters_.push_back({definition, definition, {}, {}, definition.start, 1});
    }
}

void CounterSet::printed() {
    for (Counter& counter : counters_) {
        if (counter.done < counter.working.repetitions) {
            ++counter.done;
        } else {
            counter.done = 1;
            advance(counter);
        }
    }
}

void CounterSet::advance(Counter& counter) {
    if (counter.value != counter.working.end) {
        counter.value += counter.value < counter.working.end ? 1U : ~std::uint64_t{0}; // up or down
        return;
    }
    counter.working.start = counter.next_start.value_or(counter.working.start);
    counter.working.end = counter.next_end.value_or(counter.working.end);
    counter.next_start.reset();
    counter.next_end.reset();
    counter.value = counter.working.start;
}

void CounterSet::reset(const protocol::CounterReset& reset) {
    for (std::size_t i = 0; i < counters_.size(); ++i) {
        if (reset.counter == 0 || reset.counter == i + 1) {
            counters_[i].value = reset.start.value_or(counters_[i].job.start);
            counters_[i].done = 1;
        }
    }
}

bool CounterSet::set_limit(const protocol::CounterParameter& parameter) {
    if (parameter.counter < 1 || parameter.counter > counters_.size()) {
        return false;
    }
    Counter& counter = counters_[parameter.counter - 1];
    (parameter.limit == protocol::CounterLimit::start ? counter.next_start : counter.next_end) = parameter.value;
    return true;
}

std::optional<std::uint64_t> CounterSet::limit(std::uint32_t id, protocol::CounterLimit which) const {
    if (id < 1 || id > counters_.size()) {
        return std::nullopt;
    }
    const CounterDefinition& working = counters_[id - 1].working;
    return which == protocol::CounterLimit::start ? working.start : working.end;
}

protocol::JobCounters CounterSet::state() const {
    protocol::JobCounters state;
    for (const Counter& counter : counters_) {
        state.counters.push_back({counter.done, counter.value});
    }
    return state;
}

} // namespace linefeed::simulator
