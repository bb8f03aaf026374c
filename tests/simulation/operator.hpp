// The person at the line: puts the printer in order after an interruption, enters the same command again, and, asked
// about records in doubt, looks at the last product and says what stands on it.
#pragma once

#include "context.hpp"
#include "host.hpp"
#include "judge.hpp"
#include "line.hpp"
#include "random.hpp"

namespace linefeed::simulation {

class Operator {
public:
    Operator(Context& context, Judge& judge, Line& line, Host& host, Random random);

    /// An event of kind operator_acts: one thing at a time.
    void act();
    [[nodiscard]] bool host_has_power() const { return host_has_power_; }
    void set_host_power(bool on) { host_has_power_ = on; }
    /// The job is complete, as far as he was told.
    [[nodiscard]] bool done() const { return done_; }

private:
    [[nodiscard]] bool puts_printer_in_order();
    [[nodiscard]] daemon::OperatorWord decides();
    [[nodiscard]] std::string names_products(const std::vector<RecordRange>& doubt);
    void look_again();

    Context& context_;
    Judge& judge_;
    Line& line_;
    Host& host_;
    Random random_;
    bool host_has_power_ = true;
    bool done_ = false;
    RecordNumber spoken_of_; ///< the last on a product when he gave his last word about products
};

} // namespace linefeed::simulation
