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
    /// The line is free, before the operator enters the command: another host may have waited for that.
    void line_is_free();
    /// An event of kind fault_ends.
    void repair(Fault fault, std::uint64_t detail);
    /// All faults have happened, and all is repaired.
    [[nodiscard]] bool healed() const { return left_ == 0 && under_repair_ == 0; }
    /// Something that keeps records from the printer is, or was a moment ago.
    [[nodiscard]] bool excuses_underrun() const { return context_.now < excused_until_ || under_repair_ > 0; }

private:
    void schedule();
    [[nodiscard]] Fault draw();
    /// False if it cannot happen now.
    [[nodiscard]] bool cause(Fault fault);
    [[nodiscard]] bool cause_at_printer(Fault fault);
    [[nodiscard]] bool cause_by_others(Fault fault);
    [[nodiscard]] bool cause_at_host(Fault fault);
    [[nodiscard]] bool cause_on_the_way(Fault fault);
    void count(Fault fault);
    void stop_under_refill();
    void start_between_looks();
    [[nodiscard]] bool kill_under_fill();
    /// So many records later than the next, often none.
    void start_under_fill();
    [[nodiscard]] std::uint64_t some_records();
    [[nodiscard]] bool another_job();
    void ask_as_second_client();
    [[nodiscard]] std::uint64_t newest_in_printer();
    [[nodiscard]] bool gap_would_show();
    [[nodiscard]] bool memory_may_go();
    [[nodiscard]] bool foreign_flush();
    void flush();
    [[nodiscard]] std::uint64_t foreign_stop_point();
    [[nodiscard]] std::uint64_t foreign_number();
    void repair_later(Fault fault, Duration low, Duration high, std::uint64_t detail = 0);
    void excuse_for(Duration duration);
    [[nodiscard]] bool too_fast_for_a_hand(Fault fault);

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
    Instant stopped_at_{}; ///< by hand, to be started again
    Instant answers_late_until_{};
    bool job_waits_ = false; ///< another host has one to print
    bool gap_ = false;       ///< the printer may have gone on behind a gap that linefeed has not yet settled
};

} // namespace linefeed::simulation
