// File transfer and directories: `$DF $DI $FA $FH $FT $RD $RF` (protocol, section 8).
#pragma once

#include "protocol/commands.hpp"
#include "protocol/limits.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::protocol {

/// `$RD`, host to printer: what is at this path? `*` is a joker. Answered by `$DI`.
struct DirectoryRequest {
    static constexpr FileCommand command = FileCommand::RD;
    static constexpr bool has_text = true;
    std::string path{};

    static void describe(auto& visitor, auto& self) { visitor.text("path", self.path); }
    friend bool operator==(const DirectoryRequest&, const DirectoryRequest&) = default;
};

/// An entry of a directory; one that is a directory itself is sent with a `!` before its name.
struct DirectoryEntry {
    std::string name{};
    bool is_directory = false;
    friend bool operator==(const DirectoryEntry&, const DirectoryEntry&) = default;
};

/// `$DI`, printer to host: a block of up to 32 entries. The last block without entries (`$DI1 00`) and no block before
/// it: what was asked for does not exist.
struct DirectoryBlock {
    static constexpr std::size_t max_entries = 32;
    bool last = true;
    std::vector<DirectoryEntry> entries{};
    friend bool operator==(const DirectoryBlock&, const DirectoryBlock&) = default;
};

/// Flow: add() each block until it says that the listing is complete.
class DirectoryListing {
public:
    /// A printer that sends more in one answer is not believed.
    static constexpr std::size_t max_entries = 65536;

    /// True when the block was the last, or the listing is full.
    [[nodiscard]] bool add(DirectoryBlock block);
    [[nodiscard]] const std::vector<DirectoryEntry>& entries() const { return entries_; }

private:
    std::vector<DirectoryEntry> entries_;
};

/// `$DF`, host to printer: delete this file. The printer deletes from its default directories only, and does not
/// answer.
struct FileDeletion {
    static constexpr FileCommand command = FileCommand::DF;
    static constexpr bool has_text = true;
    std::string path{};

    static void describe(auto& visitor, auto& self) { visitor.text("path", self.path); }
    friend bool operator==(const FileDeletion&, const FileDeletion&) = default;
};

/// `$RF`, host to printer: send me this file. Answered by `$FH` and `$FT`.
struct FileRequest {
    static constexpr FileCommand command = FileCommand::RF;
    static constexpr bool has_text = true;
    std::string path{};

    static void describe(auto& visitor, auto& self) { visitor.text("path", self.path); }
    friend bool operator==(const FileRequest&, const FileRequest&) = default;
};

/// `$FH`, both ways: a file of so many blocks follows. 0 blocks: it cannot be opened; a missing and an empty file
/// answer alike. Not acknowledged.
struct FileHeader {
    static constexpr FileCommand command = FileCommand::FH;
    static constexpr bool has_text = true;
    std::string path{}; ///< on the machine
    std::uint32_t blocks = 0;

    static void describe(auto& visitor, auto& self) {
        visitor.text("path", self.path);
        visitor.number("blocks", "a number of blocks", self.blocks);
    }
    friend bool operator==(const FileHeader&, const FileHeader&) = default;
};

/// The sum of the bytes modulo 256.
[[nodiscard]] std::uint8_t file_checksum(std::string_view bytes);

/// `$FT`, both ways: a block of a file. One without content makes an empty file.
struct FileBlock {
    static constexpr std::size_t max_bytes = 2048;
    std::uint32_t number = 0;
    std::uint8_t checksum = 0; ///< as sent
    std::string bytes{};

    /// The block with the checksum of its bytes. Precondition: at most max_bytes.
    [[nodiscard]] static FileBlock of(std::uint32_t number, std::string_view bytes);
    /// The checksum is that of the bytes.
    [[nodiscard]] bool intact() const { return checksum == file_checksum(bytes); }
    friend bool operator==(const FileBlock&, const FileBlock&) = default;
};

/// FA, parameter 2.
enum class FileVerdict : std::uint32_t {
    send_again = 0,
    ok = 1,
    cancel = 2, ///< the whole transfer
};

/// `$FA`, both ways: the receiver's word about a block.
struct FileAcknowledgement {
    static constexpr FileCommand command = FileCommand::FA;
    std::uint32_t number = 0;
    FileVerdict verdict = FileVerdict::ok;

    static void describe(auto& visitor, auto& self) {
        visitor.number("block", "a block number", self.number);
        visitor.number("verdict", "0, 1 or 2", self.verdict, Limits{0, 2});
    }
    friend bool operator==(const FileAcknowledgement&, const FileAcknowledgement&) = default;
};

/// Words for people, e.g. "send again".
[[nodiscard]] std::string_view to_string(FileVerdict verdict);

} // namespace linefeed::protocol
