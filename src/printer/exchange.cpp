#include "printer/exchange.hpp"

namespace linefeed::printer {

using protocol::Message;
using protocol::Parameter;

namespace {

template <typename Block>
Result<std::vector<typename Block::Entry>> ask_list(PrinterClient& printer) {
    constexpr int attempts = 3;
    for (int attempt = 0; attempt < attempts; ++attempt) {
        protocol::ListAssembly<Block> assembly;
        auto progress = protocol::ListProgress::needs_more;
        const bool ended = printer.converse(
            printer.frame_of(protocol::InquiryMessage{Block::list}), [&](const Message& message, std::string_view) {
                const auto* const block = std::get_if<Block>(&message);
                if (block == nullptr) {
                    return PrinterClient::Heard::ignored;
                }
                progress = assembly.add(*block);
                return progress == protocol::ListProgress::needs_more ? PrinterClient::Heard::more
                                                                      : PrinterClient::Heard::done;
            });
        if (progress == protocol::ListProgress::complete) {
            return assembly.entries();
        }
        if (!ended && assembly.entries().empty()) {
            return no_answer(printer, Block::list);
        }
    }
    return Failure{FailureKind::unreachable, printer.settings().address + ": the blocks of " +
                                                 std::string{description(Block::list)} + " do not fit together"};
}

} // namespace

Failure no_answer(const PrinterClient& printer, Parameter what) {
    return no_answer(printer, "?" + std::string{code(what)} + " (" + std::string{description(what)} + ')');
}

Failure no_answer(const PrinterClient& printer, std::string_view what) {
    return {FailureKind::unreachable, printer.silence(what)};
}

Failure not_confirmed(const PrinterClient& printer) {
    return {FailureKind::unreachable,
            printer.settings().address + (printer.open() ? ": the printer has not confirmed the command: nobody knows "
                                                           "whether it is done. Look before you give it again"
                                                         : ": the connection was lost while the command was sent")};
}

Failure not_taken(const std::string& seen) {
    return {FailureKind::stopped, "the printer has not taken it: " + seen};
}

Result<std::vector<protocol::ErrorEntry>> ask_error_list(PrinterClient& printer) {
    return ask_list<protocol::ErrorListBlock>(printer);
}

Result<std::vector<protocol::EventEntry>> ask_event_list(PrinterClient& printer) {
    return ask_list<protocol::EventListBlock>(printer);
}

Result<std::vector<HeardFrame>> gather(PrinterClient& printer, const std::string& bytes, Duration quiet) {
    std::vector<HeardFrame> frames;
    const bool full = printer.converse(
        bytes,
        [&frames](const Message& message, std::string_view raw) {
            frames.push_back({message, std::string{raw}});
            return frames.size() == max_gathered ? PrinterClient::Heard::done : PrinterClient::Heard::more;
        },
        quiet);
    if (!full && !printer.open()) {
        return Failure{FailureKind::unreachable, printer.settings().address + ": the connection is lost"};
    }
    return frames;
}

} // namespace linefeed::printer
