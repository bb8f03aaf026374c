// Listing, writing and deleting files of the printer, see file_transfer.hpp.
#include "printer/file_transfer.hpp"

#include "printer/exchange.hpp"
#include "printer/look.hpp"
#include "printer/printer_path.hpp"

#include <algorithm>
#include <optional>

namespace linefeed::printer {

using protocol::DirectoryBlock;
using protocol::FileAcknowledgement;
using protocol::FileBlock;
using protocol::FileVerdict;
using protocol::Message;
using Heard = PrinterClient::Heard;

namespace {

/// Flow: run() once. A block is sent again only if the printer says so: where its word is lost, nobody knows whether it
/// has the block, and the whole file is sent once more.
class Upload {
public:
    Upload(PrinterClient& printer, const std::string& path, std::string_view bytes, const TransferOptions& options)
        : printer_(printer)
        , path_(path)
        , bytes_(bytes)
        , options_(options)
        , timeout_(std::max(options.block_timeout, printer.settings().reply_timeout)) {
        const std::size_t blocks = (bytes.size() + FileBlock::max_bytes - 1) / FileBlock::max_bytes;
        progress_.total = static_cast<std::uint32_t>(std::max<std::size_t>(blocks, 1)); // an empty one makes a file too
    }

    Result<void> run() {
        begin();
        while (progress_.blocks < progress_.total) {
            if (auto gone_on = exchange(); !gone_on) {
                if (!cancelled_) {
                    static_cast<void>(printer_.send(Message{FileAcknowledgement{number(), FileVerdict::cancel}}));
                }
                return gone_on.error();
            }
        }
        return {};
    }

private:
    /// Of the block that is under way.
    [[nodiscard]] std::uint32_t number() const { return first_ + progress_.blocks; }
    [[nodiscard]] FileBlock block() const {
        const std::size_t at = std::size_t{progress_.blocks} * FileBlock::max_bytes;
        return FileBlock::of(number(), bytes_.substr(at, FileBlock::max_bytes));
    }
    [[nodiscard]] Failure failed(FailureKind kind, std::string_view why) const {
        return {kind, path_text(path_) + ": " + std::string{why}};
    }

    void begin() {
        progress_.blocks = 0;
        header_ = printer_.frame_of(protocol::FileHeader{path_, progress_.total});
    }

    Result<void> exchange() {
        verdict_.reset();
        const std::string frames = header_ + printer_.frame_of(block());
        header_.clear();
        static_cast<void>(printer_.converse(
            frames, [this](const Message& message, std::string_view /*raw*/) { return hear(message); }, timeout_));
        if (!verdict_) {
            return start_over();
        }
        switch (*verdict_) {
        case FileVerdict::ok:
            attempts_ = 0;
            ++progress_.blocks;
            if (progress_.blocks > furthest_) {
                furthest_ = progress_.blocks;
                begun_ = 0;
            }
            return options_.on_progress(progress_) || progress_.blocks == progress_.total
                       ? Result<void>{}
                       : failed(FailureKind::stopped, "cancelled");
        case FileVerdict::send_again:
            break;
        case FileVerdict::cancel:
            cancelled_ = true;
            return failed(FailureKind::stopped, "the printer has cancelled the transfer: it has no room, or no such "
                                                "directory");
        }
        ++progress_.repeated;
        return ++attempts_ < options_.attempts
                   ? Result<void>{}
                   : failed(FailureKind::input, "the printer refused block " + std::to_string(number()) + ' ' +
                                                    std::to_string(attempts_) + " times");
    }

    /// A word about another block is an old one.
    Heard hear(const Message& message) {
        const auto* const word = std::get_if<FileAcknowledgement>(&message);
        if (word == nullptr) {
            return Heard::ignored;
        }
        const bool wants_zero = progress_.blocks == 0 && first_ == 1 && word->number == 0;
        if (word->verdict == FileVerdict::send_again && wants_zero) {
            first_ = 0; // the manual does not say whether the first block has number 0 or 1
        } else if (word->verdict != FileVerdict::cancel && word->number != number()) {
            return Heard::ignored;
        }
        verdict_ = word->verdict;
        return Heard::done;
    }

    Result<void> start_over() {
        constexpr std::uint32_t begun_at_most = 3;
        if (!printer_.open()) {
            return failed(FailureKind::unreachable, "the connection is broken");
        }
        if (++begun_ == begun_at_most) {
            return failed(FailureKind::unreachable, "the printer does not answer");
        }
        ++progress_.repeated;
        begin();
        return {};
    }

    PrinterClient& printer_;
    const std::string& path_;
    std::string_view bytes_;
    const TransferOptions& options_;
    Duration timeout_;
    TransferProgress progress_;
    std::string header_; ///< frame to send before the block
    std::optional<FileVerdict> verdict_;
    std::uint32_t first_ = 1;
    std::uint32_t attempts_ = 0;
    std::uint32_t begun_ = 0;    ///< once more, as the printer was silent, since it has come further than ever
    std::uint32_t furthest_ = 0; ///< so many blocks were done at once
    bool cancelled_ = false;     ///< by the printer
};

} // namespace

Result<std::vector<protocol::DirectoryEntry>> list_files(PrinterClient& printer, const std::string& path) {
    protocol::DirectoryListing listing;
    const bool complete = printer.converse(printer.frame_of(protocol::DirectoryRequest{path}),
                                           [&listing](const Message& message, std::string_view /*raw*/) {
                                               const auto* const block = std::get_if<DirectoryBlock>(&message);
                                               if (block == nullptr) {
                                                   return Heard::ignored;
                                               }
                                               return listing.add(*block) ? Heard::done : Heard::more;
                                           });
    if (!complete) {
        return no_answer(printer, "$RD");
    }
    return listing.entries();
}

Result<std::vector<protocol::DirectoryEntry>> list_directory(PrinterClient& printer, const std::string& path) {
    auto inside = list_files(printer, path + '*');
    if (!inside || !std::ranges::all_of(*inside, &protocol::DirectoryEntry::is_directory)) {
        return inside;
    }
    return list_files(printer, path + "\\*"); // the joker was that of the directory's own name
}

Result<void> upload(PrinterClient& printer, const std::string& path, std::string_view bytes,
                    const TransferOptions& options) {
    if (bytes.size() > max_file_bytes) {
        return Failure{FailureKind::input, path_text(path) + ": the file is larger than any printer holds"};
    }
    return Upload{printer, path, bytes, options}.run();
}

Result<void> put_file(PrinterClient& printer, const std::string& path, std::string_view bytes, bool replace,
                      const TransferOptions& options) {
    const auto there = list_files(printer, path);
    if (!there) {
        return there.error();
    }
    if (!there->empty()) {
        if (!replace || there->front().is_directory) {
            return Failure{FailureKind::usage, path_text(path) + ": the printer has something of that name already"};
        }
        const auto status = ask_status(printer); // none in standby
        if (status && status->machine == protocol::MachineState::printing) {
            return Failure{FailureKind::stopped,
                           path_text(path) + ": not replaced while the printer prints: stop it first"};
        }
    }
    return upload(printer, path, bytes, options);
}

Result<void> remove_file(PrinterClient& printer, const std::string& path) {
    const auto before = list_files(printer, path);
    if (!before) {
        return before.error();
    }
    if (before->empty()) {
        return Failure{FailureKind::input, path_text(path) + ": there is no such file"};
    }
    if (before->front().is_directory) {
        return Failure{FailureKind::input, path_text(path) + ": this is a directory"};
    }
    static_cast<void>(printer.send(Message{protocol::FileDeletion{path}}));
    const auto after = list_files(printer, path);
    if (!after) {
        return after.error();
    }
    return after->empty() ? Result<void>{}
                          : Failure{FailureKind::stopped, path_text(path) +
                                                              ": the printer has not deleted it; it deletes from its "
                                                              "default directories only"};
}

} // namespace linefeed::printer
