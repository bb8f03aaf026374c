// What goes wrong on the line and in transfers, ordered for the next occasion. Pure counting: no chance.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace linefeed::simulator {

/// One thing that can go wrong between printer and host.
enum class Trouble : std::uint8_t {
    lost_answer,        ///< a transmission of the printer does not arrive
    damaged_answer,     ///< one of its bytes arrives changed
    wrong_crc,          ///< the printer announces a wrong CRC
    refused_crc,        ///< the printer finds the CRC of a right frame wrong
    damaged_block,      ///< a file block is sent with a byte that its checksum does not cover
    refused_block,      ///< a good file block is asked for again
    cancelled_transfer, ///< the printer cancels a transfer at its next block
};
inline constexpr std::size_t trouble_count = 7;

/// How often each is still to happen.
class Troubles {
public:
    void add(Trouble trouble, std::uint32_t times) { waiting_[static_cast<std::size_t>(trouble)] += times; }
    /// Whether it happens now.
    [[nodiscard]] bool take(Trouble trouble) {
        std::uint32_t& waiting = waiting_[static_cast<std::size_t>(trouble)];
        if (waiting == 0) {
            return false;
        }
        --waiting;
        return true;
    }

private:
    std::array<std::uint32_t, trouble_count> waiting_{};
};

} // namespace linefeed::simulator
