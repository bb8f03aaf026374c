#include "judge.hpp"

namespace linefeed::simulation {

namespace {

std::string record(RecordNumber number) {
    return "record " + std::to_string(number.value());
}

} // namespace

Judge::Judge(Context& context)
    : context_(context)
    , products_(context.scenario.records) {}

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

void Judge::printed(RecordNumber number, std::string_view text) {
    if (text.empty() || text.front() != 'R') {
        ++context_.counts.other_prints; // of another job, or the blank behind the last record
        last_is_ours_ = false;
        return;
    }
    ++context_.counts.prints;
    Product* it = product(number);
    context_.scenario.text_of(number.value(), expected_);
    if (it == nullptr || text != expected_) {
        violation("wrong text on a product: " + record(number));
        return;
    }
    if (it->complete > it->may_repeat) {
        violation("printed twice: " + record(number));
    }
    ++it->complete;
    last_ = number;
    last_complete_ = true;
    last_is_ours_ = true;
}

void Judge::print_aborted(RecordNumber number) {
    Product* it = product(number);
    if (it != nullptr && last_is_ours_ && number == last_ && last_complete_) {
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

void Judge::buffer_overfull() {
    violation("more records than the depth in the printer");
}

void Judge::numbers_out_of_order() {
    violation("the printer found its numbers out of order");
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

void Judge::check_ledger(const spool::LedgerState& state) {
    for (const spool::LedgerSegment& segment : state.segments()) {
        const bool says_printed = segment.state == spool::RecordState::printed;
        const bool says_unused = segment.state == spool::RecordState::unused;
        if (!says_printed && !says_unused) {
            continue;
        }
        for (std::uint64_t i = 0; i < segment.range.count().value(); ++i) {
            const RecordNumber number = segment.range.first() + RecordCount{i};
            const Product* it = product(number);
            if (it == nullptr) {
                violation("the ledger knows a record that the job does not have: " + record(number));
                return;
            }
            if (says_printed && it->complete == 0 && !it->may_be_missing) {
                violation(it->aborted > 0 ? "the ledger calls it printed, the product carries a part: " + record(number)
                                          : "the ledger calls it printed, but it is not: " + record(number));
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
