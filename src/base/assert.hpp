// What cannot happen is an assertion, checked in release builds too: a print server that goes on with a broken
// invariant prints a wrong serial number.
#pragma once

namespace linefeed {

/// Prints `expression` with its place to stderr and aborts.
[[noreturn]] void assertion_failed(const char* expression, const char* file, int line) noexcept;

} // namespace linefeed

/// Aborts the program when `expression` is false. Never compiled out.
#define LINEFEED_ASSERT(expression)                                                                                    \
    ((expression) ? static_cast<void>(0) : ::linefeed::assertion_failed(#expression, __FILE__, __LINE__))
