#include "watched_calls.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

extern "C" {
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* memory, size_t size);
void* __libc_memalign(size_t alignment, size_t size);
void __libc_free(void* memory);
}

namespace linefeed::realtime {

namespace {

constexpr std::size_t stacks_kept = 8;
constexpr std::size_t stack_depth = 24;
struct Stack {
    Call call = Call::allocate;
    std::array<void*, stack_depth> frames{};
    int size = 0;
};

std::atomic<bool> watching{false};
std::array<std::atomic<std::uint64_t>, call_kinds> forbidden{};
std::atomic<std::uint64_t> sends{0};
std::atomic<std::uint64_t> receives{0};
std::array<Stack, stacks_kept> stacks;
std::atomic<std::size_t> stacks_size{0};

thread_local bool exempt = false;
thread_local bool sender = false;
thread_local bool noting = false; ///< what the noting itself calls does not count

bool watched() {
    return sender && watching.load(std::memory_order_relaxed) && !noting;
}

void note(Call call) {
    if (!watched()) {
        return;
    }
    noting = true;
    const int error = errno;
    ++forbidden[static_cast<std::size_t>(call)];
    if (const std::size_t index = stacks_size++; index < stacks_kept) {
        stacks[index].call = call;
        stacks[index].size = ::backtrace(stacks[index].frames.data(), stack_depth);
    }
    errno = error;
    noting = false;
}

/// Sockets, and eventfd, timerfd and epoll, which have no type.
bool is_file(int descriptor) {
    struct stat status {};
    return ::fstat(descriptor, &status) != 0 || ((status.st_mode & S_IFMT) != 0 && !S_ISSOCK(status.st_mode));
}

void note_file(int descriptor) {
    if (watched() && is_file(descriptor)) {
        note(Call::file);
    }
}

void note_send() {
    sender = !exempt;
    if (watched()) {
        ++sends;
    }
}

void note_receive() {
    if (watched()) {
        ++receives;
    }
}

/// The C library's function of that name.
template <typename Function>
Function* real(std::atomic<void*>& found, const char* name) {
    void* function = found.load(std::memory_order_relaxed);
    if (function == nullptr) {
        function = ::dlsym(RTLD_NEXT, name);
        found.store(function, std::memory_order_relaxed);
    }
    return reinterpret_cast<Function*>(function);
}

} // namespace

const char* to_string(Call call) {
    switch (call) {
    case Call::allocate:
        return "allocation";
    case Call::release:
        return "release of memory";
    case Call::lock:
        return "lock";
    case Call::file:
        return "file access";
    case Call::memory:
        return "mapping of memory";
    case Call::sleep:
        return "sleep";
    }
    std::abort();
}

void exempt_this_thread() {
    exempt = true;
    sender = false;
}

void watch(bool on) {
    std::array<void*, 1> frame{};
    ::backtrace(frame.data(), 1); // the first call loads a library
    watching = on;
}

CallCounts counts() {
    CallCounts counts;
    for (std::size_t i = 0; i < call_kinds; ++i) {
        counts.forbidden[i] = forbidden[i];
    }
    counts.sends = sends;
    counts.receives = receives;
    return counts;
}

std::string first_stacks() {
    std::string text;
    for (std::size_t i = 0; i < std::min(stacks_size.load(), stacks_kept); ++i) {
        text += std::string{to_string(stacks[i].call)} + " at\n";
        char** const symbols = ::backtrace_symbols(stacks[i].frames.data(), stacks[i].size);
        for (int frame = 0; frame < stacks[i].size; ++frame) {
            text += std::string{"    "} + symbols[frame] + '\n';
        }
        std::free(static_cast<void*>(symbols));
    }
    return text;
}

} // namespace linefeed::realtime

using namespace linefeed::realtime;

// Each as the C library has it, but counted. What the C library calls of itself inside does not come by here.
#define LINEFEED_WATCHED_LOCK(name, parameters, arguments)                                                             \
    int name parameters noexcept(true) {                                                                               \
        static std::atomic<void*> found{nullptr};                                                                      \
        note(Call::lock);                                                                                              \
        return real<int parameters>(found, #name) arguments;                                                           \
    }
#define LINEFEED_WATCHED_WAIT(name, parameters, arguments)                                                             \
    int name parameters {                                                                                              \
        static std::atomic<void*> found{nullptr};                                                                      \
        note(Call::lock);                                                                                              \
        return real<int parameters>(found, #name) arguments;                                                           \
    }

extern "C" {

void* malloc(size_t size) noexcept {
    note(Call::allocate);
    return __libc_malloc(size);
}
void* calloc(size_t count, size_t size) noexcept {
    note(Call::allocate);
    return __libc_calloc(count, size);
}
void* realloc(void* memory, size_t size) noexcept {
    note(Call::allocate);
    return __libc_realloc(memory, size);
}
void* memalign(size_t alignment, size_t size) noexcept {
    note(Call::allocate);
    return __libc_memalign(alignment, size);
}
void* aligned_alloc(size_t alignment, size_t size) noexcept {
    note(Call::allocate);
    return __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, size_t alignment, size_t size) noexcept {
    note(Call::allocate);
    *memory = __libc_memalign(alignment, size);
    return *memory == nullptr ? ENOMEM : 0;
}
void free(void* memory) noexcept {
    if (memory != nullptr) {
        note(Call::release);
    }
    __libc_free(memory);
}

LINEFEED_WATCHED_LOCK(pthread_mutex_lock, (pthread_mutex_t * mutex), (mutex))
LINEFEED_WATCHED_LOCK(pthread_mutex_trylock, (pthread_mutex_t * mutex), (mutex))
LINEFEED_WATCHED_LOCK(pthread_rwlock_rdlock, (pthread_rwlock_t * lock), (lock))
LINEFEED_WATCHED_LOCK(pthread_rwlock_wrlock, (pthread_rwlock_t * lock), (lock))
LINEFEED_WATCHED_LOCK(pthread_cond_signal, (pthread_cond_t * condition), (condition))
LINEFEED_WATCHED_LOCK(pthread_cond_broadcast, (pthread_cond_t * condition), (condition))
LINEFEED_WATCHED_LOCK(sem_post, (sem_t * semaphore), (semaphore))
LINEFEED_WATCHED_WAIT(pthread_cond_wait, (pthread_cond_t * condition, pthread_mutex_t* mutex), (condition, mutex))
LINEFEED_WATCHED_WAIT(sem_wait, (sem_t * semaphore), (semaphore))

int open(const char* path, int flags, ...) {
    note(Call::file);
    va_list more;
    va_start(more, flags);
    const auto mode = va_arg(more, mode_t);
    va_end(more);
    return static_cast<int>(::syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}
int open64(const char* path, int flags, ...) __attribute__((alias("open")));
int close(int descriptor) {
    note_file(descriptor);
    return static_cast<int>(::syscall(SYS_close, descriptor));
}
int fsync(int descriptor) {
    note(Call::file);
    return static_cast<int>(::syscall(SYS_fsync, descriptor));
}
int fdatasync(int descriptor) {
    note(Call::file);
    return static_cast<int>(::syscall(SYS_fdatasync, descriptor));
}
ssize_t write(int descriptor, const void* data, size_t size) {
    note_file(descriptor);
    return ::syscall(SYS_write, descriptor, data, size);
}
ssize_t writev(int descriptor, const iovec* pieces, int count) {
    note_file(descriptor);
    return ::syscall(SYS_writev, descriptor, pieces, count);
}
ssize_t read(int descriptor, void* data, size_t size) {
    note_file(descriptor);
    return ::syscall(SYS_read, descriptor, data, size);
}
ssize_t pwrite64(int descriptor, const void* data, size_t size, off64_t offset) {
    note(Call::file);
    return ::syscall(SYS_pwrite64, descriptor, data, size, offset);
}
ssize_t pread64(int descriptor, void* data, size_t size, off64_t offset) {
    note(Call::file);
    return ::syscall(SYS_pread64, descriptor, data, size, offset);
}

void* mmap(void* address, size_t size, int protection, int flags, int descriptor, off_t offset) noexcept {
    note(Call::memory);
    return reinterpret_cast<void*>(::syscall(SYS_mmap, address, size, protection, flags, descriptor, offset));
}
int munmap(void* address, size_t size) noexcept {
    note(Call::memory);
    return static_cast<int>(::syscall(SYS_munmap, address, size));
}

int nanosleep(const timespec* wanted, timespec* left) {
    note(Call::sleep);
    return static_cast<int>(::syscall(SYS_nanosleep, wanted, left));
}
int clock_nanosleep(clockid_t clock, int flags, const timespec* wanted, timespec* left) {
    note(Call::sleep);
    return ::syscall(SYS_clock_nanosleep, clock, flags, wanted, left) == 0 ? 0 : errno;
}

ssize_t sendmsg(int descriptor, const msghdr* message, int flags) {
    note_send();
    return ::syscall(SYS_sendmsg, descriptor, message, flags);
}
ssize_t send(int descriptor, const void* data, size_t size, int flags) {
    note_send();
    return ::syscall(SYS_sendto, descriptor, data, size, flags, nullptr, 0);
}
ssize_t recvmsg(int descriptor, msghdr* message, int flags) {
    note_receive();
    return ::syscall(SYS_recvmsg, descriptor, message, flags);
}
ssize_t recv(int descriptor, void* data, size_t size, int flags) {
    note_receive();
    return ::syscall(SYS_recvfrom, descriptor, data, size, flags, nullptr, nullptr);
}

} // extern "C"
