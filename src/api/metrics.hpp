// Figures for Prometheus. Those of printers, intake and ledger are taken from the service's core when they are asked
// for; those of HTTP are counted here. Labels are printers, folders, codes: never anything without bound.
#pragma once

#include "base/time.hpp"
#include "daemon/operations.hpp"

#include <memory>
#include <string>

namespace linefeed::api {

/// Any thread.
class Metrics {
public:
    Metrics();
    ~Metrics();
    Metrics(const Metrics&) = delete;
    Metrics& operator=(const Metrics&) = delete;

    /// Of an answered request.
    void count_request(int status, Duration took);
    void connection_opened();
    void connection_closed();

    /// Everything, in text format 0.0.4.
    [[nodiscard]] std::string text(daemon::Operations& operations) const;

private:
    struct Http;
    std::unique_ptr<Http> http_;
};

} // namespace linefeed::api
