// Reading a file of the printer, see file_transfer.hpp.
#include "printer/file_transfer.hpp"
#include "printer/printer_path.hpp"
#include "protocol/decimal.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace linefeed::printer {

using protocol::FileAcknowledgement;
using protocol::FileBlock;
using protocol::FileHeader;
using protocol::FileVerdict;
using protocol::Message;
using Heard = PrinterClient::Heard;

namespace {

/// Flow: run() once.
class Download {
public:
    Download(PrinterClient& printer, const std::string& path, const FileSink& sink, const TransferOptions& options)
        : printer_(printer)
        , path_(path)
        , sink_(sink)
        , options_(options)
        , timeout_(std::max(options.block_timeout, printer.settings().reply_timeout)) {}

    Result<FileFound> run() {
        send_ = printer_.frame_of(protocol::FileRequest{path_});
        do {
            if (auto gone_on = exchange(); !gone_on) {
                cancel();
                return gone_on.error();
            }
        } while (!header_came_ || progress_.blocks < progress_.total);
        if (progress_.total > 0) { // the word about the last block is not answered
            static_cast<void>(printer_.send(Message{FileAcknowledgement{number(), FileVerdict::ok}}));
        }
        return progress_.total > 0 ? FileFound::yes : FileFound::empty_or_missing;
    }

private:
    /// The number of the block taken last.
    [[nodiscard]] std::uint32_t number() const { return first_ + progress_.blocks - 1; }
    [[nodiscard]] std::uint32_t expected() const { return number() + 1; }

    [[nodiscard]] Failure failed(FailureKind kind, std::string_view why) const {
        return {kind, path_text(path_) + ": " + std::string{why}};
    }

    /// Sends what is to be sent and waits for the next block, or, before the first, for a header that announces none.
    Result<void> exchange() {
        block_.reset();
        damaged_ = refused_ = false;
        const bool heard = printer_.converse(
            send_, [this](const Message& message, std::string_view /*raw*/) { return hear(message); }, timeout_);
        if (refused_) {
            return failed(FailureKind::stopped, "the printer has cancelled the transfer");
        }
        if (progress_.total > max_file_bytes / FileBlock::max_bytes) {
            return failed(FailureKind::input, "the printer announces more than any printer holds");
        }
        if (heard && !block_ && !damaged_) {
            return {}; // there is no file
        }
        return block_ ? take(*block_) : again();
    }

    Heard hear(const Message& message) {
        if (const auto* const header = std::get_if<FileHeader>(&message)) {
            if (header_came_) {
                return Heard::ignored;
            }
            header_came_ = true;
            progress_.total = header->blocks;
            return header->blocks == 0 || header->blocks > max_file_bytes / FileBlock::max_bytes ? Heard::done
                                                                                                 : Heard::more;
        }
        if (const auto* const block = std::get_if<FileBlock>(&message)) {
            return header_came_ ? hear(*block) : Heard::ignored;
        }
        if (const auto* const word = std::get_if<FileAcknowledgement>(&message)) {
            refused_ = word->verdict == FileVerdict::cancel;
            return refused_ ? Heard::done : Heard::ignored;
        }
        const auto* const malformed = std::get_if<protocol::MalformedMessage>(&message);
        damaged_ = malformed != nullptr && malformed->payload.starts_with("FT");
        if (damaged_) {
            const std::string_view number = std::string_view{malformed->payload}.substr(2);
            learn_first(protocol::read_decimal<std::uint32_t>(number.substr(0, number.find('\t'))));
        }
        return damaged_ ? Heard::done : Heard::ignored;
    }

    /// The manual does not say whether the first block has number 0 or 1: also one that is damaged shows it, and has to
    /// be asked for by it.
    void learn_first(std::optional<std::uint32_t> number) {
        if (progress_.blocks == 0 && number && *number <= 1) {
            first_ = *number;
        }
    }

    Heard hear(const FileBlock& block) {
        learn_first(block.number);
        if (progress_.blocks > 0 && block.intact() && block.number == number()) {
            // Once more, as our word about it was lost or late. That word may bring the next block once more, too: it
            // is said but once.
            if (std::exchange(repeated_word_, true)) {
                return Heard::ignored;
            }
            static_cast<void>(printer_.send(Message{FileAcknowledgement{number(), FileVerdict::ok}}));
            return Heard::more;
        }
        if (block.intact() && block.number == expected()) {
            block_ = block;
        }
        damaged_ = !block_;
        return Heard::done;
    }

    Result<void> take(const FileBlock& block) {
        if (auto taken = sink_(block.bytes); !taken) {
            return taken.error();
        }
        attempts_ = silences_ = 0;
        repeated_word_ = false;
        ++progress_.blocks;
        if (!options_.on_progress(progress_) && progress_.blocks < progress_.total) {
            return failed(FailureKind::stopped, "cancelled");
        }
        send_ = printer_.frame_of(FileAcknowledgement{number(), FileVerdict::ok});
        return {};
    }

    /// Asks for the block again; where nothing has come at all, for the file.
    Result<void> again() {
        if (!printer_.open()) {
            return failed(FailureKind::unreachable, "the connection is broken");
        }
        repeated_word_ = false;
        constexpr std::uint32_t silences_at_most = 3;
        silences_ = damaged_ ? 0 : silences_ + 1;
        if (silences_ == silences_at_most) {
            return failed(FailureKind::unreachable, "the printer does not answer");
        }
        if (++attempts_ >= options_.attempts) {
            return failed(FailureKind::input, "block " + std::to_string(expected()) + " came damaged " +
                                                  std::to_string(attempts_) + " times");
        }
        ++progress_.repeated;
        if (header_came_) {
            send_ = printer_.frame_of(FileAcknowledgement{expected(), FileVerdict::send_again});
        }
        return {};
    }

    void cancel() {
        if (!refused_ && header_came_) {
            static_cast<void>(printer_.send(Message{FileAcknowledgement{expected(), FileVerdict::cancel}}));
        }
    }

    PrinterClient& printer_;
    const std::string& path_;
    const FileSink& sink_;
    const TransferOptions& options_;
    Duration timeout_;
    TransferProgress progress_;
    std::string send_; ///< frame that the next exchange begins with
    std::optional<FileBlock> block_;
    std::uint32_t first_ = 1; ///< number of the first block
    std::uint32_t attempts_ = 0;
    std::uint32_t silences_ = 0;
    bool header_came_ = false;
    bool repeated_word_ = false; ///< about the block taken last
    bool damaged_ = false;       ///< a block came that is no use
    bool refused_ = false;
};

} // namespace

Result<FileFound> download(PrinterClient& printer, const std::string& path, const FileSink& sink,
                           const TransferOptions& options) {
    return Download{printer, path, sink, options}.run();
}

Result<std::string> download(PrinterClient& printer, const std::string& path, const TransferOptions& options) {
    std::string bytes;
    const FileSink sink = [&bytes](std::string_view more) -> Result<void> {
        bytes += more;
        return {};
    };
    const auto found = download(printer, path, sink, options);
    return found ? Result<std::string>{std::move(bytes)} : found.error();
}

} // namespace linefeed::printer
