// Keeping and sorting, see lead_time_log.hpp.
#include "simulator/lead_time_log.hpp"

#include <algorithm>

namespace linefeed::simulator {

void LeadTimeLog::printed(Instant at, Duration lead) {
    if (++prints_ > first_fill_) {
        leads_.push_back(lead);
        sorted_ = false;
    }
    if (!first_print_) {
        first_print_ = at;
    }
    last_print_ = at;
}

void LeadTimeLog::missed(Instant at, Duration late, std::optional<Instant> arrival) {
    ++misses_;
    if (listed_.size() == max_listed) {
        return;
    }
    listed_.push_back({at, late, arrival ? std::optional{at - *arrival} : std::nullopt});
    waiting_ = arrival ? 0 : waiting_ + 1;
}

void LeadTimeLog::arrived(Instant now) {
    for (; waiting_ > 0; --waiting_) {
        Miss& miss = listed_[listed_.size() - waiting_];
        miss.lead = miss.at - now;
    }
}

void LeadTimeLog::late(Instant due, Instant at) {
    ++late_count_;
    if (late_.size() < max_listed) {
        late_.push_back({due, at});
    }
}

std::optional<Duration> LeadTimeLog::quantile(double share) {
    if (leads_.empty()) {
        return std::nullopt;
    }
    if (!sorted_) {
        std::sort(leads_.begin(), leads_.end());
        sorted_ = true;
    }
    const auto place = static_cast<std::size_t>(share * static_cast<double>(leads_.size()));
    return leads_[std::min(place, leads_.size() - 1)];
}

} // namespace linefeed::simulator
