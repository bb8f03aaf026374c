// One printer as the service sees it: which job is on it, and the thread that carries out the operator's orders: asks
// how far other jobs came, arms, prints run after run, and writes down why it ended. It starts nothing by itself.
#pragma once

#include "config/settings.hpp"
#include "daemon/job_facts.hpp"
#include "daemon/job_run.hpp"
#include "daemon/line_use.hpp"
#include "daemon/operations.hpp"
#include "daemon/preflight.hpp"
#include "daemon/printer_watch.hpp"
#include "printer/printer_commands.hpp"
#include "printer/task.hpp"
#include "service/event_log.hpp"
#include "service/follower.hpp"
#include "service/spool_access.hpp"
#include "store/ledger_keeper.hpp"

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace linefeed::service {

using daemon::JobFacts;
using daemon::name_of;
using daemon::phase_of;
using daemon::read_facts;

/// The settings in force, and which printer of them it is about.
using SharedSettings = std::shared_ptr<const config::Settings>;

/// What all lines share. Must outlive them.
struct LineServices {
    daemon::RunThreads threads;
    spool::Spool& spool; ///< for JobRun; everything else goes through `access`
    SpoolAccess& access;
    EventLog& events;
    /// The line has nothing to do any more, and nobody has stopped it; called on its thread.
    std::function<void(const std::string& printer)> on_idle;
    /// The next job of the queue is on the line from now on (Line::take_follower()), to follow the one at work without
    /// a stop; absent = none may, for now. Called on the line's thread; does not wait for anybody's orders.
    std::function<std::optional<JobFacts>(const std::string& printer, const FollowerWanted& wanted)> claim_follower;
};

/// What stands on a job while it is on the line, and so what is found if the service does not get to write more.
inline constexpr const char* interrupted_words =
    "the service ended while this job was on the line: what is in the printer may "
    "still be printed; resume it to find out and to go on";

/// How the last job on the line ended.
struct Ending {
    spool::JobId job{};
    feeder::Outcome outcome;
    std::string words;       ///< why, and what to do
    bool said = false;       ///< all is in the words: those of the outcome are not needed
    bool noise_only = false; ///< the next run may go on at once (daemon::NoisePatience)
};

enum class StartedBy { person, itself };

/// Flow: construct; start() and stop() as the operator wants. Destroying it stops the line and waits for the truth.
class Line {
public:
    /// What is remembered of the printer.
    struct Past {
        bool held = false;           ///< as by hold(), or a job has waited there before the service was started
        std::string serial_number{}; ///< of the machine; empty = not known yet
        std::optional<spool::PrinterMemory> memory{};
    };
    Line(const LineServices& services, std::string printer, SharedSettings settings, Past past);
    ~Line();
    Line(const Line&) = delete;
    Line& operator=(const Line&) = delete;

    // Any thread; those that talk to the printer wait for its answers
    /// For the next start.
    void use(SharedSettings settings);
    /// Begins to arm the job as soon as `write_down` has written a ticket of this printer that says so; until then
    /// it is on the line already, for all who look. FailureKind::stopped if the line is busy, or held and nobody has
    /// asked for it; or as `write_down` fails.
    [[nodiscard]] Result<void> start(spool::JobId job, StartedBy who, const std::function<Result<void>()>& write_down);
    /// `job` is to follow the job `behind` without a stop, as soon as `write_down` has written a ticket that says so;
    /// until then it is on the line already, for all who look. FailureKind::stopped if that is not at work any more, is
    /// being stopped, or nothing may start by itself; or as `write_down` fails.
    [[nodiscard]] Result<void> take_follower(const spool::Job& job, spool::JobId behind,
                                             const std::function<Result<void>()>& write_down);
    /// Begins to stop what is armed or printed.
    void request_stop();
    /// As request_stop(); and from now on nothing starts by itself until an operator starts something.
    void hold();
    /// Nothing starts by itself until an operator starts something; what is on the line goes on.
    void hold_queue();
    [[nodiscard]] bool held() const;
    /// From now on nothing is started, nor the printer looked at. Does not wait.
    void close();
    /// Waits until what is armed or printed now is not any more. How the last job ended, if there was one.
    [[nodiscard]] std::optional<Ending> wait_until_idle();
    /// The job that is armed or printed, and where it stands.
    struct Active {
        spool::JobId job{};
        daemon::JobPhase phase = daemon::JobPhase::arming;
    };
    [[nodiscard]] std::optional<Active> active() const;
    /// active(); behind it the job that is to follow it, and the one before it until the ledger says that it is over.
    [[nodiscard]] std::vector<Active> on_line() const;
    [[nodiscard]] bool idle() const { return !active(); }
    /// Without its queue.
    [[nodiscard]] daemon::PrinterView view();
    [[nodiscard]] Result<std::vector<daemon::Finding>> preflight();
    /// See printer::acknowledge().
    [[nodiscard]] Result<void> acknowledge(std::uint32_t error);
    /// See daemon::Operations::accept_printer().
    [[nodiscard]] Result<void> accept(const std::string& serial_number);
    /// Carries out one of printer::tasks(); `arguments` and the answer are JSON. What disturbs the feeding or loses
    /// what is in the printer is refused while a job is on the line, and a job that is started meanwhile waits for the
    /// end of it: FailureKind::stopped. `check` says whether what empties the FIFO may be done, asked once no job can
    /// start.
    [[nodiscard]] Result<std::string> carry_out(const printer::Task& task, std::string_view arguments,
                                                const std::function<Result<void>()>& check);
    /// A conversation of its own with the printer. `alone`: refused while a job is on the line, and no job starts
    /// meanwhile.
    [[nodiscard]] Result<void> talk(bool alone, const std::function<Result<void>(printer::PrinterClient&)>& words);
    /// Holds the panel for so long from now, or releases it.
    [[nodiscard]] Result<void> hold_panel(std::optional<Duration> time);
    /// That of the settings; an automatic one as the printer has told, which is asked if it has not yet and no job is
    /// on the line. Automatic still if it does not tell.
    [[nodiscard]] protocol::Profile profile();
    [[nodiscard]] const std::string& printer() const { return printer_; }
    [[nodiscard]] const daemon::LineMeters& meters() const { return meters_; }
    [[nodiscard]] const daemon::FrameHistory& frames() const { return frames_; }

private:
    // line.cpp: the thread and its orders
    void serve();
    [[nodiscard]] std::optional<std::chrono::steady_clock::time_point> next_look() const;
    [[nodiscard]] SharedSettings settings() const;
    void event(std::string_view kind, std::optional<spool::JobId> job, std::string message,
               std::optional<RecordNumber> record = {});

    // line_printer.cpp: the printer besides printing
    [[nodiscard]] Result<std::shared_ptr<void>> reserve();
    [[nodiscard]] std::shared_ptr<void> undisturbed();
    [[nodiscard]] Result<printer::ClientSettings> client_settings() const;

    // line_look.cpp: which machine it is, and what state it is in
    [[nodiscard]] protocol::Profile known_profile(const config::PrinterSettings& own) const;
    [[nodiscard]] std::string known_serial_number() const;
    /// What a look at it is for: a job that is to start there, or nothing yet.
    struct Purpose {
        bool may_be_printing = false;
        daemon::RecordFacts records{};
    };
    [[nodiscard]] std::vector<daemon::Finding> look_at_printer(const printer::ClientSettings& client,
                                                               const Purpose& purpose);
    [[nodiscard]] std::optional<protocol::VersionInfo> look_for_identity(const printer::ClientSettings& client);
    void glance();
    void learn_identity(const std::optional<protocol::VersionInfo>& version);
    void remember(const protocol::VersionInfo& version);
    void remember_probe(std::string_view found);
    void write_memory(const spool::PrinterMemory& memory);
    [[nodiscard]] std::optional<bool> keeps_stop_at() const;
    [[nodiscard]] std::vector<std::string> printers_of_same_machine(const std::string& serial_number);
    void hear(const daemon::PreflightFacts& facts);
    void hear(const printer::Look& look);
    void hear(const daemon::RunProgress& progress);

    // line_printing.cpp: from the order to its end
    void print(spool::JobId job);
    [[nodiscard]] Result<Ending> print_runs(spool::JobId job);
    [[nodiscard]] bool is_stop_requested() const;
    [[nodiscard]] Result<daemon::JobRunSettings> run_settings(const spool::Job& job);
    /// Of all runs behind one order.
    struct Means {
        daemon::JobRunSettings settings;
        daemon::NoisePatience patience;
        FollowerWanted follower;
    };
    [[nodiscard]] Ending run(const JobFacts& facts, RecordRange wanted, const std::optional<store::OpenIssue>& open,
                             Means& means);
    void watch(daemon::JobRun& run, const std::function<void()>& meanwhile);
    void take_notice(const feeder::Notice& notice, spool::JobId job);

    // line_conclude.cpp: how jobs end
    [[nodiscard]] static std::string words_of(const Ending& ending);
    void conclude(const Ending& ending);
    void close_job(spool::JobId job, const std::string& words);

    // line_chain.cpp: one job behind the other without a stop
    [[nodiscard]] static FollowerWanted follower_wanted(const spool::Job& job, const daemon::JobRunSettings& settings);
    [[nodiscard]] bool takes_follower(spool::JobId behind) const;
    [[nodiscard]] spool::JobId at_work() const;
    void look_after_chain(daemon::JobRun& run, const FollowerWanted& wanted);
    void follow(const daemon::RunProgress& progress);
    [[nodiscard]] bool goes_on_with_follower();
    void look_for_follower(daemon::JobRun& run, const daemon::RunProgress& progress, FollowerWanted wanted);
    void conclude_earlier(const std::optional<std::string>& words);
    void let_go_of_follower(const Ending& ending, const std::string& words);

    // line_checks.cpp: what comes before a run
    [[nodiscard]] Result<std::optional<Ending>> ask_about_others(const spool::Job& job);
    void take_note_of(spool::JobId other);
    [[nodiscard]] Result<std::optional<Ending>> check_identity(const spool::Job& job);
    [[nodiscard]] Result<std::optional<Ending>> check_printer(const spool::Job& job, bool may_be_printing);
    [[nodiscard]] std::optional<Ending> tell(const std::vector<daemon::Finding>& findings, spool::JobId job);

    LineServices services_;
    std::string printer_;
    daemon::LineMeters meters_;
    daemon::FrameHistory frames_;

    mutable std::mutex mutex_; ///< for what follows
    mutable std::condition_variable changed_;
    SharedSettings settings_;
    std::optional<spool::JobId> active_; ///< ordered, or under way: the job at work
    struct Follower {
        spool::JobId job{};
        RecordRange records;
    };
    std::optional<Follower> follower_;      ///< claimed to follow without a stop
    std::optional<spool::JobId> finishing_; ///< the job before that at work, until the ledger says that it is over
    std::uint64_t orders_ = 0;              ///< so many so far
    bool written_down_ = false;             ///< the order may be carried out
    bool checking_ = false;                 ///< preflight
    std::uint32_t reserved_ = 0; ///< for so many commands that no job may meet: the next one waits for their end
    std::uint32_t talks_ = 0;    ///< so many go on that somebody has asked for: no glance at the printer meanwhile
    bool stop_requested_ = false;
    bool held_ = false; ///< stopped by an operator
    bool closing_ = false;
    daemon::JobRun* run_ = nullptr;      ///< under way
    std::optional<RecordRange> records_; ///< of the job at work
    bool supply_low_ = false;
    std::optional<Ending> last_ending_;
    /// As last heard of, by whatever way.
    struct Heard {
        std::int64_t at_ns = 0; ///< wall time; 0 = never
        std::optional<protocol::MachineStatus> machine;
        std::optional<protocol::VersionInfo> version;
        std::optional<std::uint32_t> total_prints;
    };
    Heard heard_;
    std::string known_serial_number_; ///< of the machine that jobs may start on; empty = not known yet
    std::optional<spool::PrinterMemory> memory_;
    std::optional<std::chrono::steady_clock::time_point> looked_at_; ///< as idle; absent = never, or in use since
    std::optional<daemon::LinkState> link_;                          ///< by the last look; absent as looked_at_
    std::uint32_t failed_looks_ = 0;                                 ///< in a row

    std::shared_ptr<printer::PanelHold> panel_;

    // The thread's own
    daemon::PrinterWatch watch_;
    std::chrono::steady_clock::time_point claim_at_{}; ///< not before: there was nothing to claim

    std::mutex conversations_; ///< short ones, one at a time, besides printing: the printer may serve no more

    std::mutex panel_orders_; ///< one at a time holds or releases the panel, also while the printer is talked to

    std::thread thread_;
};

} // namespace linefeed::service
