#include "line.hpp"

#include "protocol/printer_error.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace linefeed::simulation {

using simulator::PrinterModel;

Line::Line(Context& context, Judge& judge, Wire& wire, Random random)
    : context_(context)
    , judge_(judge)
    , wire_(wire)
    , random_(random)
    , printers_{std::make_unique<PrinterModel>(context.scenario.printer, context.now), nullptr}
    , printer_(printers_[0].get()) {
    if (context.scenario.bursts) {
        context_.after(std::chrono::seconds{5}, EventKind::belt_changes);
    }
}

void Line::receive(std::uint64_t connection, std::string_view bytes) {
    auto found =
        std::find_if(clients_.begin(), clients_.end(), [&](const auto& it) { return it->connection == connection; });
    if (found == clients_.end()) {
        clients_.push_back(std::make_unique<Client>());
        clients_.back()->connection = connection;
        found = std::prev(clients_.end());
    }
    Client& client = **found;
    while (true) {
        const auto result = client.decoder.next(bytes);
        if (const auto* frame = std::get_if<protocol::Frame>(&result)) {
            if (deed_ && connection != other_client_id) {
                about_to_take(*frame);
            }
            const bool was_printing = printer_->printing();
            printer_->receive({connection}, *frame, context_.now);
            if (!was_printing && printer_->printing()) {
                started_by_host_ = connection != other_client_id;
            }
        } else if (std::holds_alternative<std::monostate>(result)) {
            break;
        }
    }
    carry_out();
}

void Line::disconnected(std::uint64_t connection) {
    printer_->disconnected({connection});
    std::erase_if(clients_, [connection](const auto& client) { return client->connection == connection; });
}

const PrinterModel& Line::look() {
    printer_->advance(context_.now);
    carry_out();
    return *printer_;
}

void Line::other_client(std::string_view frame) {
    receive(other_client_id, std::string{frame} + '\r');
}

void Line::interfere(std::string_view frame) {
    context_.trace.say(context_.now, "another client", frame);
    others_interfere_ = true;
    other_client(frame);
}

void Line::another_job(std::uint64_t first, std::uint64_t count) {
    context_.trace.note(context_.now, "another job", first, count);
    others_interfere_ = true;
    other_client("^0!EQ");
    other_client("^0!FF");
    other_client("^0=CM" + std::to_string(first + count - 1));
    for (std::uint64_t i = 0; i < count; ++i) {
        other_client("^0=MR" + std::to_string(first + i) + "\tX" + std::to_string(i));
    }
    other_client("^0!GO");
}

void Line::at(Moment moment, std::uint64_t skipped, Instant until, std::function<void()> deed) {
    deed_ = std::move(deed);
    deed_at_ = moment;
    moments_skipped_ = skipped;
    deed_until_ = until;
}

bool Line::is_moment(const protocol::Frame& frame) const {
    const bool record = frame.group == protocol::Group::parameter && frame.payload.starts_with("MR");
    switch (deed_at_) {
    case Moment::record:
        return record;
    case Moment::record_while_printing:
        return record && printer_->printing();
    case Moment::count_over_records:
        return frame.group == protocol::Group::inquiry && frame.payload == "CC" && !printer_->printing() &&
               printer_->fifo().records() > 0;
    }
    assertion_failed("Moment", __FILE__, __LINE__);
}

void Line::about_to_take(const protocol::Frame& frame) {
    if (context_.now > deed_until_) {
        deed_ = nullptr;
    } else if (is_moment(frame) && moments_skipped_-- == 0) {
        std::exchange(deed_, nullptr)();
    }
}

/// A printer of the same make that does the same work: its numbers and its counter may look like ours.
std::unique_ptr<PrinterModel> Line::sister_printer() {
    constexpr Duration earlier = std::chrono::seconds{10};
    const std::uint32_t depth = context_.scenario.printer.depth;
    // It is a little ahead of ours, or behind.
    const auto behind = static_cast<std::uint32_t>(random_.below(depth));
    const auto ahead = static_cast<std::uint32_t>(random_.chance(0.6) ? random_.below(depth) + behind : 0);
    const bool has_printed = random_.chance(0.5); // otherwise it is fresh from power-up
    simulator::PrinterSettings settings = context_.scenario.printer;
    settings.serial_number = "204812";
    settings.total_prints = random_.chance(0.2) ? settings.total_prints + 1234567
                                                : printer_->total_prints() + ahead - behind - (has_printed ? 1 : 0);
    auto sister = std::make_unique<PrinterModel>(settings, context_.now - earlier);
    if (has_printed) { // a record of about this number
        const std::uint64_t number =
            std::max<std::uint64_t>(judge_.last().value(), context_.scenario.first() + behind) + ahead - behind;
        const std::string record = "^0=MR" + std::to_string(number) + "\tX\r^0!GO\r";
        protocol::FrameDecoder decoder;
        std::string_view bytes = record;
        while (!bytes.empty()) {
            const auto result = decoder.next(bytes);
            if (const auto* frame = std::get_if<protocol::Frame>(&result)) {
                sister->receive({other_client_id}, *frame, context_.now - earlier);
            }
        }
        (void)sister->print_go(context_.now - earlier / 2);
        sister->press(protocol::Action::stop_print, context_.now);
        sister->press(protocol::Action::acknowledge_errors, context_.now);
    }
    sister->clear_effects();
    return sister;
}

void Line::exchange_printer() {
    printer_->press(protocol::Action::power_off, context_.now);
    carry_out();
    wire_.printer_closes(random_.chance(0.5));
    clients_.clear();
    at_address_ = 1 - at_address_;
    others_interfere_ = false;
    if (printers_[at_address_] == nullptr) {
        printers_[at_address_] = sister_printer();
        printer_ = printers_[at_address_].get();
    } else {
        printer_ = printers_[at_address_].get();
        printer_->power_cycle(context_.now);
        printer_->clear_effects();
    }
    carry_out();
}

void Line::carry_out() {
    while (!printer_->effects().empty()) {
        printer_->take_effects(effects_);
        for (simulator::Effect& effect : effects_) {
            carry_out(effect);
        }
    }
    move_belt();
}

void Line::carry_out(simulator::Effect& effect) {
    if (const auto* print = std::get_if<simulator::Printed>(&effect)) {
        context_.trace.note(context_.now, "print", print->number.value());
        if (print->source == simulator::PrintSource::last_record_again && started_empty_) {
            judge_.printed_again(); // the numbering law: number 0 was the last before the stop
        } else {
            judge_.printed(print->number, print->text);
        }
        const bool without_record =
            print->source == simulator::PrintSource::job || print->source == simulator::PrintSource::extern_text;
        if (without_record) {
            context_.trace.note(context_.now, "no record on the product");
            judge_.product_without_record(!started_by_host_ || others_interfere_ || underrun_is_explained());
        }
    } else if (auto* reply = std::get_if<simulator::Reply>(&effect)) {
        if (reply->connection.value != other_client_id) {
            context_.trace.say(context_.now, "printer says", reply->bytes);
            wire_.to_host(reply->connection.value, reply->bytes);
        }
    } else if (const auto* aborted = std::get_if<simulator::PrintAborted>(&effect)) {
        context_.trace.note(context_.now, "print broken off", aborted->number.value());
        judge_.print_aborted(aborted->number);
    } else if (std::holds_alternative<simulator::Underrun>(effect)) {
        context_.trace.note(context_.now, "underrun");
        judge_.underrun(others_interfere_ || underrun_is_explained());
    } else if (const auto* error = std::get_if<simulator::ErrorRaised>(&effect)) {
        const std::uint32_t code = error->error.code_without_bit_24();
        context_.trace.note(context_.now, "error", code);
        if (code == protocol::error_code::buffer_full && !others_interfere_) {
            judge_.buffer_overfull();
        }
        if (code == protocol::error_code::number_wrong) {
            judge_.numbers_out_of_order();
        }
        if (code == protocol::error_code::number_not_consecutive && !others_interfere_) {
            judge_.record_missing(next_is_intact_);
        }
    } else if (const auto* state = std::get_if<simulator::StateChanged>(&effect)) {
        context_.trace.note(context_.now, "machine state", static_cast<std::uint64_t>(state->machine),
                            state->cover_open ? 1 : 0);
        started_by_host_ = started_by_host_ && printer_->printing();
        started_empty_ = printer_->printing() && !started_by_host_ && printer_->fifo().records() == 0;
        others_interfere_ = others_interfere_ && (printer_->printing() || printer_->fifo().records() > 0);
    } else if (std::holds_alternative<simulator::ConnectionsLost>(effect)) {
        context_.trace.note(context_.now, "printer restarted");
        wire_.printer_closes(random_.chance(0.5));
        clients_.clear();
    }
}

Duration Line::step() {
    const Scenario& scenario = context_.scenario;
    Duration step = scenario.period;
    if (fast_) {
        step /= 2;
    }
    if (scenario.period_jitter > Duration{0}) {
        step += random_.between(Duration{0}, scenario.period_jitter * 2) - scenario.period_jitter;
    }
    return step;
}

void Line::move_belt() {
    if (!printer_->printing()) {
        if (product_due_ != Instant::max()) {
            context_.counts.printing += context_.now - printing_since_;
        }
        product_due_ = Instant::max();
    } else if (product_due_ == Instant::max()) {
        constexpr Duration start_delay = std::chrono::milliseconds{20};
        printing_since_ = context_.now;
        product_due_ = std::max(context_.now + std::max(start_delay, context_.scenario.period), belt_stands_until_);
    }
}

void Line::product() {
    const simulator::MailSlot* const next = printer_->fifo().loaded();
    next_is_intact_ = context_.scenario.crc && next != nullptr && judge_.is_intact(next->number, next->text);
    const auto outcome = printer_->print_go(context_.now);
    product_due_ = std::max(context_.now + step(), belt_stands_until_);
    carry_out();
    if (outcome != simulator::PrintGoOutcome::printed) {
        context_.trace.note(context_.now, "blank product");
    }
}

void Line::change_belt() {
    fast_ = !fast_;
    context_.after(random_.spread(Duration{std::chrono::milliseconds{500}}, Duration{std::chrono::seconds{30}}),
                   EventKind::belt_changes);
}

void Line::pause_belt(Duration duration) {
    belt_stands_until_ = context_.now + duration;
    if (product_due_ != Instant::max()) {
        product_due_ = std::max(product_due_, belt_stands_until_);
    }
}

} // namespace linefeed::simulation
