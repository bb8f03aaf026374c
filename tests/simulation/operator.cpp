#include "operator.hpp"

#include "protocol/printer_error.hpp"

#include <algorithm>

namespace linefeed::simulation {

using protocol::Action;
using protocol::MachineState;
using simulator::PrinterModel;

Operator::Operator(Context& context, Judge& judge, Line& line, Host& host, Random random)
    : context_(context)
    , judge_(judge)
    , line_(line)
    , host_(host)
    , random_(random) {}

void Operator::look_again() {
    context_.after(random_.between(Duration{std::chrono::milliseconds{500}}, Duration{std::chrono::seconds{5}}),
                   EventKind::operator_acts);
}

void Operator::act() {
    if (host_.running() || done_) {
        return;
    }
    if (!host_has_power_) {
        look_again();
        return;
    }
    if (host_.ending().complete) {
        done_ = true;
        return;
    }
    if (puts_printer_in_order()) {
        look_again();
        return;
    }
    host_.start(decides());
}

/// True if there was something to do or to wait for.
bool Operator::puts_printer_in_order() {
    const PrinterModel& printer = line_.look();
    const auto status = printer.machine_status();
    const auto press = [this](Action action) {
        context_.trace.note(context_.now, "operator presses", static_cast<std::uint64_t>(action));
        line_.act([action](PrinterModel& model, Instant now) { model.press(action, now); });
        return true;
    };
    if (status.cover_open) {
        line_.act([](PrinterModel& model, Instant now) { model.close_cover(now); });
        return true;
    }
    switch (status.machine) {
    case MachineState::standby:
        return press(Action::power_on);
    case MachineState::unknown:
    case MachineState::initialising:
        return true;
    case MachineState::ready:
        if (status.nozzle == protocol::NozzleState::opens || status.nozzle == protocol::NozzleState::closes) {
            return true;
        }
        if (!context_.scenario.open_nozzle) {
            return press(Action::nozzle_open);
        }
        break;
    case MachineState::printing: {
        // linefeed takes over what it finds; another job, or a question about the last product, is seen to first.
        const bool must_stop = host_.ending().code == feeder::OutcomeCode::busy ||
                               host_.ending().code == feeder::OutcomeCode::did_not_stop ||
                               !host_.ending().in_doubt.empty();
        if (must_stop) {
            return press(Action::stop_print);
        }
        break;
    }
    case MachineState::service:
    case MachineState::ready_to_print:
        break;
    }
    const bool needs_word = !status.error.none() && status.error.display() == protocol::ErrorDisplay::error;
    return needs_word && random_.chance(0.7) ? press(Action::acknowledge_errors) : false;
}

daemon::OperatorWord Operator::decides() {
    daemon::OperatorWord word;
    const std::vector<RecordRange>& doubt = host_.ending().in_doubt;
    if (doubt.empty()) {
        return word;
    }
    const ScenarioJob& job = host_.ending().doubted;
    const RecordNumber first = doubt.front().first();
    // A jump in the numbers on the products: "the last product" would say too much. So would one from before
    // his last word.
    const bool from_before = judge_.last() > doubt.back().last() && judge_.last() <= spoken_of_;
    const bool jump =
        judge_.last() >= first && judge_.last() <= doubt.back().last() && !judge_.unbroken(first, judge_.last());
    const std::uint64_t dice = random_.below(100);
    if (dice < context_.scenario.skips_percent) {
        word.policy = daemon::InDoubtPolicy::skip;
        std::for_each(doubt.begin(), doubt.end(), [this](const RecordRange& range) { judge_.will_skip(range); });
        return word;
    }
    if (dice < context_.scenario.skips_percent + context_.scenario.reprints_percent) {
        word.policy = daemon::InDoubtPolicy::reprint;
        spoken_of_ = judge_.last(); // the products made so far tell nothing of what is printed once more
        std::for_each(doubt.begin(), doubt.end(), [this](const RecordRange& range) { judge_.will_reprint(range); });
        return word;
    }
    const bool of_another_job = context_.scenario.jobs.size() > 1 && !job.has(judge_.last().value());
    if (jump || from_before || of_another_job || host_.ending().word_refused || random_.chance(0.2)) {
        word.printed = names_products(doubt);
        context_.trace.say(context_.now, "products", *word.printed);
        return word;
    }
    RecordNumber last = judge_.last();
    const RecordNumber before_first = first.previous();
    if (!judge_.last_is_complete() && last > before_first) {
        if (random_.chance(0.5)) {
            judge_.accepts_part(last);
        } else {
            last = last.previous();
        }
    }
    if (last > doubt.back().last()) {
        judge_.violation("in doubt although a later record is on the last product");
    }
    word.last_printed = std::to_string(std::max(last, before_first).value() - job.behind);
    context_.trace.say(context_.now, "last product", word.last_printed);
    return word;
}

/// The records in doubt that are on products, for --printed.
std::string Operator::names_products(const std::vector<RecordRange>& doubt) {
    std::string names;
    spoken_of_ = judge_.last();
    for (const RecordRange& range : doubt) {
        for (std::uint64_t i = 0; i < range.count().value(); ++i) {
            const RecordNumber number = range.first() + RecordCount{i};
            if (judge_.is_on_a_product(number)) {
                names += (names.empty() ? "" : ",") + std::to_string(number.value() - host_.ending().doubted.behind);
            }
        }
    }
    return names.empty() ? "none" : names;
}

} // namespace linefeed::simulation
