// The judge stands outside the core and looks only at what stuck to the products, at the ledger, and at what the
// operator was told.
#pragma once

#include "base/record_number.hpp"
#include "context.hpp"
#include "spool/ledger.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace linefeed::simulation {

/// It knows the records by their ids (ScenarioJob), unless they are said to be numbers as they went out.
class Judge {
public:
    explicit Judge(Context& context);

    // The tape
    void printed(RecordNumber number, std::string_view text);
    /// A person has started the printer, and it prints its last record again: nobody can keep it from that.
    void printed_again();
    void print_aborted(RecordNumber number);
    void underrun(bool explained);
    /// A product got what the job shows before the first record: it was missed as at an underrun, but nothing stops.
    void product_without_record(bool explained);
    void buffer_overfull();
    void numbers_out_of_order();
    /// The number of the next record does not follow on the last.
    void record_missing(bool next_is_intact);
    [[nodiscard]] bool is_intact(RecordNumber number, std::string_view text);
    /// The process is gone before it could write down what it knew.
    void host_died();

    // The operator's decisions about records in doubt
    void will_skip(RecordRange range);
    void will_reprint(RecordRange range);
    /// The products show the records from `first` to `last` without a jump; of the last it may be a part.
    [[nodiscard]] bool unbroken(RecordNumber first, RecordNumber last) const;
    /// He takes the record, of which the last product carries a part, for printed.
    void accepts_part(RecordNumber number);
    /// Printed to the end.
    [[nodiscard]] bool is_on_a_product(RecordNumber number) const;

    /// Every record that the ledger calls printed is on a product, every record that it calls unused is on none.
    void check_ledger(const spool::LedgerState& state, const ScenarioJob& job);
    /// The program said that everything is printed.
    void check_finished(const spool::LedgerState& state);
    /// All is over: no record is left out.
    void check_complete();

    /// The first violation ends the run.
    void violation(std::string what);
    [[nodiscard]] const std::optional<std::string>& violated() const { return violation_; }
    /// The record on the last product of the job, and whether it is complete. 0 = none yet.
    [[nodiscard]] RecordNumber last() const { return last_; }
    [[nodiscard]] bool last_is_complete() const { return last_complete_; }

private:
    struct Product {
        std::uint8_t complete = 0;
        std::uint8_t aborted = 0;
        std::uint8_t may_repeat = 0; ///< times the operator had it printed again
        bool may_be_missing = false;
        bool spoiled = false; ///< a product carries it with a damaged text
    };
    [[nodiscard]] Product* product(RecordNumber number);
    [[nodiscard]] RecordNumber id_of(RecordNumber number, const std::string& text) const;
    [[nodiscard]] bool may_go_out_as(RecordNumber id, RecordNumber number) const;
    [[nodiscard]] bool printer_could_not_be_stopped() const;

    Context& context_;
    std::vector<Product> products_;
    std::unordered_map<std::string, std::uint32_t> ids_; ///< by text, with several jobs
    RecordNumber last_;
    RecordNumber last_number_; ///< that it went out with
    bool last_complete_ = true;
    bool last_is_ours_ = true; ///< the product printed last of all carries a record of the job
    std::string expected_;
    std::optional<std::string> violation_;
};

} // namespace linefeed::simulation
