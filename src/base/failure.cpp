#include "base/failure.hpp"

#include "base/assert.hpp"

#include <stdexcept>

namespace linefeed {

void throw_exception_from_error(const Failure& failure, const boost::source_location&) {
    throw std::runtime_error(failure.message);
}

std::string_view to_string(FailureKind kind) {
    switch (kind) {
    case FailureKind::usage:
        return "usage";
    case FailureKind::unreachable:
        return "unreachable";
    case FailureKind::stopped:
        return "stopped";
    case FailureKind::input:
        return "input";
    case FailureKind::in_doubt:
        return "in_doubt";
    case FailureKind::storage:
        return "storage";
    case FailureKind::internal:
        return "internal";
    }
    assertion_failed("FailureKind", __FILE__, __LINE__);
}

} // namespace linefeed
