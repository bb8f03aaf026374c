// The figures of the service's core as metric families: names, units and help texts.
#pragma once

#include "daemon/operations.hpp"

#include <prometheus/metric_family.h>
#include <vector>

namespace linefeed::api {

using Families = std::vector<prometheus::MetricFamily>;

[[nodiscard]] Families service_families(daemon::Operations& operations);

} // namespace linefeed::api
