// The printer's outputs under the host's hand: `=CO` (protocol, section 4).
#pragma once

#include "protocol/signal_messages.hpp"

#include <array>
#include <cstddef>
#include <optional>

namespace linefeed::simulator {

/// Which outputs the host has set. While it is in control, the printer raises no signals of its own.
class OutputControl {
public:
    static constexpr std::size_t outputs = protocol::OutputConfiguration::max_outputs;

    void change(const protocol::OutputChange& change) {
        if (!change.is_control()) {
            host_controls_ = true;
            set_[change.output - 1] = change.on;
        } else if (change.on) {
            host_controls_ = true;
        } else {
            clear();
        }
    }
    /// The printer controls them again, and all changes are undone.
    void clear() {
        host_controls_ = false;
        set_ = {};
    }
    [[nodiscard]] bool host_controls() const { return host_controls_; }
    /// What the host has set output 1…8 to; none: nothing.
    [[nodiscard]] std::optional<bool> set(std::size_t output) const { return set_[output - 1]; }

private:
    bool host_controls_ = false;
    std::array<std::optional<bool>, outputs> set_{};
};

} // namespace linefeed::simulator
