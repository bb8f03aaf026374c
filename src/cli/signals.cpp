#include "cli/signals.hpp"

#include "base/assert.hpp"

#include <csignal>
#include <sys/signalfd.h>
#include <unistd.h>

namespace linefeed::cli {

SignalWatch::SignalWatch() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    sigaddset(&signals, SIGHUP);
    sigaddset(&signals, SIGQUIT);
    sigaddset(&signals, SIGTSTP); // a suspended host lets the line run dry
    ::signal(SIGPIPE, SIG_IGN);   // whoever reads the messages may go away; the line goes on
    LINEFEED_ASSERT(pthread_sigmask(SIG_BLOCK, &signals, nullptr) == 0);
    descriptor_ = signalfd(-1, &signals, SFD_NONBLOCK | SFD_CLOEXEC);
    LINEFEED_ASSERT(descriptor_ >= 0);
}

SignalWatch::~SignalWatch() {
    ::close(descriptor_);
}

int SignalWatch::take() {
    int count = 0;
    signalfd_siginfo info{};
    while (::read(descriptor_, &info, sizeof info) == static_cast<ssize_t>(sizeof info)) {
        ++count;
    }
    return count;
}

} // namespace linefeed::cli
