// A printer model with a client at it, driven in milliseconds: the tests read as what was sent and what came back.
#pragma once

#include "protocol/frame_decoder.hpp"
#include "simulator/printer_model.hpp"

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace linefeed::simulator::test {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// The printer and everything it did. Time goes on only when a test says so.
class Printer {
public:
    explicit Printer(PrinterSettings settings = {})
        : escapes_(settings.profile.escapes)
        , model(std::move(settings), now) {}

    /// Sends bytes as one client; returns the bytes that came back to it.
    std::string send(std::string_view bytes, std::uint64_t client = 1) {
        protocol::FrameDecoder decoder{escapes_};
        std::string_view rest = bytes;
        for (auto result = decoder.next(rest); !std::holds_alternative<std::monostate>(result);
             result = decoder.next(rest)) {
            if (const auto* frame = std::get_if<protocol::Frame>(&result)) {
                model.receive(ConnectionId{client}, *frame, now);
            }
        }
        return collect(client);
    }

    /// Sends `=MR` for each number from first to last, the text being "t<number>".
    void fill(std::uint32_t first, std::uint32_t last) {
        for (std::uint32_t number = first; number <= last; ++number) {
            send("^0=MR" + std::to_string(number) + "\tt" + std::to_string(number) + "\r");
        }
    }

    void wait(Duration duration) {
        now += duration;
        model.advance(now);
        collect(0);
    }

    /// A PrintGo after `distance`, and the time for its print.
    PrintGoOutcome product(Duration distance = milliseconds{10}) {
        now += distance;
        const PrintGoOutcome outcome = model.print_go(now);
        now += milliseconds{2};
        model.advance(now);
        collect(0);
        return outcome;
    }

    void products(int count) {
        for (int i = 0; i < count; ++i) {
            product();
        }
    }

    /// What the operator does.
    template <typename Deed>
    void operate(Deed deed) {
        deed(model, now);
        collect(0);
    }

    std::string rs() { return send("^0?RS\r"); }
    std::string sm() { return send("^0?SM\r"); }

    [[nodiscard]] std::vector<std::uint32_t> printed_numbers() const {
        std::vector<std::uint32_t> numbers;
        for (const Printed& print : tape) {
            numbers.push_back(print.number.value());
        }
        return numbers;
    }

    [[nodiscard]] std::vector<std::uint32_t> error_codes() const {
        std::vector<std::uint32_t> codes;
        for (const ErrorRaised& error : errors) {
            codes.push_back(error.error.code());
        }
        return codes;
    }

    Instant now{seconds{1}};
    std::vector<Printed> tape;
    std::vector<ErrorRaised> errors;
    std::vector<Effect> others;

private:
    std::string collect(std::uint64_t client) {
        std::string bytes;
        for (const Effect& effect : model.effects()) {
            if (const auto* reply = std::get_if<Reply>(&effect)) {
                if (reply->connection.value == client) {
                    bytes += reply->bytes;
                } else {
                    others.push_back(effect);
                }
            } else if (const auto* print = std::get_if<Printed>(&effect)) {
                tape.push_back(*print);
            } else if (const auto* error = std::get_if<ErrorRaised>(&effect)) {
                errors.push_back(*error);
            } else {
                others.push_back(effect);
            }
        }
        model.clear_effects();
        return bytes;
    }

    protocol::EscapeMode escapes_;

public:
    PrinterModel model;
};

} // namespace linefeed::simulator::test
