// What goes wrong in a run of the simulator, and when: ordered on the command line one by one, or as a scenario file. A
// line of either is `WHEN WHAT`, for example `print 100 error 12113` or `time 2.5 cover open`.
#pragma once

#include "base/failure.hpp"
#include "base/time.hpp"
#include "protocol/commands.hpp"
#include "protocol/signal_messages.hpp"
#include "simulator/troubles.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace linefeed::simulator {

/// The operator at the panel presses a key (`start`, `stop`, `open-nozzle`, `close-nozzle`, `acknowledge`, `power-on`,
/// `power-off`).
struct PressKey {
    protocol::Action action = protocol::Action::stop_print;
};
/// `error CODE`: an error stops the printing.
struct RaiseError {
    std::uint32_t code = 0; ///< 1…0x01FFFFFF
};
/// `cover open`, `cover closed`.
struct MoveCover {
    bool open = true;
};
/// `job PATH`: the operator loads another job.
struct LoadJob {
    std::string path;
};
/// `input CONTACT on`, `input CONTACT off`.
struct SetInput {
    protocol::Input input = protocol::Input::x4_9;
    bool on = true;
};
/// `stick out`, `stick in`: the USB stick.
struct MoveStick {
    bool present = false;
};
/// `cut`: all connections are closed.
struct CutConnections {};
/// `mute`, `unmute`: from now on nothing is answered, or everything again.
struct Mute {
    bool muted = true;
};
/// `power-cycle`: mains off and on.
struct PowerCycle {};
/// `lose-answer [TIMES]`, `damage-answer`, `wrong-crc`, `refuse-crc`, `damage-block`, `refuse-block`,
/// `cancel-transfer`: at the next occasions.
struct ExpectTrouble {
    Trouble trouble = Trouble::lost_answer;
    std::uint32_t times = 1;
};

using Deed = std::variant<PressKey, RaiseError, MoveCover, LoadJob, SetInput, MoveStick, CutConnections, Mute,
                          PowerCycle, ExpectTrouble>;

/// When it happens: at the first of what is counted that reaches the number.
struct Moment {
    enum class Unit : std::uint8_t {
        print, ///< products printed in this run, from 1
        frame, ///< frames received in this run, from 1
        time,  ///< since the start
    };
    Unit unit = Unit::print;
    std::uint64_t count = 0;
    Duration time{};
};

/// One of them.
struct Fault {
    Moment when;
    Deed what;
};

/// Reads `WHEN WHAT`. The failure says what was expected.
[[nodiscard]] Result<Fault> parse_fault(std::string_view text);
/// Reads a scenario: a fault a line, blank lines and those that begin with # left out. The failure names the line.
[[nodiscard]] Result<std::vector<Fault>> parse_scenario(std::string_view text);
/// What parse_fault() understands, a line each: for help texts.
[[nodiscard]] std::string_view fault_help();

} // namespace linefeed::simulator
