// Ctrl-C and SIGTERM as a fact to ask for, instead of an interruption: the line has to be stopped in order.
#pragma once

namespace linefeed::cli {

/// Construct before any thread starts: SIGINT, SIGTERM, SIGHUP, SIGQUIT and SIGTSTP are blocked from then on, in
/// threads to come as well, and SIGPIPE is ignored.
class SignalWatch {
public:
    SignalWatch();
    ~SignalWatch();
    SignalWatch(const SignalWatch&) = delete;
    SignalWatch& operator=(const SignalWatch&) = delete;

    /// How many of the signals have come since the last call.
    [[nodiscard]] int take();
    /// Readable when take() would give some.
    [[nodiscard]] int descriptor() const { return descriptor_; }

private:
    int descriptor_ = -1;
};

} // namespace linefeed::cli
