// What clients set in the printer model: records, jobs, counters, parameters (protocol, sections 4, 5 and 7).
#include "simulator/printer_model.hpp"

#include <algorithm>
#include <utility>

namespace linefeed::simulator {

namespace error_code = protocol::error_code;

/// The place of the record that has come: none if it finds none.
MailSlot* PrinterModel::slot_for_record(Instant now) {
    if (settings_.habits.no_mailing_field) {
        return nullptr;
    }
    if (fifo_.full()) {
        show_error(error_with_window(ErrorWindow::warning, error_code::buffer_full), now);
        return nullptr;
    }
    MailSlot& slot = fifo_.push();
    slot.arrived = now;
    slot.text.clear();
    return &slot;
}

void PrinterModel::take(const protocol::MailRecord& record, Instant now) {
    MailSlot* const slot = slot_for_record(now);
    if (slot == nullptr) {
        return;
    }
    slot->number = record.number;
    for (const std::string& field : record.fields) {
        if (&field != &record.fields.front()) {
            slot->text += '\t';
        }
        slot->text += field;
    }
    if (!settings_.profile.record_properties && !record.properties.empty()) {
        slot->text += '\t'; // to old firmware the block is a field like any other
        protocol::append_properties(slot->text, record.properties);
    } else if (record.number == RecordNumber{}) {
        slot->prints_left = std::max(record.properties.repetitions.value_or(1), 1U);
    }
}

/// A record without a number that can be read takes its place like any other: numbers are checked when it is its turn.
/// Anything else that cannot be read is ignored.
void PrinterModel::take(const protocol::MalformedMessage& message, Instant now) {
    if (message.group != protocol::Group::parameter ||
        !message.payload.starts_with(protocol::code(protocol::Parameter::MR))) {
        return;
    }
    if (MailSlot* const slot = slot_for_record(now)) {
        slot->number = RecordNumber{};
        slot->has_number = false;
    }
}

void PrinterModel::take(const protocol::StopAt& stop, Instant) {
    const Habits& habits = settings_.habits;
    if (!habits.ignore_stop_at && (printing() || !habits.stop_at_only_while_printing)) {
        stop_at_ = stop.number;
    }
}

void PrinterModel::take(const protocol::Counters& counters, Instant) {
    product_counter_ = counters.product.value_or(product_counter_);
    stop_after_ = counters.stop_after.value_or(stop_after_);
}

void PrinterModel::take(const protocol::CounterReset& reset, Instant) {
    counters_.reset(reset);
}

void PrinterModel::take(const protocol::CounterParameter& parameter, Instant) {
    if (settings_.profile.counter_parameters) {
        job_changed_ = counters_.set_limit(parameter) || job_changed_;
    }
}

void PrinterModel::take(const protocol::JobName& job, Instant now) {
    auto found = job_at(job.path);
    if (job.path.empty() || (!found && settings_.habits.missing_jobs_refused)) {
        return;
    }
    pending_job_ = {now + settings_.job_loading_time, found ? *std::move(found) : PrintJob{job.path, {}}};
}

/// Behind a job that is still being loaded: it is meant for that one.
void PrinterModel::take(const protocol::ExternText& text, Instant now) {
    const Instant begin = pending_job_ ? pending_job_->due : now;
    pending_extern_text_ = {begin + settings_.extern_text_time, text.text};
}

void PrinterModel::take(const protocol::PrintParameter& parameter, Instant) {
    std::uint32_t& value = print_parameters_[static_cast<std::size_t>(parameter.type) - 1];
    job_changed_ = job_changed_ || value != parameter.value; // they are parameters of the job
    value = parameter.value;
}

void PrinterModel::take(const protocol::ClockTime& clock, Instant now) {
    if (const auto wall = protocol::to_sys_seconds(clock.time)) {
        clock_.set(*wall, now);
    }
}

void PrinterModel::take(const protocol::BlockLength& length, Instant) {
    transmitter_.set_block_length(length.bytes);
}

void PrinterModel::take(const protocol::OutputChange& change, Instant) {
    if (settings_.profile.output_control && change.output <= settings_.profile.outputs()) {
        outputs_.change(change);
    }
}

void PrinterModel::take(const protocol::WysiwygStart& start, Instant) {
    wysiwyg_start_ = start.x;
}

/// BEGIN deletes the file of the current job, END hands the new one to be printed.
void PrinterModel::take(const protocol::ScriptLine& line, Instant now) {
    if (line.is_begin()) {
        script_ = PrintJob{std::string{extern_job_name}, {}};
        job_.lines.clear();
        job_changed_ = true;
    } else if (script_ && line.is_end()) {
        pending_job_ = {now + settings_.job_loading_time, *std::exchange(script_, std::nullopt)};
    } else if (script_ && script_->lines.size() < max_script_lines) {
        script_->lines.push_back(line.text);
    }
}

} // namespace linefeed::simulator
