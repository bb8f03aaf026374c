// The refill and resume machine of one printer: facts and time in, actions out. It knows records by their places
// (numbering.hpp), never bytes or sockets, reads no clock and does no I/O. The sequence is the manual's own (protocol,
// section 5): identify, status, where are we, flush, stop point with read-back, fill, verify, GO, refills, stop, and
// after any stop the truth.
#pragma once

#include "base/record_number.hpp"
#include "base/time.hpp"
#include "feeder/actions.hpp"
#include "feeder/counter_proof.hpp"
#include "feeder/feeder_settings.hpp"
#include "feeder/numbering.hpp"
#include "feeder/pacing.hpp"
#include "feeder/refill.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace linefeed::feeder {

enum class Phase {
    idle,
    identifying,    ///< `?RS`, `?VS`, `?JL`
    locating,       ///< `?SM` twice, `?CC`: where is the printer?
    taking_over,    ///< found printing the earlier run: `?SM` until it is clear where to go on
    halting,        ///< found printing the earlier run: `!ST`
    opening_nozzle, ///< `!NO`
    acknowledging,  ///< `!EQ`
    granting,       ///< the ledger takes the truth down and grants records
    flushing,       ///< `!FF`
    setting_stop,   ///< `=CM`, read back
    loading,        ///< waits for the first records in memory and their intent on disk
    verifying,      ///< first fill sent: did the printer take it?
    starting,       ///< a moment for the records to be loaded, then `!GO`
    printing,
    stopping,  ///< `!ST`
    judging,   ///< stopped: `?RS`, `?SM` twice, `?CC`
    recording, ///< the ledger takes down what is surely printed, before the flush
    clearing,  ///< `!FF`, and the last look: `?RS`, `?SM` twice, `?CC`
    finishing, ///< all printed: `!EQ` for what mailing leaves behind
    ended,
};

/// Flow: start() once the connection stands; then one on_…() for each fact, and on_time() at next_wake(); each appends
/// to `out`. After End nothing more is done.
class Feeder {
public:
    Feeder(const FeederSettings& settings, const FeederPlan& plan);

    void start(Instant now, Actions& out);

    // Facts from the printer. `now` is when the answer arrived.
    /// Precondition: the state is one that the manual names, or the printer is being identified.
    void on_machine_status(const protocol::MachineStatus& status, Instant now, Actions& out);
    void on_mail_status(const protocol::MailStatus& status, Instant now, Actions& out);
    void on_counters(const protocol::Counters& counters, Instant now, Actions& out);
    void on_version(const protocol::VersionInfo& version, Instant now, Actions& out);
    void on_job_name(const protocol::JobName& job, Instant now, Actions& out);
    /// An inquiry got no answer, though the printer answers others. `?RS` and `?SM` are asked again where their answer
    /// is waited for; the rest is evidence that is missing then.
    void on_lost_answer(protocol::Parameter what, Instant now, Actions& out);
    /// This record, the last that went out, may lie in the FIFO with a damaged text: it must not be printed. What was
    /// to be sent behind it is not sent.
    void on_unproven_record(RecordNumber number, Instant now, Actions& out);
    /// The printer has confirmed one more record on a secured line, which may take long for the first fill.
    void on_proven_record(Instant now);
    /// The printer answers nothing at all.
    void on_silence(Actions& out);
    /// Answers come, but none of them secured by CRC32, which was asked for. Precondition: no frame has been proven
    /// yet, so no record has gone out.
    void on_not_secured(Actions& out);
    void on_link_lost(Actions& out);

    // Facts from the ledger and the pages.
    /// The truth is in the ledger, and `range` may be printed; intents up to `durable_through` are durable.
    void on_granted(RecordRange range, RecordNumber durable_through, Instant now, Actions& out);
    /// The granted range ends earlier than it seemed: `last` is the last record there is. Precondition: it is not
    /// behind what was supplied.
    void on_end_known(RecordNumber last, Instant now, Actions& out);
    /// No records are granted: `why` is nothing_to_print or records_in_doubt.
    void on_refused(OutcomeCode why, Actions& out);
    void on_durable(RecordNumber through, Instant now, Actions& out);
    void on_supplied(RecordNumber through, Instant now, Actions& out);
    /// A Settle is durable.
    void on_settled(Instant now, Actions& out);
    void on_storage_failed(Instant now, Actions& out);
    /// A job of `count` records may follow without a stop. Nothing comes of it where the printer, or the time that is
    /// left, does not allow that.
    void on_follower_known(RecordCount count);
    /// Its run has begun: its records lie at `places`, and the first has the number `number` in its job.
    void on_follower_begun(RecordRange places, RecordNumber number, Actions& out);

    /// Stop the line and find the truth.
    void request_stop(Instant now, Actions& out);

    void on_time(Instant now, Actions& out);
    /// When on_time() is due; absent = not before another fact.
    [[nodiscard]] std::optional<Instant> next_wake() const;

    [[nodiscard]] Phase phase() const { return phase_; }
    [[nodiscard]] const Refill& refill() const { return refill_; }
    [[nodiscard]] double rate() const { return pacing_.rate(); }
    [[nodiscard]] const Numbering& numbering() const { return numbering_; }
    /// The places of the job at work: with a follower behind it, those up to its own end; behind it, the follower's.
    [[nodiscard]] RecordRange job_places() const;
    /// As last reported, with the place of the last printed record.
    [[nodiscard]] const protocol::MailStatus& mail() const { return mail_; }
    [[nodiscard]] const protocol::MachineStatus& machine() const { return status_; }

private:
    enum class StopPoint {
        unset,     ///< not kept so far: sent again while it prints
        kept_idle, ///< read back before the start
        kept,      ///< seen to stand while the printer prints: from now on it vanishes only with a stop
        ignored,   ///< by this firmware
    };
    /// The way of the stop point from behind all records that can come to the last one.
    enum class StopMove {
        none,
        wanted,   ///< the end is known; the FIFO is being filled
        draining, ///< nothing is sent until all has arrived that was
        sent,     ///< `=CM` is on its way; nothing is sent until it is read back
    };

    /// The job that follows without a stop.
    enum class Follower {
        none,
        offered,  ///< there is one
        begins,   ///< its run is to begin
        behind,   ///< its records are sent behind those of the job; the stop point still stands at the job's end
        crossing, ///< enough of it lies in the FIFO: the stop point goes behind everything, until it prints
    };

    // feeder_time.cpp: asking and waiting, and locate_step() of feeder.cpp
    void enter(Phase phase, Instant now, Duration timeout);
    void ask(protocol::Parameter what, Instant now, Actions& out);
    void mail_answered(Instant now);
    void forget_oldest_mail();
    [[nodiscard]] bool asks_version_again(Instant now, Actions& out);
    void time_identity(Instant now);
    void counted(std::optional<std::uint32_t> total, Instant now, Actions& out);
    void counters_lost(Instant now, Actions& out);
    [[nodiscard]] bool waits_for_mail() const;
    [[nodiscard]] bool waits_for_status() const;
    void ask_later(protocol::Parameter what, Instant now);
    [[nodiscard]] bool lacks_value(const protocol::MailStatus& status);
    void locate_step(Instant now, Actions& out);
    void on_deadline(Instant now, Actions& out);
    [[nodiscard]] bool polls() const { return phase_ == Phase::printing || (phase_ == Phase::starting && !go_due_); }
    [[nodiscard]] bool has_granted_records() const { return !refill_.range().empty(); }

    // feeder_arming.cpp: from the connection to the first print
    void identified(Instant now, Actions& out);
    void located(Instant now, Actions& out);
    [[nodiscard]] bool prints_earlier_run() const;
    void locate_again(Instant now, Actions& out);
    void check_ready(Instant now, Actions& out);
    void check_errors(Instant now, Actions& out);
    [[nodiscard]] bool printed_for_another() const;
    void flushed(Instant now, Actions& out);
    void set_stop_point(Instant now, Actions& out);
    void stop_point_answered(Instant now, Actions& out);
    void try_loading(Instant now, Actions& out);
    void verify(Instant now, Actions& out);
    void go(Instant now, Actions& out);
    void start_mail(Instant now, Actions& out);
    void stands_after_go(Instant now);
    void go_again(Instant now, Actions& out);
    void start_answered(Instant now, Actions& out);
    [[nodiscard]] bool is_allowed(const protocol::PrinterError& error) const;
    [[nodiscard]] bool may_acknowledge(const protocol::PrinterError& error) const;
    [[nodiscard]] bool stops(const protocol::PrinterError& error) const;

    // feeder_takeover.cpp: found printing the earlier run
    [[nodiscard]] bool may_take_over() const;
    void begin_takeover(Instant now, Actions& out);
    void takeover_step(Instant now, Actions& out);
    [[nodiscard]] bool counter_contradicts() const;
    [[nodiscard]] std::optional<std::uint32_t> prints_of_earlier_run() const;
    [[nodiscard]] RecordNumber surely_printed() const;
    void taken_over(RecordRange range, RecordNumber durable_through, Instant now, Actions& out);
    void halt(Instant now, Actions& out);

    // feeder_printing.cpp: reports, refills and the stop point
    void plan_status(Instant now);
    void print_status(Instant now, Actions& out);
    void print_error(Instant now, Actions& out);
    void print_mail(Instant now, Actions& out);
    [[nodiscard]] bool follow(Instant now, Actions& out);
    void poll_on(Instant now);
    enum class Report {
        fits,
        damaged,    ///< or it is impossible: the next answer tells
        impossible, ///< more records than were sent
    };
    [[nodiscard]] Report judge_report();
    void note_unfinished();
    void note_restart();
    [[nodiscard]] RecordNumber printed_at_most() const;
    [[nodiscard]] bool may_have_skipped() const;
    void note_chain();
    void watch_for_missing(Instant now, Actions& out);
    void doubt_number();
    [[nodiscard]] bool take_report(Instant now, Actions& out);
    void confirm_reported(Actions& out);
    void ask_for_proof(Instant now, Actions& out);
    void confirm(RecordNumber through, Actions& out);
    [[nodiscard]] std::uint64_t prints_through(RecordNumber number) const;
    void print_counters(std::uint32_t total, Instant now, Actions& out);
    [[nodiscard]] bool stop_would_show() const;
    [[nodiscard]] bool stop_point_vanished(Instant now, Actions& out);
    void stop_suspected(Instant now, Actions& out);
    void insist_on_stop_point(Actions& out);
    void set_stop_point_again(Actions& out);
    void all_printed(Instant now, Actions& out);
    void refill_now(Actions& out);
    void send(RecordRange records, Actions& out);

    // feeder_follower.cpp: the job that follows without a stop
    [[nodiscard]] protocol::MailStatus in_places(const protocol::MailStatus& said) const;
    [[nodiscard]] bool follows() const { return follower_ == Follower::behind || follower_ == Follower::crossing; }
    [[nodiscard]] bool stops_by_itself_at(RecordNumber place) const;
    [[nodiscard]] bool follower_may_begin() const;
    void look_for_follower(Instant now, Actions& out);
    void ask_whether_counter_moves(Instant now, Actions& out);
    [[nodiscard]] bool moves_with_prints(std::optional<std::uint32_t> prints, std::uint64_t sent) const;
    void begin_follower(Actions& out);
    [[nodiscard]] RecordCount without_lone_zero(RecordCount most) const;
    [[nodiscard]] bool is_first_behind_boundary();
    [[nodiscard]] bool head_is_there() const;
    void cross_over();
    void crossed_over(Actions& out);
    void replace_stop_point(RecordNumber number);
    [[nodiscard]] Evidence with_certain_place(Evidence seen, const OpenRun& run) const;
    [[nodiscard]] Evidence as_said(Evidence seen) const;

    // feeder_supply.cpp: while the end of the run is not known
    void move_stop_point(Actions& out);
    [[nodiscard]] bool stop_point_stands() const;
    void await_new_answers();
    [[nodiscard]] bool refill_waits() const;
    void follow_stop_point(Instant now, Actions& out);
    void stop_point_moved(Instant now, Actions& out);
    void watch_supply(Actions& out);

    // feeder_stopping.cpp: from the last print or an interruption to the end
    void begin_stop(OutcomeCode cause, Instant now, Actions& out);
    void send_stop(Instant now, Actions& out);
    void stop_again(Instant now, Actions& out);
    void begin_judging(Instant now, Actions& out);
    void judge_status(Instant now, Actions& out);
    [[nodiscard]] OutcomeCode cause_of_stop() const;
    void finish(Instant now, Actions& out);
    void end(OutcomeCode code, Actions& out);

    // feeder_judging.cpp: the truth about the earlier run or this one, and the flush
    [[nodiscard]] OpenRun open_run() const;
    [[nodiscard]] Evidence evidence() const;
    void judge(Instant now, Actions& out);
    void record_printed(const Verdict& verdict, const Evidence& evidence, Instant now, Actions& out);
    void clear(Instant now, Actions& out);
    void clearing_status(Instant now, Actions& out);
    void judge_finally(Instant now, Actions& out);
    void settle(const Verdict& verdict, const Evidence& evidence, Instant now, Actions& out);
    [[nodiscard]] Verdict verdict_on(const OpenRun& run, const Evidence& evidence) const;

    FeederSettings settings_;
    FeederPlan plan_;
    Pacing pacing_;
    Refill refill_;
    Phase phase_ = Phase::idle;

    protocol::MachineStatus status_;
    Numbering numbering_;
    protocol::MailStatus said_; ///< the last `=SM`
    protocol::MailStatus mail_; ///< the same, with the place of the last printed record
    PrinterFacts facts_;

    int mail_reads_ = 0;        ///< `=SM` answers in this phase
    bool stood_ = false;        ///< the printer, by `=RS`, at the last `=SM` in this phase
    bool lacked_value_ = false; ///< the last `=SM`
    int identity_answers_missing_ = 0;
    Instant identity_asked_at_{};
    Instant identity_answered_at_{}; ///< the first of the answers
    int identity_answers_ = 0;
    struct MailAsked {
        Instant at{};
        int under_way = 0;           ///< with this one
        RecordNumber sent_through{}; ///< before it
    };
    static constexpr int max_mail_asked = 64;
    /// With more under way no proof is asked for, which takes two: half is left for the beat.
    static constexpr int max_mail_before_proof = max_mail_asked / 2 - 1;
    std::array<MailAsked, max_mail_asked> mail_asked_{}; ///< ring of the inquiries under way
    RecordNumber sent_before_inquiry_;                   ///< the one that was answered last
    RecordNumber surely_received_;                       ///< sent before the inquiry before: an answer may be so old
    std::size_t mail_oldest_ = 0;
    int mail_outstanding_ = 0;
    int counters_outstanding_ = 0;
    int answers_lost_ = 0; ///< asked for again, one after the other
    bool version_asked_again_ = false;
    bool counter_asked_again_ = false;
    bool status_outstanding_ = false;
    std::optional<Instant> deadline_; ///< of the phase
    std::optional<Instant> retry_at_;
    protocol::Parameter retry_what_ = protocol::Parameter::RS;
    Instant mail_due_{};   ///< next `?SM` while printing
    Instant status_due_{}; ///< next `?RS` while printing
    std::optional<Instant> go_due_;
    Instant go_sent_at_{};
    std::optional<int> go_again_at_read_; ///< of `=SM` in this phase, if the fill is untouched then
    std::uint32_t entries_filled_ = 0;    ///< as reported before `!GO`
    Instant stop_sent_at_{};

    bool taking_over_ = false;
    std::optional<std::uint64_t> in_printer_through_; ///< by the last `=SM`: printed + entries + 1
    RecordNumber taken_sent_through_;
    RecordNumber number_before_count_; ///< reported before `?CC` was asked

    std::int32_t acknowledged_ = 0; ///< the error that `!EQ` was sent for
    RecordNumber left_over_;        ///< last printed number that stood in the printer before this run
    bool left_over_passed_ = false; ///< the printer has reported another number since
    /// So many more records than were sent are in the printer by the last answer; absent: it fitted.
    std::optional<std::uint64_t> odd_excess_;
    /// The last number that can come from what was in the printer by the last answer while the stop point stood.
    std::uint64_t held_through_ = 0;
    /// Seen in the printer up to this number: it finds its numbers out of order if one is missing.
    std::uint64_t chained_through_ = 0;
    int missing_ = 0;                  ///< answers in a row by which records are missing
    RecordNumber said_before_;         ///< surely printed by the answer before, taken by itself
    std::uint64_t excess_of_fill_ = 0; ///< 1: its firmware counts the loaded record, too
    std::optional<std::uint32_t> total_before_;
    StopPoint stop_point_ = StopPoint::unset;
    RecordNumber stop_number_; ///< that of the stop point, as it goes out
    int stop_point_tries_ = 0;
    StopMove stop_move_ = StopMove::none;
    std::optional<RecordNumber> old_stop_point_; ///< the number before the move; the new one has not been read back
    int old_answers_left_ = 0;               ///< answers that may be from before `=CM`, or before this step of its move
    bool supply_noticed_ = false;            ///< low, and said so
    std::optional<Instant> suspected_since_; ///< the stop point vanished: nothing is sent before `?RS` has told why
    bool restarted_ = false;                 ///< stopped and started again at the printer, as records were on their way
    bool nobody_knows_ = false;              ///< at the look before the flush, which records are printed
    bool fed_by_another_ = false;            ///< by what was reported while it printed
    std::optional<RecordNumber> unproven_;   ///< on_unproven_record()
    RecordNumber broken_off_;                ///< a print that was not finished when the printer stood; 0 = none
    bool memory_lost_ = false;               ///< the reported number went back
    std::optional<Instant> all_printed_at_;
    bool marker_sent_ = false;
    bool any_sent_ = false;
    int settles_pending_ = 0; ///< Settles that the ledger has not acknowledged
    /// The look before the flush: it stands if the flush makes the printer forget its number.
    Evidence first_look_;
    std::int32_t error_noticed_ = 0;
    RecordNumber reported_through_;  ///< surely printed by the printer's number
    RecordNumber confirmed_through_; ///< of those, confirmed to the ledger
    CounterProof counter_proof_;     ///< of the reported number, where a stop would not show
    std::optional<OutcomeCode> cause_;

    Follower follower_ = Follower::none;
    RecordCount follower_records_;
    bool behind_boundary_ = false; ///< the place that was reported last
    RecordNumber boundary_;        ///< the place of the job's last record, while another follows
    RecordNumber job_first_{};     ///< the place of the first record of the job at work, behind a follower's crossing
    bool counter_moves_ = false;   ///< the total print counter, since this run began
};

} // namespace linefeed::feeder
