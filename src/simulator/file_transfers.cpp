// One block at a time, see file_transfers.hpp.
#include "simulator/file_transfers.hpp"

#include "simulator/random_draw.hpp"

#include <algorithm>
#include <utility>

namespace linefeed::simulator {
namespace {

using protocol::DirectoryBlock;
using protocol::FileAcknowledgement;
using protocol::FileBlock;
using protocol::FileHeader;
using protocol::FileVerdict;
using protocol::Message;

constexpr std::uint64_t percent = 100;
/// A host that announces more sends no file that a printer could hold.
constexpr std::uint32_t max_blocks = 16384;

std::uint32_t blocks_of(std::size_t bytes) {
    return static_cast<std::uint32_t>((bytes + FileBlock::max_bytes - 1) / FileBlock::max_bytes);
}

} // namespace

std::vector<Message> FileTransfers::take(ConnectionId id, const Message& message, Troubles& troubles) {
    Replies out;
    Client& client = clients_[id];
    if (const auto* request = std::get_if<protocol::DirectoryRequest>(&message)) {
        list(request->path, out);
    } else if (const auto* deletion = std::get_if<protocol::FileDeletion>(&message)) {
        files_.remove(deletion->path);
    } else if (const auto* wanted = std::get_if<protocol::FileRequest>(&message)) {
        begin_download(client, wanted->path, troubles, out);
    } else if (const auto* header = std::get_if<FileHeader>(&message)) {
        begin_upload(client, *header);
    } else if (const auto* block = std::get_if<FileBlock>(&message)) {
        take_block(client, *block, troubles, out);
    } else if (const auto* acknowledgement = std::get_if<FileAcknowledgement>(&message)) {
        acknowledged(client, *acknowledgement, troubles, out);
    } else if (const auto* malformed = std::get_if<protocol::MalformedMessage>(&message)) {
        if (malformed->payload.starts_with("FT")) {
            ask_again(client, out);
        }
    }
    if (!client.download && !client.upload && !client.ended_upload) {
        clients_.erase(id);
    }
    return out;
}

void FileTransfers::forget(ConnectionId client) {
    clients_.erase(client);
}

void FileTransfers::clear() {
    clients_.clear();
}

void FileTransfers::list(std::string_view path, Replies& out) const {
    const auto entries = files_.list(path);
    std::size_t begin = 0;
    do {
        const std::size_t end = std::min(entries.size(), begin + DirectoryBlock::max_entries);
        out.emplace_back(DirectoryBlock{end == entries.size(),
                                        {entries.begin() + static_cast<std::ptrdiff_t>(begin),
                                         entries.begin() + static_cast<std::ptrdiff_t>(end)}});
        begin = end;
    } while (begin < entries.size());
}

/// A missing and an empty file answer alike.
void FileTransfers::begin_download(Client& client, const std::string& path, Troubles& troubles, Replies& out) {
    const std::string* const bytes = files_.read(path);
    client.download.reset();
    if (bytes == nullptr || bytes->empty()) {
        out.emplace_back(FileHeader{path, 0});
        return;
    }
    client.download = Download{*bytes, blocks_of(bytes->size()), 1};
    out.emplace_back(FileHeader{path, client.download->blocks});
    send_block(*client.download, troubles, out);
}

void FileTransfers::send_block(const Download& download, Troubles& troubles, Replies& out) {
    const std::size_t begin = (download.next - 1) * FileBlock::max_bytes;
    FileBlock block =
        FileBlock::of(download.next, std::string_view{download.bytes}.substr(begin, FileBlock::max_bytes));
    if (troubles.take(Trouble::damaged_block) || block_fails()) {
        block.bytes.front() = static_cast<char>(block.bytes.front() ^ 1);
    }
    out.emplace_back(std::move(block));
}

void FileTransfers::acknowledged(Client& client, const FileAcknowledgement& acknowledgement, Troubles& troubles,
                                 Replies& out) {
    if (acknowledgement.verdict == FileVerdict::cancel) {
        client.download.reset();
        client.upload.reset();
        return;
    }
    if (!client.download || acknowledgement.number != client.download->next) {
        return; // of a block that is not under way: an acknowledgement that came twice
    }
    if (troubles.take(Trouble::cancelled_transfer)) {
        out.emplace_back(FileAcknowledgement{client.download->next, FileVerdict::cancel});
        client.download.reset();
        return;
    }
    if (acknowledgement.verdict == FileVerdict::ok && client.download->next++ == client.download->blocks) {
        client.download.reset();
        return;
    }
    send_block(*client.download, troubles, out);
}

/// The header is not acknowledged; a new one begins anew.
void FileTransfers::begin_upload(Client& client, const FileHeader& header) {
    client.upload.reset();
    client.ended_upload.reset();
    if (header.blocks > 0) {
        client.upload = Upload{header.path, {}, header.blocks, 0, {}};
    }
}

void FileTransfers::take_block(Client& client, const FileBlock& block, Troubles& troubles, Replies& out) {
    if (!client.upload) {
        take_block_after_end(client, block, out);
        return;
    }
    Upload& upload = *client.upload;
    if (troubles.take(Trouble::cancelled_transfer) || upload.blocks > max_blocks) {
        client.upload.reset();
        out.emplace_back(FileAcknowledgement{block.number, FileVerdict::cancel});
        return;
    }
    if (!block.intact() || troubles.take(Trouble::refused_block) || block_fails()) {
        out.emplace_back(FileAcknowledgement{block.number, FileVerdict::send_again});
        return;
    }
    if (!upload.first && block.number <= 1) {
        upload.first = block.number;
    }
    const std::uint32_t expected = upload.first.value_or(1) + upload.taken;
    if (upload.taken > 0 && block.number + 1 == expected) {
        out.emplace_back(FileAcknowledgement{block.number, FileVerdict::ok}); // again, because the first word was lost
        return;
    }
    if (block.number != expected) {
        out.emplace_back(FileAcknowledgement{expected, FileVerdict::send_again});
        return;
    }
    upload.bytes += block.bytes;
    if (++upload.taken < upload.blocks) {
        out.emplace_back(FileAcknowledgement{block.number, FileVerdict::ok});
        return;
    }
    const bool written = files_.write(upload.path, std::move(upload.bytes));
    client.upload.reset();
    client.ended_upload = Ending{block.number, written ? FileVerdict::ok : FileVerdict::cancel};
    out.emplace_back(FileAcknowledgement{block.number, client.ended_upload->verdict});
}

/// The last block again, because the word on it was lost: the same word. Anything else has no header, and so no file.
void FileTransfers::take_block_after_end(const Client& client, const FileBlock& block, Replies& out) {
    const bool again = client.ended_upload && client.ended_upload->block == block.number;
    const FileVerdict verdict = !again           ? FileVerdict::cancel
                                : block.intact() ? client.ended_upload->verdict
                                                 : FileVerdict::send_again;
    out.emplace_back(FileAcknowledgement{block.number, verdict});
}

/// A block that could not be read at all.
void FileTransfers::ask_again(const Client& client, Replies& out) const {
    if (client.upload) {
        out.emplace_back(
            FileAcknowledgement{client.upload->first.value_or(1) + client.upload->taken, FileVerdict::send_again});
    }
}

/// The same blocks fail in every run with the same seed.
bool FileTransfers::block_fails() {
    if (errors_.percent == 0) {
        return false;
    }
    std::uint64_t state = errors_.seed + drawn_++;
    return next_random(state) % percent < errors_.percent;
}

} // namespace linefeed::simulator
