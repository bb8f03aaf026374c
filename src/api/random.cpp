#include "api/random.hpp"

#include "base/assert.hpp"
#include "spool/checksum.hpp"

#include <sys/random.h>

namespace linefeed::api {

std::string random_hex(std::size_t bytes) {
    constexpr std::size_t never_interrupted = 256; // getrandom(2): up to so many come whole
    LINEFEED_ASSERT(bytes <= never_interrupted);
    std::string random(bytes, '\0');
    LINEFEED_ASSERT(::getrandom(random.data(), random.size(), 0) == static_cast<ssize_t>(bytes));
    return spool::to_hex(random);
}

} // namespace linefeed::api
