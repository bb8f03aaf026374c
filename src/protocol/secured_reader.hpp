// What the frames of the printer say in a secured transmission (protocol, section 6, CRC32): its words on our frames,
// and which of its own have come as it sent them.
#pragma once

#include "protocol/frame.hpp"
#include "protocol/secured_line.hpp"

#include <cstdint>
#include <optional>

namespace linefeed::protocol {

/// Flow: read() for each frame in the order in which they come, of one connection.
class SecuredReader {
public:
    enum class Word {
        announcement, ///< `=NR`, of the next frame; or an echo of ours
        right,        ///< `!OK`
        refused,      ///< `=FC`
        proven,       ///< a frame that was announced and is right
        standby,      ///< `=RS` of a printer in standby, which knows nothing of CRC32 there (section 1)
        damaged,      ///< announced, but not so
        bare,         ///< not announced: an echo (`!EM`), or the announcement was lost
    };

    /// `line` knows what was asked.
    [[nodiscard]] Word read(const Frame& frame, const SecuredLine& line);
    /// Answers have come, several and never secured: the printer is in standby, or knows no `=NR`.
    [[nodiscard]] bool unsecured() const { return bare_answers_ >= enough_bare_answers; }
    /// The printer is switched off: in standby it answers bare again.
    void forget();

private:
    static constexpr int enough_bare_answers = 3; ///< one may have lost its announcement

    std::optional<std::uint32_t> announced_; ///< of the next frame
    bool secured_once_ = false;              ///< the printer has shown that it knows CRC32
    int bare_answers_ = 0;                   ///< before that
};

} // namespace linefeed::protocol
