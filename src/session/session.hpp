// One printer's conversation: finds frames in the bytes, matches answers with inquiries, keeps time-outs, and turns the
// feeder's actions into bytes. Bytes, completions and time in; effects out. It does no I/O and reads no clock.
#pragma once

#include "base/bounded_list.hpp"
#include "base/record_page.hpp"
#include "base/time.hpp"
#include "feeder/feeder.hpp"
#include "protocol/frame_decoder.hpp"
#include "protocol/messages.hpp"
#include "protocol/secured_line.hpp"
#include "protocol/secured_reader.hpp"
#include "session/frame_observer.hpp"
#include "session/outbox.hpp"
#include "session/page_window.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace linefeed::session {

/// Write Session::pieces() to the printer, and call on_written().
struct Write {
    friend bool operator==(const Write&, const Write&) = default;
};
/// The page is not needed any more.
struct ReleasePage {
    const RecordPage* page = nullptr;
    friend bool operator==(const ReleasePage&, const ReleasePage&) = default;
};
/// These records have been handed to the kernel, in one write.
struct RecordsWritten {
    RecordRange records;
    Instant allowed_at{}; ///< when the fact came that let the first of them go: mostly an answer
    Instant written_at{};
    friend bool operator==(const RecordsWritten&, const RecordsWritten&) = default;
};
/// Nothing more will be read or written.
struct CloseLink {
    friend bool operator==(const CloseLink&, const CloseLink&) = default;
};

/// What the edge has to carry out, in order.
using Effect =
    std::variant<std::monostate, Write, ReleasePage, RecordsWritten, CloseLink, feeder::Settle, feeder::BeginRun,
                 feeder::AdoptRun, feeder::AskIntent, feeder::ConfirmPrinted, feeder::Notice, feeder::End>;
inline constexpr std::size_t max_effects = 48;
using Effects = BoundedList<Effect, max_effects>;

struct SessionSettings {
    feeder::FeederSettings feeder;
    protocol::EscapeMode escapes = protocol::EscapeMode::backslash;
    /// The charsets of a record's fields; the end marker has as many, each a blank.
    std::vector<protocol::Charset> charsets{protocol::Charset::latin1};
    /// An inquiry unanswered for this long is lost; a printer from which nothing came for as long is silent. A serial
    /// line must have been free for as long, too.
    Duration reply_timeout = std::chrono::seconds{2};
    protocol::LineSettings line;
    /// How long the last commands (`!ST`, `!EQ`) may take to be written before the link is closed all the same.
    Duration farewell_timeout = std::chrono::seconds{1};
};

/// Counters for people.
struct SessionStatistics {
    std::uint64_t frames_received = 0;
    std::uint64_t frames_unexpected = 0; ///< echoes, and answers to nobody's question
    std::uint64_t bytes_damaged = 0;     ///< outside any frame, or in a frame that cannot be read
};

/// Flow: on_connected() once; then on_received(), on_written(), on_closed(), the ledger's answers, and on_time() at
/// next_wake(). Each appends to `out`, in order. After End nothing follows but CloseLink.
class Session {
public:
    /// `observer`, if anybody keeps the frames, must outlive it.
    Session(const SessionSettings& settings, const feeder::FeederPlan& plan, FrameObserver* observer = nullptr);

    void on_connected(Instant now, Effects& out);
    /// Bytes as they came, in any split.
    void on_received(std::string_view bytes, Instant now, Effects& out);
    /// The write of pieces() is complete.
    void on_written(Instant now, Effects& out);
    /// The other side has closed, or the link is broken.
    void on_closed(Instant now, Effects& out);

    void on_granted(RecordRange range, RecordNumber durable_through, Instant now, Effects& out);
    void on_end_known(RecordNumber last, Instant now, Effects& out);
    void on_refused(feeder::OutcomeCode why, Instant now, Effects& out);
    void on_durable(RecordNumber through, Instant now, Effects& out);
    void on_settled(Instant now, Effects& out);
    void on_storage_failed(Instant now, Effects& out);
    void on_follower_known(RecordCount count) { feeder_.on_follower_known(count); }
    void on_follower_begun(RecordRange places, RecordNumber number, Instant now, Effects& out);
    /// The next page, in order. It is lent until ReleasePage.
    void on_page(const RecordPage* page, Instant now, Effects& out);
    void request_stop(Instant now, Effects& out);

    void on_time(Instant now, Effects& out);
    [[nodiscard]] std::optional<Instant> next_wake() const;

    /// What to write after a Write effect, until on_written().
    [[nodiscard]] WritePieces pieces() const { return outbox_.pieces(); }
    [[nodiscard]] const feeder::Feeder& feeder() const { return feeder_; }
    [[nodiscard]] const SessionStatistics& statistics() const { return statistics_; }

private:
    struct Inquiry {
        protocol::Parameter what = protocol::Parameter::SM;
        Instant deadline{};
        bool given_up = false; ///< by the host, which tells nothing about the printer
    };
    static constexpr std::size_t max_inquiries = 64;

    void take_damage(std::uint64_t bytes, Instant now);
    void take_frame(const protocol::Frame& frame, Instant now, feeder::Actions& actions);
    void take_unsecured(const protocol::Frame& frame, Instant now, feeder::Actions& actions);
    // session_secured.cpp: with CRC32
    void take_secured(const protocol::Frame& frame, Instant now, feeder::Actions& actions);
    void take_proven(const protocol::Frame& frame, Instant now, feeder::Actions& actions);
    void settle_frame(protocol::SecuredLine::Step step, Instant now, feeder::Actions& actions);
    void begin_frame(Instant now);
    void send_announced(Instant now);
    [[nodiscard]] bool take_answer(const protocol::Message& message, Instant now, feeder::Actions& actions);
    /// Removes the oldest inquiry for `what`; false if there was none.
    [[nodiscard]] bool answered(protocol::Parameter what);
    void forget_mail_before_status(Instant now, feeder::Actions& actions);
    void time_out(protocol::Parameter what, Instant now, feeder::Actions& actions);
    void carry_out(const feeder::Actions& actions, Instant now, Effects& out);
    void carry_out(const feeder::Action& action, Instant now, Effects& out);
    void send_command(protocol::SecuredLine::Kind kind, Instant now,
                      protocol::Parameter what = protocol::Parameter::SM);
    void give_inquiries_up(Instant now);
    void send_records(RecordRange records, Instant now);
    void stage_records(RecordRange records, Instant now);
    void stage_command(std::string_view bytes, Instant now);
    void note_records(RecordRange records, std::string_view first, std::size_t bytes, Instant now);
    void note_sent(std::size_t bytes, Instant now);
    [[nodiscard]] RecordNumber staged_through() const;
    [[nodiscard]] bool drained() const;
    void flush(Instant now, Effects& out);
    void finish_if_drained(Effects& out);
    void release_pages(Effects& out);
    [[nodiscard]] std::optional<Instant> first_deadline() const;

    SessionSettings settings_;
    FrameObserver* observer_;
    feeder::Feeder feeder_;
    protocol::FrameDecoder decoder_;
    Outbox outbox_;
    std::string command_; ///< the one that is being made
    PageWindow pages_;
    protocol::SecuredLine secured_;
    protocol::SecuredReader secured_reader_;
    Instant line_free_at_{};                          ///< all that was sent has gone over the line by then
    std::optional<RecordsWritten> staged_records_;    ///< in the outbox, for the next write
    std::optional<RecordsWritten> records_under_way_; ///< with the write under way
    BoundedList<Inquiry, max_inquiries> inquiries_;
    Instant heard_at_{}; ///< of the last frame
    SessionStatistics statistics_;
    bool connected_ = false;
    std::optional<feeder::End> end_; ///< the feeder has ended; its last commands may still be on the way
    Instant farewell_deadline_{};
    bool closed_ = false;
};

} // namespace linefeed::session
