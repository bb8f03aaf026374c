// A short conversation with a printer besides the feeding: a look before a start, `!EQ`, `!US`. One inquiry after the
// other on a connection of its own; it blocks, so it belongs on a worker of the control side, never on the feed thread.
#pragma once

#include "base/failure.hpp"
#include "base/time.hpp"
#include "link/dialer.hpp"
#include "protocol/frame_decoder.hpp"
#include "protocol/messages.hpp"
#include "protocol/profile.hpp"
#include "protocol/secured_line.hpp"
#include "protocol/secured_reader.hpp"

#include <boost/asio/io_context.hpp>

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace linefeed::printer {

struct ClientSettings {
    std::string address;       ///< for people
    link::Endpoints endpoints; ///< resolved
    protocol::Profile profile = protocol::profiles.front();
    Duration connect_timeout = std::chrono::seconds{3}; ///< for each endpoint
    Duration reply_timeout = std::chrono::seconds{2};
};

/// What other programs have left switched on at the printer, or what is wrong with the line. All of it is coped with.
struct ConversationOddities {
    bool lengths = false;            ///< `!LN`: each frame carries its length
    bool echoes = false;             ///< `!EM`: commands come back
    bool filled = false;             ///< `=FL`: frames are filled with blanks
    bool unsecured = false;          ///< answers come, but without the CRC32 that was asked for
    std::uint64_t damaged_bytes = 0; ///< that belong to no frame, or to one that cannot be read
    std::string unreadable{};        ///< why the last answer could not be read; empty = it could

    friend bool operator==(const ConversationOddities&, const ConversationOddities&) = default;
};

/// Flow: connect(), then ask(), send() and converse() as wanted; the connection closes with it. One thread.
class PrinterClient {
public:
    /// What a listener makes of a frame.
    enum class Heard {
        ignored, ///< belongs to something else
        more,    ///< part of the answer: the reply time-out begins anew
        done,    ///< the answer is complete
    };
    /// `raw` is the frame from `^` up to and without CR.
    using Listener = std::function<Heard(const protocol::Message& message, std::string_view raw)>;
    /// Whole bytes as they go and come, whatever they are.
    using Observer = std::function<void(bool sent, std::string_view bytes)>;

    /// FailureKind::unreachable if no endpoint takes the connection.
    [[nodiscard]] static Result<std::unique_ptr<PrinterClient>> connect(const ClientSettings& settings);
    ~PrinterClient();
    PrinterClient(const PrinterClient&) = delete;
    PrinterClient& operator=(const PrinterClient&) = delete;

    /// The answer to `?XX`, or to `?XX argument`, which is one frame of the type `Answer`. Absent: none came within the
    /// reply time-out, or the connection broke.
    template <typename Answer>
    [[nodiscard]] std::optional<Answer> ask(protocol::Parameter what, std::string argument = {}) {
        std::optional<Answer> answer;
        static_cast<void>(converse(frame_of(protocol::InquiryMessage{what, std::move(argument)}),
                                   [&answer](const protocol::Message& message, std::string_view /*raw*/) {
                                       if (const auto* const wanted = std::get_if<Answer>(&message)) {
                                           answer = *wanted;
                                       }
                                       return answer ? Heard::done : Heard::ignored;
                                   }));
        return answer;
    }
    /// Hands a command to the kernel. False if the connection is broken, or if the transmission is secured and the
    /// printer does not say that it has arrived.
    bool send(protocol::Action action);
    bool send(const protocol::Message& message) { return deliver(frame_of(message)); }
    /// Whether frames are secured by CRC32 (protocol, section 6), both ways; as the address wants it, unless set.
    void set_secured(bool secured) { secured_ = secured; }
    /// Sends `bytes`, which may be none, and listens until the listener is done. False: the reply time-out is over, or
    /// the connection broke; what was heard until then counts.
    bool converse(const std::string& bytes, const Listener& listener);
    /// The same with another time-out than the connection's own.
    bool converse(const std::string& bytes, const Listener& listener, Duration reply_timeout);
    /// The frame with its CR, escaped as this printer's firmware wants it.
    [[nodiscard]] std::string frame_of(const protocol::Message& message) const;
    /// Hears from now on of everything that is sent and that comes.
    void observe(Observer observer) { observer_ = std::move(observer); }
    /// The printer has told what it is.
    void use(const protocol::Profile& profile) { settings_.profile = profile; }
    [[nodiscard]] const ClientSettings& settings() const { return settings_; }
    /// Why there is no answer to what was asked last, in words: `asked` e.g. "?SM".
    [[nodiscard]] std::string silence(std::string_view asked) const;
    /// The other side has not closed.
    [[nodiscard]] bool open() const { return open_; }
    [[nodiscard]] const ConversationOddities& oddities() const { return oddities_; }

private:
    using Clock = std::chrono::steady_clock;

    explicit PrinterClient(const ClientSettings& settings);
    [[nodiscard]] bool deliver(const std::string& frame);
    [[nodiscard]] bool listen(const Listener& listener, Duration reply_timeout);
    // printer_client_secured.cpp
    [[nodiscard]] bool exchange(std::string_view frame, const Listener& listener, Duration reply_timeout);
    [[nodiscard]] bool settle(const Listener& listener);
    [[nodiscard]] Heard take_secured(const protocol::Frame& frame, const protocol::Message& message,
                                     const Listener& listener);
    [[nodiscard]] Heard take_proven(const protocol::Frame& frame, const protocol::Message& message,
                                    const Listener& listener);
    [[nodiscard]] Heard take_standby(const protocol::Frame& frame, const protocol::Message& message,
                                     const Listener& listener);
    void step(protocol::SecuredLine::Step step);
    [[nodiscard]] bool write(const std::string& bytes);
    [[nodiscard]] std::string_view read(Clock::time_point deadline);
    /// What stands in one read: the most that the listener has made of one of its frames.
    [[nodiscard]] Heard hear(std::string_view bytes, const Listener& listener);
    [[nodiscard]] protocol::Message message_of(const protocol::Frame& frame);
    [[nodiscard]] Duration time_on_line(std::size_t bytes) const;
    void note_filling(std::string_view bytes);

    ClientSettings settings_;
    boost::asio::io_context context_{1};
    link::Channel channel_{context_};
    protocol::FrameDecoder decoder_;
    ConversationOddities oddities_;
    bool secured_;
    protocol::SecuredLine line_;
    bool to_send_ = false; ///< what the line announces has to go out
    protocol::SecuredReader line_reader_;
    Observer observer_ = [](bool, std::string_view) {};
    bool open_ = false;
    char last_byte_ = '\0';
    std::array<char, 4096> buffer_{};
};

} // namespace linefeed::printer
