// An inquiry and its answer, or why there is none: what the tasks are made of.
#pragma once

#include "base/failure.hpp"
#include "printer/printer_client.hpp"
#include "protocol/messages.hpp"

#include <chrono>
#include <string>
#include <thread>
#include <vector>

namespace linefeed::printer {

/// FailureKind::unreachable: the printer is silent, or the connection is lost. In standby most inquiries are not
/// answered, and old firmware does not know all.
[[nodiscard]] Failure no_answer(const PrinterClient& printer, protocol::Parameter what);
[[nodiscard]] Failure no_answer(const PrinterClient& printer, std::string_view what);

/// FailureKind::unreachable: the connection broke while the command was sent, or the printer has not said that it has
/// arrived as it was sent: nobody knows whether it is done.
[[nodiscard]] Failure not_confirmed(const PrinterClient& printer);

/// FailureKind::stopped: what was sent has not changed what it should. `seen` = what the printer says instead.
[[nodiscard]] Failure not_taken(const std::string& seen);

/// The answer to one inquiry.
template <typename Answer>
[[nodiscard]] Result<Answer> asked(PrinterClient& printer, protocol::Parameter what, std::string argument = {}) {
    auto answer = printer.ask<Answer>(what, std::move(argument));
    return answer ? Result<Answer>{*std::move(answer)} : no_answer(printer, what);
}

/// The same until `is_so` of it, `longest` at most: the last answer.
template <typename Answer, typename IsSo>
[[nodiscard]] Result<Answer> asked_until(PrinterClient& printer, protocol::Parameter what, Duration longest,
                                         const IsSo& is_so) {
    constexpr Duration look_again = std::chrono::milliseconds{50};
    const auto deadline = std::chrono::steady_clock::now() + longest;
    while (true) {
        auto answer = asked<Answer>(printer, what);
        if (!answer || is_so(*answer) || std::chrono::steady_clock::now() >= deadline) {
            return answer;
        }
        std::this_thread::sleep_for(look_again);
    }
}

/// `?EL` and `?EV`: the whole list, put together from its blocks; asked for again if it changed meanwhile.
[[nodiscard]] Result<std::vector<protocol::ErrorEntry>> ask_error_list(PrinterClient& printer);
[[nodiscard]] Result<std::vector<protocol::EventEntry>> ask_event_list(PrinterClient& printer);

/// A frame that came.
struct HeardFrame {
    protocol::Message message;
    std::string raw; ///< from `^` up to and without CR
};

/// Sends bytes and gathers whatever comes: until nothing comes for `quiet`, or there are max_gathered frames.
[[nodiscard]] Result<std::vector<HeardFrame>> gather(PrinterClient& printer, const std::string& bytes, Duration quiet);
inline constexpr std::size_t max_gathered = 4096;

} // namespace linefeed::printer
