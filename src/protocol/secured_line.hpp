// Secured transmission (protocol, section 6, CRC32): every frame is announced by its checksum, and the next goes out
// only when the printer has said of this one that it is right. One frame at a time, since the FIFO takes no record
// later than the one behind it.
//
// What the printer refuses is repeated. What it says nothing about may have arrived, may have been lost, or may have
// been taken without a check because the announcement was lost. An inquiry or a command can be repeated all the same,
// once it is certain that no answer to the first is still on its way: an inquiry of another kind is put in between, and
// answers keep their order. A record cannot: it may lie in the FIFO with a damaged text. It is unproven, and must not
// be printed. Where a frame was given up, its word may still come. The next command goes out all the same (it is
// `!ST`), but the first word behind it proves nothing: an inquiry is put in between, and the command is repeated. All
// else waits until such an inquiry is answered.
#pragma once

#include "base/record_number.hpp"
#include "base/time.hpp"
#include "protocol/commands.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace linefeed::protocol {

/// What the line between host and printer is like.
struct LineSettings {
    double bytes_per_second = 0; ///< each way; 0 = so many that they need no counting
    bool crc = false;            ///< frames are secured
    Duration answer_takes{0}; ///< the printer may need so long for an answer when it has said that the inquiry is right

    /// How long so many bytes take.
    [[nodiscard]] Duration time_of(std::size_t bytes) const;
};

/// Flow: add…() in the order in which it shall go out; begin() gives the next frame when the one before is settled;
/// then one on_…() for each fact, and on_time() at deadline().
class SecuredLine {
    static constexpr int max_tries = 8;                                        ///< of one frame
    static constexpr int max_syncs = 5;                                        ///< in a row, unanswered
    static constexpr Duration least_patience = std::chrono::milliseconds{200}; ///< besides the time on the line
    static constexpr Duration most_patience = std::chrono::seconds{2};         ///< for a printer that is slow to answer
    static constexpr std::size_t answer_bytes = 128;                           ///< with its announcement
    static constexpr std::size_t max_frames = 64;                              ///< waiting

public:
    /// What becomes of a frame about which the printer says nothing.
    enum class Kind {
        inquiry, ///< repeated: its answer is what proves it
        command, ///< repeated: doing it twice does no harm
        once,    ///< never repeated: twice would be something else than once
        record,  ///< unproven
    };
    struct Frame {
        Kind kind = Kind::command;
        Parameter what = Parameter::SM; ///< of an inquiry
        RecordNumber number{};          ///< of the record that is under way
        RecordRange records{};          ///< that have not begun
        std::string bytes{};            ///< from `^` to CR
    };
    /// What a fact leads to.
    enum class Step {
        wait,     ///< nothing yet
        next,     ///< the frame is settled: begin()
        send,     ///< announced() has to go out (once more)
        lost,     ///< the inquiry current() was not answered: begin()
        unproven, ///< the record current() may lie in the FIFO with a damaged text: begin()
    };

    explicit SecuredLine(const LineSettings& line)
        : line_(line) {}
    /// How long one frame may take on a bad line, besides the bytes.
    [[nodiscard]] static Duration repeats_take();

    void add(Frame frame);
    void add_records(RecordRange records);
    /// Records that have not begun will not: the line is being stopped.
    void drop_records();
    /// Nor will the first inquiry that waits: nobody wants the answer any more. Which it was; absent = none waits.
    std::optional<Parameter> drop_inquiry();
    /// The first record that has not begun; absent = none waits.
    [[nodiscard]] std::optional<RecordNumber> first_waiting() const;

    /// The frame under way is an inquiry.
    [[nodiscard]] bool asks() const { return busy() && current_.kind == Kind::inquiry; }
    /// A frame is under way.
    [[nodiscard]] bool busy() const { return state_ != State::idle; }
    [[nodiscard]] bool idle() const { return !busy() && size_ == 0; }
    /// Begins with the next frame and gives it; absent = none waits, or one is under way. A record comes without bytes:
    /// set_record() gives them.
    [[nodiscard]] const Frame* begin();
    void set_record(std::string_view bytes) { current_.bytes = bytes; }
    /// The frame of begin().
    [[nodiscard]] const Frame& current() const { return current_; }
    /// What to write now: the announcement and its frame. The wait for the printer's word begins.
    [[nodiscard]] std::string_view announced(Instant now);

    /// The sum that was announced last.
    [[nodiscard]] std::uint32_t announced_sum() const { return sum_; }

    /// `!OK`.
    [[nodiscard]] Step on_right(Instant now);
    /// `=FC`.
    [[nodiscard]] Step on_refused();
    /// An answer to the inquiry `what`, which was secured and right.
    [[nodiscard]] Step on_answer(Parameter what, Instant now);
    /// The frame current(), which is settled, has arrived as it was sent.
    [[nodiscard]] bool proven() const { return proven_; }
    /// Nothing is under way but the inquiry that is put in between.
    [[nodiscard]] bool syncing() const { return state_ == State::syncing; }
    /// Whether an answer to `what` is waited for.
    [[nodiscard]] bool is(Parameter what) const;
    /// A command or record came back (`!EM`), from `^` up to and without the CR.
    void on_echo(std::string_view frame);
    [[nodiscard]] Step on_time(Instant now);
    [[nodiscard]] std::optional<Instant> deadline() const;
    /// Nothing more is waited for of the frame that is under way.
    void give_up();
    /// The connection is gone, or nothing more is wanted.
    void clear();

private:
    enum class State : std::uint8_t {
        idle,
        sent,    ///< waits for `!OK`, and an inquiry for its answer
        syncing, ///< the printer's silence is over when it answers this other inquiry
    };
    [[nodiscard]] Frame& waiting(std::size_t place) { return frames_[(oldest_ + place) % max_frames]; }
    [[nodiscard]] Step settled(Step step);
    void note_answer(Instant now);
    [[nodiscard]] Step given_up();
    [[nodiscard]] Step begin_sync();
    [[nodiscard]] Step sync();

    LineSettings line_;
    std::array<Frame, max_frames> frames_{}; ///< ring
    std::size_t oldest_ = 0;
    std::size_t size_ = 0;
    Frame current_;
    std::string announced_;
    std::uint32_t sum_ = 0;
    State state_ = State::idle;
    Instant announced_at_{};
    Instant deadline_{};
    Duration patience_ = least_patience; ///< grows while nothing at all is answered in time
    int tries_ = 0;
    int syncs_ = 0;
    std::size_t sync_ = 0; ///< which inquiry
    bool echoed_ = false;
    bool disputed_ = false; ///< a refusal came while the line was syncing: of the inquiry, or of current()
    bool proven_ = false;
    bool sent_ = false;  ///< current() has gone out
    bool stray_ = false; ///< a word on a frame that was given up may still come
};

} // namespace linefeed::protocol
