// A client that sends whatever it likes: the simulated printer answers in whole frames, keeps its promises about the
// FIFO, and never breaks. The first byte chooses profile and state; a byte of 0xFF in the stream is a product.
#include "base/assert.hpp"
#include "protocol/frame_decoder.hpp"
#include "simulator/printer_model.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace {

using namespace linefeed;
using namespace linefeed::simulator;

PrinterSettings settings_of(std::uint8_t choice) {
    PrinterSettings settings;
    static_assert(protocol::is_automatic(protocol::profiles.back())); // which no printer is
    settings.profile = protocol::profiles[choice % (protocol::profiles.size() - 1)];
    settings.counters = {{1, 9, 0}, {5, 2, 3}};
    settings.power_up = static_cast<PowerUpState>(choice / 4 % 3);
    settings.depth = 8;
    settings.habits.sixth_value = (choice & 0x40U) != 0;
    settings.habits.missing_jobs_refused = (choice & 0x80U) != 0;
    return settings;
}

/// Every reply is frames and filling.
void check_replies(const PrinterModel& model) {
    for (const Effect& effect : model.effects()) {
        if (const auto* const reply = std::get_if<Reply>(&effect)) {
            LINEFEED_ASSERT(!reply->bytes.empty() && reply->bytes.front() == '^');
            LINEFEED_ASSERT(reply->bytes.find('\r') != std::string::npos);
        }
    }
    LINEFEED_ASSERT(model.fifo().records() <= model.fifo().depth());
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) {
        return 0;
    }
    const PrinterSettings settings = settings_of(data[0]);
    Instant now{std::chrono::seconds{1}};
    PrinterModel model{settings, now};
    protocol::FrameDecoder decoder{settings.profile.escapes};
    std::string stream(data + 1, data + size);
    std::string_view rest = stream;
    while (!rest.empty()) {
        const std::size_t product = rest.find('\xFF');
        std::string_view part = rest.substr(0, product);
        rest.remove_prefix(std::min(part.size() + 1, rest.size()));
        for (auto result = decoder.next(part); !std::holds_alternative<std::monostate>(result);
             result = decoder.next(part)) {
            if (const auto* const frame = std::get_if<protocol::Frame>(&result)) {
                now += std::chrono::milliseconds{1};
                model.receive(ConnectionId{1}, *frame, now);
                check_replies(model);
                model.clear_effects();
            }
        }
        now += std::chrono::milliseconds{50};
        static_cast<void>(model.print_go(now));
        model.clear_effects();
    }
    return 0;
}
