// Listings, checksums and words of the file transfer, see file_messages.hpp.
#include "protocol/file_messages.hpp"

#include "base/assert.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>

namespace linefeed::protocol {

bool DirectoryListing::add(DirectoryBlock block) {
    const std::size_t room = max_entries - entries_.size();
    const auto taken = static_cast<std::ptrdiff_t>(std::min(room, block.entries.size()));
    entries_.insert(entries_.end(), std::make_move_iterator(block.entries.begin()),
                    std::make_move_iterator(block.entries.begin() + taken));
    return block.last || entries_.size() == max_entries;
}

std::uint8_t file_checksum(std::string_view bytes) {
    return std::accumulate(bytes.begin(), bytes.end(), std::uint8_t{0}, [](std::uint8_t sum, char byte) {
        return static_cast<std::uint8_t>(sum + static_cast<unsigned char>(byte));
    });
}

FileBlock FileBlock::of(std::uint32_t number, std::string_view bytes) {
    LINEFEED_ASSERT(bytes.size() <= max_bytes);
    return {number, file_checksum(bytes), std::string{bytes}};
}

std::string_view to_string(FileVerdict verdict) {
    switch (verdict) {
    case FileVerdict::send_again:
        return "send again";
    case FileVerdict::ok:
        return "ok";
    case FileVerdict::cancel:
        return "cancel the transfer";
    }
    assertion_failed("FileVerdict", __FILE__, __LINE__);
}

} // namespace linefeed::protocol
