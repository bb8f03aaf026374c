// Faults by others who use the printer: a second client that asks, switches modes or interferes with what is printed,
// and another job while linefeed is away.
#include "faults.hpp"
#include "feeder/pacing.hpp"

#include <algorithm>
#include <string>

namespace linefeed::simulation {

using namespace std::chrono_literals;
using protocol::MachineState;
using simulator::PrinterModel;

bool Faults::cause_by_others(Fault fault) {
    switch (fault) {
    case Fault::another_job:
        return another_job();
    case Fault::second_client:
        ask_as_second_client();
        return true;
    case Fault::foreign_stop:
        line_.interfere("^0!ST");
        return true;
    case Fault::foreign_flush:
        return foreign_flush();
    case Fault::foreign_stop_point:
        line_.interfere("^0=CM" + std::to_string(foreign_stop_point()));
        return true;
    case Fault::foreign_record:
        line_.interfere("^0=MR" + std::to_string(foreign_number()) + "\tXforeign");
        return true;
    default:
        return false;
    }
}

bool Faults::another_job() {
    const auto status = line_.look().machine_status();
    job_waits_ = host_.running();
    if (job_waits_ || status.machine != MachineState::ready_to_print || !host_.ending().in_doubt.empty()) {
        return false;
    }
    const std::uint64_t depth = context_.scenario.printer.depth;
    const std::uint64_t count = random_.spread(1, depth - 1);
    const std::uint64_t next = std::max(judge_.last().value() + 1, context_.scenario.first());
    std::uint64_t first = 1;
    const std::uint64_t dice = random_.below(4);
    if (dice < 2) { // the same customer's numbers: the neighbourhood of ours
        first = next - random_.below(std::min(next, depth)) + random_.below(2 * depth);
    } else if (dice == 2) {
        first = random_.spread(2, 1U << 30U);
    }
    // While the fate of records of ours is open, numbers and a count of prints that continue ours exactly would tell
    // even an expert nothing: then they lie elsewhere.
    constexpr std::uint64_t near = 1000;
    if (host_.records_open() && first + count >= next && first <= next + near) {
        first = next + near + 1;
    }
    // Without a counter its stop point could be all that tells it from ours.
    if (!context_.scenario.prints_are_counted() && first + count - 1 == context_.scenario.last()) {
        return false;
    }
    line_.another_job(first, count);
    return true;
}

void Faults::line_is_free() {
    if (job_waits_ && !host_.running() && another_job()) {
        count(Fault::another_job);
    }
}

void Faults::ask_as_second_client() {
    static constexpr const char* frames[]{"^0?SM", "^0?SM", "^0?RS", "^0?CC", "^0?VS",
                                          "^0!LN", "^0!EM", "^0!EQ", "^0!US", "^0?EL"};
    for (std::uint64_t i = random_.between(1, 8); i > 0; --i) {
        line_.other_client(frames[random_.below(std::size(frames))]);
    }
}

/// The number of the record sent last, or printed last if none lies in the FIFO.
std::uint64_t Faults::newest_in_printer() {
    simulator::MailFifo fifo = line_.look().fifo();
    return fifo.loaded() == nullptr ? line_.look().mail_status().last_printed.value()
                                    : std::uint64_t{fifo.loaded()->number.value()} + fifo.records() - 1;
}

/// A flush in mid-run leaves a gap when records of ours are on their way to the printer: it goes on with them, behind
/// those that it has thrown away. No stop point shows that. The feeder sees a large gap by the leap in the numbers
/// (Pacing::leaps()), and then asks the counter; a gap that a fast line might have printed since the last answer cannot
/// be told from prints, and without a counter none can. So only what it can see is flushed.
bool Faults::gap_would_show() {
    const std::uint64_t lost = line_.look().fifo().records();
    const bool counted = context_.scenario.prints_are_counted();
    if (newest_in_printer() == context_.scenario.last() || (counted && !host_.running())) {
        return lost > 0; // nothing comes behind the gap, or somebody who counts it
    }
    if (!counted) {
        return false;
    }
    const auto seconds = [](Duration d) { return std::chrono::duration<double>(d).count(); };
    const Scenario& scenario = context_.scenario;
    const double depth = scenario.printer.depth;
    const double parts = (scenario.split > 0 ? 4.0 : 1.0) + (scenario.slow_write > 0 ? 4.0 : 0.0);
    const feeder::PacingSettings pacing;
    const double beat = depth / (pacing.burst_rate * pacing.polls_per_buffer);
    const double spacing = 0.032; // of the samples in Pacing
    const double gap = beat + (beat < spacing ? spacing : 0) +
                       3 * seconds(scenario.latency.high) * parts; // half a round trip later at the most
    const double unseen = 8 + 4 * pacing.burst_rate * gap;
    return context_.now > answers_late_until_ && static_cast<double>(lost) > unseen;
}

bool Faults::foreign_flush() {
    if (random_.chance(0.75)) { // with a refill right behind it: counted when it happens
        const Duration patience = context_.scenario.period * std::int64_t{context_.scenario.printer.depth} + 10s;
        line_.at(Line::Moment::record_while_printing, some_records(), context_.now + patience, [this] {
            if (gap_would_show()) {
                flush();
                count(Fault::foreign_flush);
            }
        });
        return false;
    }
    const bool shows = gap_would_show();
    if (shows) {
        flush();
    }
    return shows;
}

void Faults::flush() {
    line_.interfere("^0!FF");
    gap_ = true;
}

std::uint64_t Faults::foreign_stop_point() {
    const std::uint64_t printed = line_.look().mail_status().last_printed.value();
    const std::uint64_t newest = newest_in_printer();
    const std::uint64_t dice = random_.below(6);
    if (dice == 0) {
        return 0;
    }
    if (dice == 1) {
        return context_.scenario.last() + random_.spread(1, 1000);
    }
    return printed + 1 + random_.below(newest > printed ? newest - printed : 1); // in the FIFO
}

/// Out of order. A foreign record that takes the place of ours, with its number, is another's product that the printer
/// reports and counts as ours: if linefeed does not happen to see that there is one too many in the FIFO, nobody can
/// know. Nor can anybody without a counter who looks away while one with an old number of ours comes into an empty
/// FIFO. And a jump that is too small shows no more than a small gap does.
std::uint64_t Faults::foreign_number() {
    constexpr std::uint64_t near = 1000;
    const std::uint64_t newest = newest_in_printer();
    const std::uint64_t next = std::max<std::uint64_t>(newest + 1, context_.scenario.first());
    const std::uint64_t printed = line_.look().mail_status().last_printed.value();
    const std::uint64_t number = random_.spread(1, printed > 1 && random_.chance(0.5) ? printed - 1 : 1U << 30U);
    const bool order_is_checked = context_.scenario.prints_are_counted() || line_.look().fifo().loaded() != nullptr;
    const std::uint64_t least = order_is_checked ? printed : context_.scenario.first();
    const bool in_job = number >= context_.scenario.first() && number <= context_.scenario.last();
    const bool stands_for_ours = in_job && !judge_.is_on_a_product(RecordNumber{static_cast<std::uint32_t>(number)});
    const bool small_jump = number >= least && number <= next + near;
    return stands_for_ours || small_jump ? next + near + 1 : number;
}

} // namespace linefeed::simulation
