// What waits to be written to the printer, in order: short commands, kept here, and slices of record pages, kept where
// they are. All that has gathered while one write was under way goes out in the next, as one gather write.
#pragma once

#include "base/bounded_list.hpp"

#include <cstddef>
#include <string>
#include <string_view>

namespace linefeed::session {

/// Most pieces of one gather write. While a write is under way no answers come, so few commands gather, and between
/// them at most one slice of each page at hand.
inline constexpr std::size_t max_write_pieces = 48;
using WritePieces = BoundedList<std::string_view, max_write_pieces>;

/// Flow: commands and slices are staged; begin_write() takes all staged as one write; write_done() when the link has
/// written it. One write is under way at a time. The bytes of a slice must live until its write is done.
class Outbox {
public:
    Outbox();

    /// The text to append a command to; call staged_command() behind it.
    [[nodiscard]] std::string& command_text() { return staged_.commands; }
    /// What was appended to command_text() since the last call is one more piece (or lengthens the last). Returns it;
    /// valid until more is appended.
    std::string_view staged_command();
    /// Stages bytes that live elsewhere. Precondition: not empty.
    void stage_slice(std::string_view bytes);

    /// Begins a write of everything staged, if nothing is under way. True if there is something to write.
    [[nodiscard]] bool begin_write();
    /// The pieces of the write under way.
    [[nodiscard]] WritePieces pieces() const;
    void write_done();

    [[nodiscard]] bool writing() const { return writing_; }
    [[nodiscard]] bool idle() const { return !writing_ && staged_.pieces.empty(); }
    /// Drops everything: the connection is gone.
    void clear();

private:
    struct Piece {
        std::string_view slice; ///< empty for a command
        std::size_t offset = 0; ///< of a command, in `commands`
        std::size_t size = 0;
    };
    struct Batch {
        std::string commands;
        BoundedList<Piece, max_write_pieces> pieces;

        void clear();
    };

    Batch staged_;
    Batch under_way_;
    std::size_t commands_staged_ = 0; ///< bytes of staged_.commands that belong to a piece
    bool writing_ = false;
};

} // namespace linefeed::session
