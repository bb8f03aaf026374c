// What goes wrong, when: draws faults by the weights of the scenario, causes them, and repairs what does not repair
// itself.
#pragma once

#include "host.hpp"
#include "line.hpp"
#include "operator.hpp"
#include "wire.hpp"

namespace linefeed::simulation {

class Faults {
public:
    Faults(Context& context, Judge& judge, Line& line, Wire& wire, Host& host, Operator& person, Random random);

    /// An event of kind next_fault.
    void cause_next();
    /// An event of kind fault_ends.
    void repair(Fault fault, std::uint64_t detail);
    /// All faults have happened, and all is repaired.
    [[nodiscard]] bool healed() const { return left_ == 0 && under_repair_ == 0; }
    /// Something that keeps records from the printer is, or was a moment ago.
    [[nodiscard]] bool excuses_underrun() const { return context_.now < excused_until_ || under_repair_ > 0; }

private:
    void schedule();
    /// The printer loses its memory and prints for somebody else between two runs: then its counter alone would have to
    /// tell whose prints they were. Known limit: the simulation lets only one of the two happen.
    [[nodiscard]] bool two_disasters(bool& this_one, bool other_one);
    [[nodiscard]] Fault draw();
    /// False if it cannot happen now.
    [[nodiscard]] bool cause(Fault fault);
    [[nodiscard]] bool cause_at_printer(Fault fault);
    [[nodiscard]] bool cause_at_host(Fault fault);
    [[nodiscard]] bool cause_on_the_way(Fault fault);
    [[nodiscard]] bool another_job();
    void ask_as_second_client();
    void repair_later(Fault fault, Duration low, Duration high, std::uint64_t detail = 0);
    void excuse_for(Duration duration);

    Context& context_;
    Judge& judge_;
    Line& line_;
    Wire& wire_;
    Host& host_;
    Operator& operator_;
    Random random_;
    std::uint32_t left_;
    std::uint32_t under_repair_ = 0;
    Instant excused_until_{};
    std::uint64_t interruption_ = 0; ///< starts of the program when the following were set
    bool memory_lost_ = false;
    bool others_printed_ = false;
};

} // namespace linefeed::simulation
