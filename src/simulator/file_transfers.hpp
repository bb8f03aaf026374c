// File transfer and directories as the printer does them (protocol, section 8): one transfer each way for each client,
// a block at a time, each acknowledged.
#pragma once

#include "protocol/messages.hpp"
#include "simulator/file_system.hpp"
#include "simulator/printer_effects.hpp"
#include "simulator/troubles.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace linefeed::simulator {

/// How unreliable the transfer of blocks is.
struct BlockErrors {
    std::uint32_t percent = 0; ///< of the blocks sent that are damaged, and of those received that are asked for again
    std::uint64_t seed = 1;
};

/// Flow: take() each message of group `$`; what it returns goes back to the client, in order.
class FileTransfers {
public:
    FileTransfers(FileSystem files, BlockErrors errors)
        : files_(std::move(files))
        , errors_(errors) {}

    [[nodiscard]] std::vector<protocol::Message> take(ConnectionId client, const protocol::Message& message,
                                                      Troubles& troubles);
    /// The client is gone: its transfers are.
    void forget(ConnectionId client);
    /// Mains off: all transfers are.
    void clear();
    [[nodiscard]] const FileSystem& files() const { return files_; }
    [[nodiscard]] FileSystem& files() { return files_; }

private:
    using Replies = std::vector<protocol::Message>;

    /// The printer sends a file.
    struct Download {
        std::string bytes;
        std::uint32_t blocks = 0;
        std::uint32_t next = 1; ///< sent, not yet acknowledged
    };
    /// The printer receives a file.
    struct Upload {
        std::string path;
        std::string bytes;
        std::uint32_t blocks = 0;
        std::uint32_t taken = 0;
        std::optional<std::uint32_t> first{}; ///< number of the first block: 0 or 1, as the host counts
    };
    /// What the last block of an upload ended with. The client sends it again when that word gets lost.
    struct Ending {
        std::uint32_t block = 0;
        protocol::FileVerdict verdict = protocol::FileVerdict::ok;
    };
    struct Client {
        std::optional<Download> download;
        std::optional<Upload> upload;
        std::optional<Ending> ended_upload; ///< the last one, until another begins
    };

    void list(std::string_view path, Replies& out) const;
    void begin_download(Client& client, const std::string& path, Troubles& troubles, Replies& out);
    void send_block(const Download& download, Troubles& troubles, Replies& out);
    void acknowledged(Client& client, const protocol::FileAcknowledgement& acknowledgement, Troubles& troubles,
                      Replies& out);
    void begin_upload(Client& client, const protocol::FileHeader& header);
    void take_block(Client& client, const protocol::FileBlock& block, Troubles& troubles, Replies& out);
    static void take_block_after_end(const Client& client, const protocol::FileBlock& block, Replies& out);
    void ask_again(const Client& client, Replies& out) const;
    [[nodiscard]] bool block_fails();

    FileSystem files_;
    BlockErrors errors_;
    std::uint64_t drawn_ = 0; ///< blocks whose fate was drawn
    std::map<ConnectionId, Client> clients_;
};

} // namespace linefeed::simulator
