#include "session/outbox.hpp"

#include <utility>

namespace linefeed::session {

namespace {
constexpr std::size_t command_bytes_reserved = 4096;
} // namespace

Outbox::Outbox() {
    staged_.commands.reserve(command_bytes_reserved);
    under_way_.commands.reserve(command_bytes_reserved);
}

void Outbox::Batch::clear() {
    commands.clear();
    pieces.clear();
}

std::string_view Outbox::staged_command() {
    const std::string_view command = std::string_view{staged_.commands}.substr(commands_staged_);
    const std::size_t added = command.size();
    LINEFEED_ASSERT(added > 0);
    const bool last_is_command = !staged_.pieces.empty() && staged_.pieces[staged_.pieces.size() - 1].slice.empty();
    if (last_is_command) {
        staged_.pieces[staged_.pieces.size() - 1].size += added;
    } else {
        staged_.pieces.push_back({{}, commands_staged_, added});
    }
    commands_staged_ = staged_.commands.size();
    return command;
}

void Outbox::stage_slice(std::string_view bytes) {
    LINEFEED_ASSERT(!bytes.empty());
    if (!staged_.pieces.empty()) {
        Piece& last = staged_.pieces[staged_.pieces.size() - 1];
        if (last.slice.data() + last.slice.size() == bytes.data()) { // the next records of the same page
            last.slice = {last.slice.data(), last.slice.size() + bytes.size()};
            return;
        }
    }
    staged_.pieces.push_back({bytes, 0, bytes.size()});
}

bool Outbox::begin_write() {
    if (writing_ || staged_.pieces.empty()) {
        return false;
    }
    std::swap(staged_, under_way_);
    commands_staged_ = 0;
    writing_ = true;
    return true;
}

WritePieces Outbox::pieces() const {
    WritePieces result;
    for (const Piece& piece : under_way_.pieces) {
        result.push_back(piece.slice.empty() ? std::string_view{under_way_.commands}.substr(piece.offset, piece.size)
                                             : piece.slice);
    }
    return result;
}

void Outbox::write_done() {
    LINEFEED_ASSERT(writing_);
    under_way_.clear();
    writing_ = false;
}

void Outbox::clear() {
    staged_.clear();
    under_way_.clear();
    commands_staged_ = 0;
    writing_ = false;
}

} // namespace linefeed::session
