// Carries an admitted request out: at most once for its key, and whatever goes wrong comes back as a problem.
#pragma once

#include "api/admission.hpp"
#include "api/exchange.hpp"
#include "api/idempotency.hpp"
#include "spool/checksum.hpp"

#include <string>

namespace linefeed::api {

/// Any thread of the request's lane.
class Dispatcher {
public:
    Dispatcher(daemon::Operations& operations, Metrics& metrics)
        : services_{operations, metrics}
        , keyed_(operations) {}

    /// `body` is the SHA-256 of the request's body. Blocks as long as the operation takes.
    [[nodiscard]] Answer carry_out(const Admitted& admitted, const spool::Sha256Digest& body);

private:
    [[nodiscard]] Outcome outcome(const Admitted& admitted, const spool::Sha256Digest& body);

    Services services_;
    KeyedAnswers keyed_;
};

} // namespace linefeed::api
