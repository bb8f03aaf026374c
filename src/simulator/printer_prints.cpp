// The part of the printer model that prints: what a PrintGo finds, the numbering law, the ends of a job (protocol,
// section 5).
//
// What a PrintGo prints when no record is there in time, the manual says in pieces that fit together:
//   - "When there is a numbering, the mailing buffer may not get empty, otherwise an error and a stop print": while the
//     record printed last has a number, it is 5043. So it is after a stop, too: `=SM` still shows that number, and what
//     has a number is never printed twice.
//   - "With record number 0 … the last received record will be printed once more."
//   - Before the first record there is no numbering. An extern text is printed at every PrintGo, and so is a job
//     without either; in the places of texts that nobody has sent yet the job shows its wildcards, "used after
//     rebooting of the job or by sending a zero string". Print job, extern text and mailing are the three ways to
//     print variable texts; each works without the others.
#include "simulator/printer_model.hpp"

namespace linefeed::simulator {

namespace error_code = protocol::error_code;

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
    const MailSlot* loaded = fifo_.loaded();
    if (loaded != nullptr && loaded->arrived + settings_.margin <= now) {
        if (!loaded->has_number) {
            return stop_with_error(error_code::number_wrong, now);
        }
        if (!is_lawful(*loaded)) {
            return stop_with_error(error_code::number_not_consecutive, now);
        }
        print_loaded(now);
        return PrintGoOutcome::printed;
    }
    if (last_zero_text_) {
        print_without_record(PrintSource::last_record_again, *last_zero_text_, now);
        return PrintGoOutcome::printed;
    }
    if (numbered_ || loaded != nullptr) {
        effects_.emplace_back(Underrun{now, loaded == nullptr ? std::nullopt : std::optional{now - loaded->arrived}});
    }
    if (numbered_) {
        return stop_with_error(error_code::buffer_empty, now);
    }
    print_without_record(extern_text_.empty() ? PrintSource::job : PrintSource::extern_text, own_text(), now);
    return PrintGoOutcome::printed;
}

PrintGoOutcome PrinterModel::stop_with_error(std::uint32_t code, Instant now) {
    show_error(error_with_window(ErrorWindow::error, code), now);
    stop_printing(now);
    return PrintGoOutcome::stopped;
}

bool PrinterModel::record_ready(Instant now) const {
    const MailSlot* loaded = fifo_.loaded();
    return last_zero_text_.has_value() || (loaded != nullptr && loaded->arrived + settings_.margin <= now);
}

const std::string& PrinterModel::own_text() const {
    return extern_text_.empty() ? job_text_ : extern_text_;
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
    effects_.emplace_back(Printed{now, slot.number, slot.text, now - slot.arrived, PrintSource::record});
    numbered_ = slot.number != RecordNumber{};
    if (numbered_) {
        last_zero_text_.reset();
    } else {
        last_zero_text_ = slot.text;
    }
    const RecordNumber number = slot.number;
    if (--slot.prints_left == 0) {
        fifo_.pop();
    }
    previous_ = number;
    begin_print(number, now);
}

void PrinterModel::print_without_record(PrintSource source, const std::string& text, Instant now) {
    effects_.emplace_back(Printed{now, RecordNumber{}, text, std::nullopt, source});
    begin_print(RecordNumber{}, now);
}

void PrinterModel::begin_print(RecordNumber number, Instant now) {
    last_printed_ = number;
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
