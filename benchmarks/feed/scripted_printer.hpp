// The printer of the refill benchmark: answers what a feeder asks on its way to printing, and from then on holds every
// answer back until the benchmark says how many more records are printed. All that was asked until then is answered at
// once, in the order of the inquiries: a host takes an answer that others have overtaken for lost.
#pragma once

#include "base/record_number.hpp"
#include "base/time.hpp"
#include "protocol/commands.hpp"
#include "protocol/frame_decoder.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace linefeed::benchmarks {

/// One client of the printer. Flow: accept(); take() whenever there may be bytes; when ready(), report().
class ScriptedPrinter {
public:
    /// Listens on a free port of 127.0.0.1.
    ScriptedPrinter(std::uint32_t depth, std::uint32_t records);
    ~ScriptedPrinter();
    ScriptedPrinter(const ScriptedPrinter&) = delete;
    ScriptedPrinter& operator=(const ScriptedPrinter&) = delete;

    [[nodiscard]] std::uint16_t port() const { return port_; }
    void accept();
    [[nodiscard]] int descriptor() const { return socket_; }
    /// Reads and answers what has come; never blocks.
    void take();
    /// Prints, and a `=SM` is asked for.
    [[nodiscard]] bool ready() const;
    [[nodiscard]] bool printing() const { return printing_; }
    /// Answers all that was asked, `records` later; the instant just before the bytes are handed to the kernel.
    [[nodiscard]] Instant report(std::uint32_t records);

    [[nodiscard]] std::uint32_t printed() const { return printed_; }
    [[nodiscard]] std::uint32_t received() const { return received_; }
    /// How many bytes had come when record `number` was complete; 0 = it has not come.
    [[nodiscard]] std::uint64_t bytes_behind(std::uint32_t number) const { return bytes_behind_[number]; }
    void close();

private:
    void take_frame(const protocol::Frame& frame, std::uint64_t bytes_through);
    void answer_all();
    void answer(protocol::Parameter inquiry);
    void append_mail_status();
    void send_answers();

    std::uint32_t depth_;
    std::vector<std::uint64_t> bytes_behind_;
    int listener_ = -1;
    int socket_ = -1;
    std::uint16_t port_ = 0;
    protocol::FrameDecoder decoder_;
    std::array<char, 65536> buffer_{};
    std::string answers_;
    std::uint64_t bytes_ = 0;
    bool printing_ = false;
    std::vector<protocol::Parameter> inquiries_; ///< not answered yet, oldest first
    std::uint32_t stop_at_ = 0;
    std::uint32_t printed_ = 0;
    std::uint32_t received_ = 0;
};

} // namespace linefeed::benchmarks
