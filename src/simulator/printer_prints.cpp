// The part of the printer model that prints: what a PrintGo finds, the numbering law, the ends of a job (protocol,
// section 5).
#include "simulator/printer_model.hpp"

namespace linefeed::simulator {
namespace {

namespace error_code = protocol::error_code;

} // namespace

PrintGoOutcome PrinterModel::print_go(Instant now) {
    advance(now);
    ++print_gos_;
    if (print_ends_) {
        // The distance of the products is shorter than the print: a setting that no real line has. The print ends here.
        finish_print(now);
    }
    if (!printing() || (fonts_loaded_ && now < *fonts_loaded_)) {
        return PrintGoOutcome::not_printing;
    }
    if (const MailSlot* loaded = fifo_.loaded(); loaded != nullptr && loaded->arrived + settings_.margin <= now) {
        if (!is_lawful(*loaded)) {
            show_error(error_with_window(ErrorWindow::error, error_code::number_not_consecutive), now);
            stop_printing(now);
            return PrintGoOutcome::stopped;
        }
        print_loaded(now);
        return PrintGoOutcome::printed;
    }
    if (last_zero_text_) {
        print_last_again(now);
        return PrintGoOutcome::printed;
    }
    const MailSlot* late = fifo_.loaded();
    effects_.emplace_back(Underrun{now, late == nullptr ? std::nullopt : std::optional{now - late->arrived}});
    show_error(error_with_window(ErrorWindow::error, error_code::buffer_empty), now);
    stop_printing(now);
    return PrintGoOutcome::stopped;
}

bool PrinterModel::record_ready(Instant now) const {
    const MailSlot* loaded = fifo_.loaded();
    return last_zero_text_.has_value() || (loaded != nullptr && loaded->arrived + settings_.margin <= now);
}

bool PrinterModel::is_lawful(const MailSlot& slot) const {
    if (slot.number == RecordNumber{}) {
        return true;
    }
    if (previous_ &&
        (*previous_ == RecordNumber{} || (*previous_ != RecordNumber::max() && slot.number == previous_->next()))) {
        return true;
    }
    return slot.starts_sequence && !settings_.habits.lead_in_law;
}

void PrinterModel::print_loaded(Instant now) {
    MailSlot& slot = *fifo_.loaded();
    effects_.emplace_back(Printed{now, slot.number, slot.text, now - slot.arrived});
    if (slot.number == RecordNumber{}) {
        last_zero_text_ = slot.text;
    } else {
        last_zero_text_.reset();
    }
    const RecordNumber number = slot.number;
    if (--slot.prints_left == 0) {
        fifo_.pop();
    }
    begin_print(number, now);
}

void PrinterModel::print_last_again(Instant now) {
    effects_.emplace_back(Printed{now, RecordNumber{}, *last_zero_text_, std::nullopt});
    begin_print(RecordNumber{}, now);
}

void PrinterModel::begin_print(RecordNumber number, Instant now) {
    last_printed_ = number;
    previous_ = number;
    last_print_finished_ = false;
    ++product_counter_;
    ++total_prints_;
    counters_.printed();
    print_ends_ = now + settings_.print_duration;
}

void PrinterModel::finish_print(Instant now) {
    print_ends_.reset();
    last_print_finished_ = true;
    if (!printing()) {
        return;
    }
    if (stop_at_ != RecordNumber{} && last_printed_ == stop_at_) {
        show_error(error_with_window(ErrorWindow::message, error_code::last_record_printed), now);
        stop_printing(now);
    } else if (stop_after_ != 0 && product_counter_ == stop_after_) {
        stop_printing(now);
    }
}

} // namespace linefeed::simulator
