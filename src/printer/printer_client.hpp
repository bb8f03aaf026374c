// A short conversation with a printer besides the feeding: a look before a start, `!EQ`, `!US`. One inquiry after the
// other on a connection of its own; it blocks, so it belongs on a worker of the control side, never on the feed thread.
#pragma once

#include "base/failure.hpp"
#include "base/time.hpp"
#include "protocol/escapes.hpp"
#include "protocol/frame_decoder.hpp"
#include "protocol/messages.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::printer {

struct ClientSettings {
    std::string address;                                   ///< for people
    std::vector<boost::asio::ip::tcp::endpoint> endpoints; ///< tried in turn; resolved
    protocol::EscapeMode escapes = protocol::EscapeMode::backslash;
    Duration connect_timeout = std::chrono::seconds{3}; ///< for each endpoint
    Duration reply_timeout = std::chrono::seconds{2};
};

/// What other programs have left switched on at the printer, or what is wrong with the line. All of it is coped with.
struct ConversationOddities {
    bool lengths = false;            ///< `!LN`: each frame carries its length
    bool echoes = false;             ///< `!EM`: commands come back
    bool filled = false;             ///< `=FL`: frames are filled with blanks
    std::uint64_t damaged_bytes = 0; ///< that belong to no frame, or to one that cannot be read

    friend bool operator==(const ConversationOddities&, const ConversationOddities&) = default;
};

/// Flow: connect(), then ask() and send() as wanted; the connection closes with it. One thread.
class PrinterClient {
public:
    /// FailureKind::unreachable if no endpoint takes the connection.
    [[nodiscard]] static Result<std::unique_ptr<PrinterClient>> connect(const ClientSettings& settings);
    ~PrinterClient();
    PrinterClient(const PrinterClient&) = delete;
    PrinterClient& operator=(const PrinterClient&) = delete;

    /// The answer: its type is that of `what`: RS, SM, CC, VS or JL. Absent: none came within the reply time-out, or
    /// the connection broke.
    template <typename Answer>
    [[nodiscard]] std::optional<Answer> ask(protocol::Parameter what) {
        const auto message = ask_for(what);
        const Answer* const answer = message ? std::get_if<Answer>(&*message) : nullptr;
        return answer == nullptr ? std::nullopt : std::optional{*answer};
    }
    /// Hands a command to the kernel. False if the connection is broken.
    bool send(protocol::Action action);
    /// The other side has not closed.
    [[nodiscard]] bool open() const { return open_; }
    [[nodiscard]] const ConversationOddities& oddities() const { return oddities_; }

private:
    using Clock = std::chrono::steady_clock;

    explicit PrinterClient(const ClientSettings& settings);
    [[nodiscard]] std::string connect_to(const boost::asio::ip::tcp::endpoint& endpoint);
    [[nodiscard]] std::optional<protocol::Message> ask_for(protocol::Parameter what);
    [[nodiscard]] bool write(const std::string& bytes);
    [[nodiscard]] std::string_view read(Clock::time_point deadline);
    [[nodiscard]] std::optional<protocol::Message> next_message(std::string_view& bytes);
    void note_filling(std::string_view bytes);

    ClientSettings settings_;
    boost::asio::io_context context_{1};
    boost::asio::ip::tcp::socket socket_{context_};
    protocol::FrameDecoder decoder_;
    ConversationOddities oddities_;
    bool open_ = false;
    char last_byte_ = '\0';
    std::array<char, 4096> buffer_{};
};

} // namespace linefeed::printer
