// The host: the program `linefeed print` as the product drives session, store and ledger (src/daemon/job_run.cpp,
// src/cli/print_command.cpp), as a process that can be paused and killed at any step, on a machine that can lose its
// power.
#pragma once

#include "context.hpp"
#include "daemon/line_use.hpp"
#include "daemon/operator_word.hpp"
#include "judge.hpp"
#include "ram_disk.hpp"
#include "random.hpp"
#include "session/session.hpp"
#include "virtual_store.hpp"
#include "wire.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace linefeed::simulation {

/// What the operator was told at the end.
struct Ending {
    feeder::OutcomeCode code = feeder::OutcomeCode::finished;
    std::vector<RecordRange> in_doubt; ///< ids, all of one job
    ScenarioJob doubted{};             ///< that job
    bool complete = false;             ///< nothing is left to print
    bool word_refused = false;         ///< "last product" says too much or too little: the products must be named
};

class Host {
public:
    Host(Context& context, Judge& judge, Wire& wire, Random random);
    ~Host();

    /// Reads the file into the spool. A violation if that fails.
    void import_jobs();
    /// The operator enters the command. Precondition: not running.
    void start(const daemon::OperatorWord& word);
    [[nodiscard]] bool running() const { return run_ != nullptr; }
    [[nodiscard]] const Ending& ending() const { return ending_; }
    [[nodiscard]] std::optional<feeder::Phase> phase() const;
    /// Records were issued whose fate the ledger does not know. Precondition: not running.
    [[nodiscard]] bool records_open() const { return records_open_; }
    /// And it remembers that some of them may have been left out.
    [[nodiscard]] bool knows_of_gap() const { return knows_of_gap_; }
    /// Nothing is left to be sent in this run.
    [[nodiscard]] bool all_sent() const;
    /// When this run has taken over an earlier one, found printing; absent = it has not.
    [[nodiscard]] std::optional<Instant> taken_over() const;

    void request_stop();
    void pause(Duration duration);
    void slow_disk(Duration duration);
    /// The process dies; `in_steps` effects later, or now.
    void kill(std::uint64_t in_steps = 0);
    void lose_power();

    // Events
    void receive(std::uint64_t connection, std::string_view bytes);
    void link_closed(std::uint64_t connection);
    void connected(std::uint64_t generation, std::uint64_t connection);
    void write_step(std::uint64_t generation);
    void store_done(std::uint64_t generation);
    void store_wake(std::uint64_t generation);
    void resume(std::uint64_t generation);
    void wake();
    /// When wake() is due; Instant::max() = not before something else happens.
    [[nodiscard]] Instant wake_at() const;

    /// The last word of the ledger, for the judge. Precondition: not running.
    void check_spool();

private:
    struct Run;
    struct Job {
        spool::JobId id{};
        RecordRange numbers;
        ScenarioJob ids{};
    };
    void import(const ScenarioJob& ids);
    [[nodiscard]] std::size_t next_job();
    void next_run();
    [[nodiscard]] bool ask_about_others();
    void offer_follower();
    void look_at_ledger(const Job& job);
    void check_spool(const Job& job);
    void end_process(feeder::OutcomeCode code);
    [[nodiscard]] bool open_spool();
    void begin_run(const std::optional<store::OpenIssue>& open, spool::JobId job, RecordRange wanted);
    void run_over();
    void die();

    // What JobRun and PrinterLink do
    template <typename Fact>
    void call(Fact&& fact);
    void carry_out();
    void on_effect(const session::Effect& effect);
    void push_cumulative();
    void begin_write();
    [[nodiscard]] bool continue_write();
    void take_replies();
    [[nodiscard]] bool is_current(std::uint64_t generation) const;
    [[nodiscard]] bool paused() const { return context_.now < paused_until_; }

    Context& context_;
    Judge& judge_;
    Wire& wire_;
    Random random_;
    std::optional<spool::Spool> spool_;
    std::vector<Job> jobs_;
    std::size_t at_work_ = 0; ///< the job that is printed
    std::optional<std::size_t> offered_;
    std::optional<spool::JobId> asked_about_; ///< by this run
    std::unique_ptr<Run> run_;
    daemon::NoisePatience patience_;
    daemon::JobRunSettings changed_by_noise_;
    session::Effects effects_;
    Ending ending_;
    daemon::OperatorWord word_;
    ScenarioJob word_for_{}; ///< the job that it is about
    bool word_counts_ = false;
    bool interrupted_ = false;
    bool records_open_ = false;
    bool knows_of_gap_ = false;
    Instant paused_until_{};
    std::uint64_t refusals_before_ = 0; ///< of the disk, as the program was started
    std::uint64_t generation_ = 0;
    std::optional<std::uint64_t> steps_to_live_;
    std::int64_t wall_ns_ = 1'700'000'000'000'000'000;
    std::string path_;
};

} // namespace linefeed::simulation
