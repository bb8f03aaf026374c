#include "api/metrics.hpp"

#include "api/families.hpp"

#include <chrono>
#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>

namespace linefeed::api {

/// What is counted here.
struct Metrics::Http {
    prometheus::Registry registry;
    prometheus::Family<prometheus::Counter>& requests = prometheus::BuildCounter()
                                                            .Name("linefeed_http_requests_total")
                                                            .Help("Answered requests by status code.")
                                                            .Register(registry);
    prometheus::Histogram& seconds =
        prometheus::BuildHistogram()
            .Name("linefeed_http_request_seconds")
            .Help("From the first byte of a request to the last of its answer; without event streams.")
            .Register(registry)
            .Add({}, prometheus::Histogram::BucketBoundaries{0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1,
                                                             2.5, 5, 10, 30});
    prometheus::Gauge& connections = prometheus::BuildGauge()
                                         .Name("linefeed_http_connections")
                                         .Help("Open connections, over TCP and the Unix socket.")
                                         .Register(registry)
                                         .Add({});
};

Metrics::Metrics()
    : http_(std::make_unique<Http>()) {}

Metrics::~Metrics() = default;

void Metrics::count_request(int status, Duration took) {
    http_->requests.Add({{"code", std::to_string(status)}}).Increment();
    http_->seconds.Observe(std::chrono::duration<double>(took).count());
}

void Metrics::connection_opened() {
    http_->connections.Increment();
}

void Metrics::connection_closed() {
    http_->connections.Decrement();
}

std::string Metrics::text(daemon::Operations& operations) const {
    Families families = service_families(operations);
    for (prometheus::MetricFamily& family : http_->registry.Collect()) {
        families.push_back(std::move(family));
    }
    return prometheus::TextSerializer{}.Serialize(families);
}

} // namespace linefeed::api
