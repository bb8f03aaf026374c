#include "daemon/real_time.hpp"

#include <array>
#include <cstring>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

namespace linefeed::daemon {

namespace {

/// More than the feed thread ever uses.
constexpr std::size_t stack_bytes = 128 * 1024;

/// Touches the stack, so that its pages are there (and locked) before the first refill.
[[gnu::noinline]] void prefault_stack() {
    std::array<char, stack_bytes> stack;
    std::memset(stack.data(), 1, stack.size());
    asm volatile("" : : "g"(stack.data()) : "memory"); // or the compiler would leave it out
}

void add(std::string& line, const std::string& what, int error, const char* remedy) {
    line += line.empty() ? "feed thread: " : ", ";
    line += what + (error == 0 ? " granted" : " refused (" + std::string{std::strerror(error)} + "; " + remedy + ")");
}

int schedule(int priority) {
    sched_param parameters{};
    parameters.sched_priority = priority;
    return ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters);
}

int bind_to(int processor) {
    cpu_set_t processors;
    CPU_ZERO(&processors);
    if (processor < 0 || processor >= CPU_SETSIZE) {
        return EINVAL;
    }
    CPU_SET(static_cast<std::size_t>(processor), &processors);
    return ::pthread_setaffinity_np(::pthread_self(), sizeof processors, &processors);
}

int lock_memory() {
    if (::mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
        return errno;
    }
    prefault_stack();
    return 0;
}

} // namespace

std::string make_real_time(const RealTimeSettings& settings) {
    std::string line;
    if (settings.lock_memory) {
        add(line, "locked memory", lock_memory(), "raise LimitMEMLOCK");
    }
    if (settings.processor) {
        add(line, "processor " + std::to_string(*settings.processor), bind_to(*settings.processor),
            "choose one of those that nproc counts");
    }
    if (settings.priority) {
        add(line, "SCHED_FIFO priority " + std::to_string(*settings.priority), schedule(*settings.priority),
            "raise LimitRTPRIO");
    }
    return line;
}

} // namespace linefeed::daemon
