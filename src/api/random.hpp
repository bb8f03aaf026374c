// Random text that nobody can guess.
#pragma once

#include <cstddef>
#include <string>

namespace linefeed::api {

/// So many random bytes of the operating system, in hex.
[[nodiscard]] std::string random_hex(std::size_t bytes);

} // namespace linefeed::api
