// The error list and the event list, which the printer sends in blocks: `=EL =EV` (protocol, section 4), and the list
// put together from them.
#pragma once

#include "protocol/commands.hpp"
#include "protocol/machine_messages.hpp"
#include "protocol/printer_error.hpp"
#include "protocol/printer_time.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace linefeed::protocol {

/// `yy-mm-dd hh:mm:ss/errornumber`.
struct ErrorEntry {
    PrinterTime time{};
    PrinterError error{}; ///< real firmware pads the number with zeros to 8 digits (field notes)
    friend bool operator==(const ErrorEntry&, const ErrorEntry&) = default;
};

/// `yy-mm-dd hh:mm:ss/cp/ss/st/mr/pr/dp/ft/ms`.
struct EventEntry {
    PrinterTime time{};
    std::uint32_t compressor_pulses = 0; ///< in the last minute
    std::uint32_t solvent_sips = 0;      ///< the same
    std::uint32_t ink_sips = 0;          ///< the same
    std::uint32_t mixing_ratio = 0;      ///< sips of ink before solvent was added
    std::uint32_t pressure_mbar = 0;
    std::uint32_t diaphragm_position = 0; ///< 700…1400 is normal
    std::uint32_t fall_time_ms = 0;
    MachineState machine = MachineState::standby;
    friend bool operator==(const EventEntry&, const EventEntry&) = default;
};

/// One block of a list.
template <typename EntryType, Parameter code, std::size_t largest>
struct ListBlock {
    using Entry = EntryType;
    static constexpr Parameter list = code;
    static constexpr std::size_t max_entries = largest; ///< of a block

    std::uint32_t first = 1; ///< number of the first entry in the block, from 1
    std::uint32_t total = 0; ///< entries of the list
    std::vector<Entry> entries{};
    friend bool operator==(const ListBlock&, const ListBlock&) = default;
};

/// `=EL`, printer to host.
using ErrorListBlock = ListBlock<ErrorEntry, Parameter::EL, 32>;
/// `=EV`, printer to host.
using EventListBlock = ListBlock<EventEntry, Parameter::EV, 16>;

/// What a block did to the list being put together.
enum class ListProgress {
    needs_more,
    complete,
    broken, ///< the block does not continue the list: one was lost, or the list changed meanwhile. Ask again.
};

/// Flow: add() each block as it comes, until the list is complete or broken. A block that begins with entry 1 begins
/// anew.
template <typename Block>
class ListAssembly {
public:
    /// A printer that claims to have more is not believed.
    static constexpr std::uint32_t max_total = 4096;

    [[nodiscard]] ListProgress add(Block block) {
        if (block.first <= 1) {
            entries_.clear();
            total_ = block.total;
        }
        const bool continues = block.first == entries_.size() + 1 || (block.first == 0 && entries_.empty());
        if (!continues || block.total != total_ || total_ > max_total ||
            entries_.size() + block.entries.size() > total_) {
            total_ = 0;
            entries_.clear();
            return ListProgress::broken;
        }
        entries_.insert(entries_.end(), block.entries.begin(), block.entries.end());
        if (entries_.size() == total_) {
            return ListProgress::complete;
        }
        return block.entries.empty() ? ListProgress::broken : ListProgress::needs_more;
    }
    /// What has come so far, in order.
    [[nodiscard]] const std::vector<typename Block::Entry>& entries() const { return entries_; }

private:
    std::uint32_t total_ = 0;
    std::vector<typename Block::Entry> entries_;
};

/// The list in the blocks in which the printer sends it: at least one.
template <typename Block>
[[nodiscard]] std::vector<Block> to_blocks(const std::vector<typename Block::Entry>& entries) {
    std::vector<Block> blocks;
    std::size_t begin = 0;
    do {
        const std::size_t end = std::min(entries.size(), begin + Block::max_entries);
        blocks.push_back({static_cast<std::uint32_t>(begin + 1),
                          static_cast<std::uint32_t>(entries.size()),
                          {entries.begin() + static_cast<std::ptrdiff_t>(begin),
                           entries.begin() + static_cast<std::ptrdiff_t>(end)}});
        begin = end;
    } while (begin < entries.size());
    return blocks;
}

} // namespace linefeed::protocol
