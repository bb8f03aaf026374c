// A request that comes twice is carried out once. Who has lost an answer asks again with the same key, and is given the
// same answer.
#pragma once

#include "api/exchange.hpp"

#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

namespace linefeed::api {

/// Any thread. What is begun is remembered durably before it is carried out: found again after a crash, nobody knows
/// how far it has come, and it is not carried out blindly a second time.
class KeyedAnswers {
public:
    explicit KeyedAnswers(daemon::Operations& operations)
        : operations_(operations) {}

    struct Request {
        daemon::Caller caller;
        std::string key;
        std::string hash;
        /// A stop: carried out whatever the disk does, and again where nobody knows how far it came.
        bool harmless_twice = false;
    };

    /// The answer given before, or that of `carry_out`. Final answers are remembered, failures of the service or of a
    /// printer (5xx) are not: these may be tried again with the same key.
    [[nodiscard]] Outcome answer(const Request& request, const std::function<Outcome()>& carry_out);

private:
    using Id = std::pair<std::string, std::string>; ///< caller and key
    class InFlight;

    [[nodiscard]] Checked<std::optional<Answer>> given_before(const Request& request);

    daemon::Operations& operations_;
    std::mutex mutex_;
    std::map<Id, std::string> in_flight_; ///< with the hash of the request; guarded by mutex_
};

} // namespace linefeed::api
