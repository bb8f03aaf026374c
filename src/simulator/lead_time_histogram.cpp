// Buckets of lead times, see lead_time_histogram.hpp.
#include "simulator/lead_time_histogram.hpp"

#include "base/assert.hpp"

#include <algorithm>

namespace linefeed::simulator {

void LeadTimeHistogram::add(Duration lead) {
    LINEFEED_ASSERT(lead >= Duration::zero());
    const auto above = std::upper_bound(borders.begin(), borders.end(), lead);
    ++counts_[static_cast<std::size_t>(above - borders.begin()) - 1];
    smallest_ = std::min(smallest_.value_or(lead), lead);
}

} // namespace linefeed::simulator
