#include "judge.hpp"

namespace linefeed::simulation {

namespace {

std::string record(RecordNumber number) {
    return "record " + std::to_string(number.value());
}

} // namespace

Judge::Judge(Context& context)
    : context_(context)
    , products_(context.scenario.records) {
    if (context.scenario.jobs.size() > 1) {
        for (std::uint32_t id = context.scenario.first(); id <= context.scenario.last(); ++id) {
            context.scenario.text_of(id, expected_);
            ids_.emplace(expected_, id);
        }
    }
}

/// With one job its number; with several the text tells which it is.
RecordNumber Judge::id_of(RecordNumber number, const std::string& text) const {
    const auto found = ids_.find(text);
    return found == ids_.end() ? number : RecordNumber{found->second};
}

/// Number 0 begins a new sequence, and only the first record of a job that follows another may have it.
bool Judge::may_go_out_as(RecordNumber id, RecordNumber number) const {
    for (const ScenarioJob& job : context_.scenario.jobs) {
        if (job.has(id.value())) {
            const bool begins = id.value() == job.first && job.first != context_.scenario.first();
            return number.value() == id.value() - job.behind || (begins && number == RecordNumber{});
        }
    }
    return true;
}

void Judge::violation(std::string what) {
    context_.trace.say(context_.now, "VIOLATION", what);
    if (!violation_) {
        violation_ = std::move(what);
    }
}

Judge::Product* Judge::product(RecordNumber number) {
    const std::uint32_t first = context_.scenario.first();
    return number.value() < first || number.value() > context_.scenario.last() ? nullptr
                                                                               : &products_[number.value() - first];
}

void Judge::printed(RecordNumber sent_as, std::string_view text) {
    if (text.empty() || text.front() != 'R') {
        ++context_.counts.other_prints; // of another job, or the blank behind the last record
        last_is_ours_ = false;
        return;
    }
    ++context_.counts.prints;
    const RecordNumber number = id_of(sent_as, std::string{text});
    Product* it = product(number);
    context_.scenario.text_of(number.value(), expected_);
    if (it == nullptr || text != expected_) {
        if (!printer_could_not_be_stopped()) {
            violation("wrong text on a product: " + record(number));
        }
        if (it != nullptr && number.value() == context_.noise.record) {
            it->spoiled = true; // to be named in doubt: see check_ledger()
        }
        last_is_ours_ = false;
        return;
    }
    if (it->complete > it->may_repeat) {
        violation("printed twice: " + record(number));
    }
    if (!may_go_out_as(number, sent_as)) {
        violation("a wrong number: " + record(number) + " went out as " + std::to_string(sent_as.value()));
    }
    ++it->complete;
    last_ = number;
    last_number_ = sent_as;
    last_complete_ = true;
    last_is_ours_ = true;
}

void Judge::printed_again() {
    ++context_.counts.other_prints;
    last_is_ours_ = false;
}

void Judge::print_aborted(RecordNumber number) {
    Product* it = product(last_);
    if (it != nullptr && last_is_ours_ && number == last_number_ && last_complete_) {
        --it->complete;
        ++it->aborted;
        last_complete_ = false;
    }
}

void Judge::underrun(bool explained) {
    ++context_.counts.underruns;
    if (!explained) {
        violation("avoidable underrun");
    }
}

void Judge::product_without_record(bool explained) {
    if (!explained) {
        violation("a product without a record");
    }
}

/// Noise has taken both the announcement and a part of the record, so that the printer took it unchecked, and the host,
/// which still waits for a word on it, had no time to stop the line. The number may be damaged, too.
bool Judge::printer_could_not_be_stopped() const {
    return context_.now <
           context_.noise.record_left_at + std::chrono::milliseconds{2500} + 8 * context_.scenario.latency.high;
}

/// Nobody else knows that the printer has not said a word on the record.
void Judge::host_died() {
    if (Product* const it = product(RecordNumber{context_.noise.record});
        it != nullptr && printer_could_not_be_stopped()) {
        it->may_be_missing = true;
    }
}

/// Noise can make a record of an announcement: `=NR5` and `=MR5` differ by one bit.
void Judge::buffer_overfull() {
    if (context_.noise.at_printer != context_.now) {
        violation("more records than the depth in the printer");
    }
}

void Judge::numbers_out_of_order() {
    if (!printer_could_not_be_stopped()) {
        violation("the printer found its numbers out of order");
    }
}

/// With CRC32 no record goes out before the one in front of it is known to be right.
void Judge::record_missing(bool next_is_intact) {
    if (next_is_intact && last_is_ours_) {
        violation("a record is missing in the printer");
    }
}

bool Judge::is_intact(RecordNumber number, std::string_view text) {
    context_.scenario.text_of(number.value(), expected_);
    return text == expected_;
}

void Judge::will_skip(RecordRange range) {
    for (std::uint64_t i = 0; i < range.count().value(); ++i) {
        product(range.first() + RecordCount{i})->may_be_missing = true;
    }
}

void Judge::will_reprint(RecordRange range) {
    for (std::uint64_t i = 0; i < range.count().value(); ++i) {
        Product* it = product(range.first() + RecordCount{i});
        it->may_repeat = it->complete;
        it->aborted = 0;
        it->spoiled = false;
    }
}

bool Judge::unbroken(RecordNumber first, RecordNumber last) const {
    for (std::uint64_t number = first.value(); number <= last.value(); ++number) {
        const Product& it = products_[number - context_.scenario.first()];
        if (it.complete == 0 && (it.aborted == 0 || number < last.value())) {
            return false;
        }
    }
    return true;
}

void Judge::accepts_part(RecordNumber number) {
    product(number)->may_be_missing = true;
}

bool Judge::is_on_a_product(RecordNumber number) const {
    return products_[number.value() - context_.scenario.first()].complete > 0;
}

void Judge::check_ledger(const spool::LedgerState& state, const ScenarioJob& job) {
    for (const spool::LedgerSegment& segment : state.segments()) {
        const bool says_printed = segment.state == spool::RecordState::printed;
        const bool says_unused = segment.state == spool::RecordState::unused;
        const bool says_in_doubt = segment.state == spool::RecordState::in_doubt;
        if (!says_printed && !says_unused && !says_in_doubt) {
            continue;
        }
        for (std::uint64_t i = 0; i < segment.range.count().value(); ++i) {
            const RecordNumber number = segment.range.first() + RecordCount{i + job.behind};
            Product* it = product(number);
            if (it == nullptr || !job.has(number.value())) {
                violation("the ledger knows a record that the job does not have: " + record(number));
                return;
            }
            if (says_printed && it->complete == 0 && !it->may_be_missing) {
                violation(it->aborted > 0 ? "the ledger calls it printed, the product carries a part: " + record(number)
                                          : "the ledger calls it printed, but it is not: " + record(number));
                return;
            }
            it->spoiled = it->spoiled && !says_in_doubt;
            if (says_unused && it->spoiled) {
                violation("the ledger calls it unused, but a product carries it with a damaged text: " +
                          record(number));
                return;
            }
            if (says_unused && it->complete > it->may_repeat) {
                violation("the ledger calls it unused, but it is printed: " + record(number));
                return;
            }
        }
    }
}

void Judge::check_finished(const spool::LedgerState& state) {
    for (const auto kind : {spool::RecordState::open, spool::RecordState::in_doubt, spool::RecordState::unused,
                            spool::RecordState::released}) {
        if (state.count(kind) > RecordCount{0}) {
            violation("told to be finished with records that are " + std::string{spool::to_string(kind)});
        }
    }
}

void Judge::check_complete() {
    for (std::uint32_t i = 0; i < products_.size(); ++i) {
        if (products_[i].complete == 0 && !products_[i].may_be_missing) {
            violation("left out: " + record(RecordNumber{context_.scenario.first() + i}));
            return;
        }
    }
}

} // namespace linefeed::simulation
