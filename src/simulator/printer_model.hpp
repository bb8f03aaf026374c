// The printer, as far as a host can tell: the states, the mailing FIFO with its numbering law, the errors, the answers,
// the files (protocol, sections 1 to 8). Pure: no I/O, no clock, no chance, no threads. Time is a parameter, so the
// same printer stands behind a socket in linefeed-sim and runs in virtual time in the simulation tests.
#pragma once

#include "protocol/frame.hpp"
#include "protocol/messages.hpp"
#include "simulator/file_system.hpp"
#include "simulator/file_transfers.hpp"
#include "simulator/job_counters.hpp"
#include "simulator/mail_fifo.hpp"
#include "simulator/output_control.hpp"
#include "simulator/print_job.hpp"
#include "simulator/printer_clock.hpp"
#include "simulator/printer_effects.hpp"
#include "simulator/printer_settings.hpp"
#include "simulator/transmitter.hpp"
#include "simulator/troubles.hpp"

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::simulator {

/// How an error shows in the bit fields of RS (protocol, section 4, RS). All sound one tone.
enum class ErrorWindow : std::uint32_t {
    error = 0x12000000,         ///< source RIP, error window
    error_of_head = 0x14000000, ///< source SDC, error window
    warning = 0x52000000,       ///< source RIP, warning window
    message = 0x9A000000,       ///< source RIP, does not switch off, message window
};

/// The number that RS shows. Precondition: code ≤ 0x01FFFFFF.
[[nodiscard]] constexpr std::int32_t error_with_window(ErrorWindow window, std::uint32_t code) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(window) | code);
}

/// What became of the product at a PrintGo.
enum class PrintGoOutcome {
    printed,
    stopped,      ///< an error stopped the printing; the product passed unprinted
    not_printing, ///< the printer was not printing; the product passed unprinted
};

/// Flow: whatever happens is told in the order of time (`now` never goes back): receive(), print_go(), the operator's
/// actions, and advance() at next_event() at the latest. After each, effects() holds what the printer did, in order;
/// the driver carries it out and calls clear_effects().
class PrinterModel {
public:
    /// The printer is powered up at `now`.
    PrinterModel(PrinterSettings settings, Instant now);

    /// A frame from a client, whole at `now`.
    void receive(ConnectionId connection, const protocol::Frame& frame, Instant now);
    /// Forgets what was agreed with that client (an announced CRC).
    void disconnected(ConnectionId connection);
    /// A product reached the sensor.
    PrintGoOutcome print_go(Instant now);
    /// Time passes.
    void advance(Instant now);
    /// When advance() has something to do; none: not before the next input.
    [[nodiscard]] std::optional<Instant> next_event() const;

    /// The operator at the panel: as `!GO`, `!ST`, `!NO`, `!NC`, `!EQ`. Nothing while a host blocks the panel (`!US`).
    void press(protocol::Action action, Instant now);
    /// Stops the printing with error 12000.
    void open_cover(Instant now);
    void close_cover(Instant now);
    /// An error of the machine, `code` 1…0x01FFFFFF, shown in an error window; stops the printing.
    void raise_error(std::uint32_t code, Instant now);
    /// The operator loads another job; at once.
    void load_job(std::string path, Instant now);
    /// The level at an input changes. One whose function is configured carries it out when it goes on.
    void set_input(protocol::Input input, bool on, Instant now);
    /// The USB stick with its files is pulled out, or put in.
    void set_stick(bool present) { transfers_.files().set_stick(present); }
    /// So often, when there is next occasion.
    void expect(Trouble trouble, std::uint32_t times) { troubles_.add(trouble, times); }
    /// Mains off and on again: connections, FIFO, stop-at, last number and modes are lost; counters stay.
    void power_cycle(Instant now);

    [[nodiscard]] const std::vector<Effect>& effects() const { return effects_; }
    void clear_effects() { effects_.clear(); }
    /// Moves them to `out`, whose old content is dropped: for a driver whose actions come back to the model.
    void take_effects(std::vector<Effect>& out) {
        out.clear();
        out.swap(effects_);
    }

    [[nodiscard]] bool printing() const { return machine_ == protocol::MachineState::printing; }
    /// A PrintGo at `now` would find a record (or the last one to print again).
    [[nodiscard]] bool record_ready(Instant now) const;
    [[nodiscard]] const MailFifo& fifo() const { return fifo_; }
    /// What `?RS` and `?SM` would say (the latter leaving habits aside).
    [[nodiscard]] protocol::MachineStatus machine_status() const;
    [[nodiscard]] protocol::MailStatus mail_status() const;
    [[nodiscard]] std::uint32_t total_prints() const { return total_prints_; }
    [[nodiscard]] const PrintJob& job() const { return job_; }
    [[nodiscard]] const FileSystem& files() const { return transfers_.files(); }
    /// The level of output 1…8: what the host has set, or the signal that the printer raises there.
    [[nodiscard]] bool output(std::size_t number) const;
    [[nodiscard]] bool panel_blocked() const { return panel_blocked_until_ && now_ < *panel_blocked_until_; }
    [[nodiscard]] bool display_on() const { return display_on_; }

private:
    /// Something that takes effect later: a job being loaded, an extern text.
    template <typename Value>
    struct Pending {
        Instant due;
        Value value;
    };

    // printer_model.cpp: machine, errors, jobs
    void power_up(Instant now);
    void lose_mailing();
    void go_forward_to(Instant now);
    void handle_event_at(Instant due);
    void change_state(protocol::MachineState machine, protocol::NozzleState nozzle, Instant now);
    void note_event(Instant now);
    void start_printing(Instant now);
    void stop_printing(Instant now);
    void open_nozzle(Instant now);
    void close_nozzle(Instant now);
    void power_on(Instant now);
    void power_off(Instant now);
    void restart(Instant now);
    void show_error(std::int32_t raw, Instant now);
    void finish_job_loading(PrintJob job);
    void show_wildcards();
    void show_extern_text(std::string text);
    [[nodiscard]] std::optional<PrintJob> job_at(const std::string& path) const;

    // printer_prints.cpp: what products get
    void print_loaded(Instant now);
    void print_without_record(PrintSource source, const std::string& text, Instant now);
    PrintGoOutcome stop_with_error(std::uint32_t code, Instant now);
    [[nodiscard]] const std::string& own_text() const;
    void begin_print(RecordNumber number, Instant now);
    void finish_print(Instant now);
    [[nodiscard]] bool is_lawful(const MailSlot& slot) const;

    // printer_commands.cpp: how frames arrive
    void receive_in_standby(const protocol::Frame& frame, ConnectionId connection, Instant now);
    [[nodiscard]] bool crc_agrees(ConnectionId connection, const protocol::Frame& frame);
    void execute(ConnectionId connection, const protocol::Frame& frame, bool secured, Instant now);
    void transfer(ConnectionId connection, const protocol::Message& message);
    void send(ConnectionId connection, std::string_view frame, bool secured);
    void send(ConnectionId connection, const protocol::Message& message, bool secured);
    [[nodiscard]] protocol::EscapeMode path_escapes(std::string_view path) const;

    // printer_actions.cpp: actions and inputs
    void act(protocol::Action action, Instant now);
    void motor_step(protocol::NozzleState from, protocol::NozzleState to, Instant now);
    void factory_reset(Instant now);
    void function_of_input(protocol::InputFunction function, Instant now);

    // printer_parameters.cpp: what clients set. A message without a take() is one that only printers send.
    void take(const protocol::ActionMessage& message, Instant now) { act(message.action, now); }
    [[nodiscard]] MailSlot* slot_for_record(Instant now);
    void take(const protocol::MailRecord& record, Instant now);
    void take(const protocol::MalformedMessage& message, Instant now);
    void take(const protocol::StopAt& stop, Instant now);
    void take(const protocol::Counters& counters, Instant now);
    void take(const protocol::CounterReset& reset, Instant now);
    void take(const protocol::CounterParameter& parameter, Instant now);
    void take(const protocol::JobName& job, Instant now);
    void take(const protocol::ExternText& text, Instant now);
    void take(const protocol::PrintParameter& parameter, Instant now);
    void take(const protocol::ClockTime& clock, Instant now);
    void take(const protocol::BlockLength& length, Instant now);
    void take(const protocol::OutputChange& change, Instant now);
    void take(const protocol::WysiwygStart& start, Instant now);
    void take(const protocol::ScriptLine& line, Instant now);

    // printer_answers.cpp: what clients ask
    void answer(ConnectionId connection, const protocol::InquiryMessage& inquiry, bool secured, Instant now);
    [[nodiscard]] std::optional<protocol::Message> simple_answer(const protocol::InquiryMessage& inquiry, Instant now);
    [[nodiscard]] protocol::MailStatus mail_status_answer();
    [[nodiscard]] protocol::Counters counters() const;
    [[nodiscard]] std::optional<protocol::Message> print_parameter(std::string_view argument) const;
    [[nodiscard]] std::vector<protocol::Message> counter_parameters(std::string_view argument) const;
    [[nodiscard]] std::vector<protocol::Message> script() const;
    [[nodiscard]] std::vector<protocol::Message> picture() const;
    [[nodiscard]] protocol::ExternalStates external_states() const;
    [[nodiscard]] protocol::InputConfiguration input_configuration() const;
    [[nodiscard]] protocol::OutputConfiguration output_configuration() const;
    [[nodiscard]] std::uint32_t speed_shown(std::uint32_t dm_per_min) const;

    static constexpr Duration panel_block = std::chrono::seconds{10}; ///< protocol, section 2, US
    static constexpr std::array<std::uint32_t, 5> default_print_parameters{5000, 0, 350, 100, 9};

    PrinterSettings settings_;
    Transmitter transmitter_;
    MailFifo fifo_;
    PrinterClock clock_;
    Log<protocol::ErrorEntry> error_list_;
    Log<protocol::EventEntry> event_list_;
    Troubles troubles_;
    FileTransfers transfers_;
    CounterSet counters_;
    OutputControl outputs_;
    std::vector<Effect> effects_;
    Instant now_;

    protocol::MachineState machine_ = protocol::MachineState::standby;
    protocol::NozzleState nozzle_ = protocol::NozzleState::invalid;
    bool cover_open_ = false;
    bool job_changed_ = true; ///< another job, or a change within it, that no `?RS` has told yet
    protocol::PrinterError error_;
    PrintJob job_;
    std::optional<PrintJob> script_; ///< being sent: begun and not ended
    std::string job_text_;           ///< what the loaded job prints of its own: static texts and wildcards
    std::string extern_text_;        ///< empty: the job's own
    std::uint32_t inputs_ = 0;       ///< a bit for each Input
    bool display_on_ = true;
    std::uint32_t wysiwyg_start_ = 0;

    RecordNumber last_printed_;
    RecordNumber stop_at_;
    bool last_print_finished_ = true;
    std::optional<RecordNumber> previous_; ///< printed last in the sequence under way; none: a new one begins
    bool numbered_ = false; ///< the last record that the job printed had a number: the FIFO may not get empty
    std::optional<std::string>
        last_zero_text_; ///< of the last record, if its number was 0: printed again when nothing comes
    std::uint32_t product_counter_ = 0;
    std::uint32_t stop_after_ = 0;
    std::uint32_t total_prints_ = 0;
    std::uint32_t print_gos_ = 0;            ///< since power-up
    protocol::MailStatus stale_mail_status_; ///< what the next `?SM` gets with that habit
    std::array<std::uint32_t, 5> print_parameters_ = default_print_parameters; ///< `=PR` types 1…5

    std::optional<Instant> print_ends_;
    std::optional<Instant> nozzle_done_;
    std::optional<Instant> initialised_;
    std::optional<Instant> switches_off_;
    std::optional<Instant> fonts_loaded_; ///< until then nothing is printed
    std::optional<Instant> panel_blocked_until_;
    std::optional<Pending<PrintJob>> pending_job_;
    std::optional<Pending<std::string>> pending_extern_text_;
    std::map<ConnectionId, std::optional<std::uint32_t>>
        awaited_crcs_; ///< announced by `=NR`, one per client; none: one that could not be read
};

} // namespace linefeed::simulator
