#include "feeder/counter_proof.hpp"

namespace linefeed::feeder {

CounterProof::Result CounterProof::counted(std::optional<std::uint32_t> prints, std::uint64_t claimed,
                                           std::uint64_t sent, bool stop_would_show, Instant now) {
    next_ = now + interval;
    if (!prints || *prints == 0) {
        return Result::no_counter;
    }
    if (*prints > sent) {
        return Result::consistent;
    }
    prints_ = prints;
    reports_ = 0;
    stop_would_show_ = stop_would_show;
    if (*prints >= claimed) {
        behind_since_.reset();
        return Result::consistent;
    }
    if (!behind_since_) {
        behind_since_ = now;
    }
    return now - *behind_since_ >= patience ? Result::behind : Result::consistent;
}

bool CounterProof::reported(std::uint64_t claimed) {
    if (!prints_ || ++reports_ < 2) {
        return false;
    }
    const bool all = *prints_ >= claimed;
    prints_.reset();
    if (all && stop_would_show_ && claimed >= doubted_through_) {
        doubted_ = false;
    }
    return all;
}

} // namespace linefeed::feeder
