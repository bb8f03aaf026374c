// A feeder, a printer and a ledger, with everything between them that may go wrong, from one seed.
#pragma once

#include "ledger_double.hpp"
#include "printer_double.hpp"
#include "story.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <random>

namespace linefeed::feeder {
/// Which things may go wrong.
struct Faults {
    bool link = false;           ///< lost, with whatever is on the way
    bool host_crash = false;     ///< linefeed dies; what was not durable is forgotten
    bool power = false;          ///< the printer's
    bool errors = false;         ///< of the printer
    bool operator_stops = false; ///< at the panel
    bool restarts = false;       ///< stopped and at once started again at the panel, in the middle of a run
    bool requests = false;       ///< linefeed is asked to stop
    bool broken_counter = false; ///< `?CC` is not answered
    bool slow_source = false;    ///< the records are read while they are printed, and nobody knows how many come
};

class Line {
public:
    Line(std::uint32_t seed, const Faults& faults, PrinterDouble::StopPointHabit habit)
        : random_(seed)
        , faults_(faults)
        , printer_(habit)
        , ledger_(records)
        , imported_(faults.slow_source ? 0 : records)
        , end_known_(!faults.slow_source)
        , take_over_(seed % 2 == 0) {}

    void run() {
        for (int runs = 0; runs < 200 && !ledger_.done(); ++runs) {
            faults_end_ = runs > 20;
            if (faults_end_) {
                printer_.repair();
            }
            one_run();
            if (testing::Test::HasFatalFailure()) {
                return;
            }
            between_runs();
            decide_doubts();
        }
        ASSERT_TRUE(ledger_.done()) << "the job does not come to its end";
        judge_tape();
    }
    [[nodiscard]] std::uint64_t doubts() const { return doubts_; }
    /// The end of the story.
    [[nodiscard]] std::string trace() const {
        std::string lines;
        constexpr std::size_t shown = 150;
        for (std::size_t i = trace_.size() > shown ? trace_.size() - shown : 0; i < trace_.size(); ++i) {
            lines += trace_[i] + "\n";
        }
        return lines;
    }

private:
    static constexpr std::uint32_t records = 60;
    static constexpr std::uint32_t most_records = 1000; ///< as far as anybody knows before the end is read

    template <typename... Parts>
    void note(const Parts&... parts) {
        std::ostringstream line;
        (line << ... << parts);
        trace_.push_back(line.str());
    }

    bool chance(std::uint32_t one_in) { return random_() % one_in == 0; }
    std::uint32_t draw(std::uint32_t below) { return static_cast<std::uint32_t>(random_() % below); }
    bool fault(bool possible, std::uint32_t one_in) { return possible && !faults_end_ && chance(one_in); }

    void one_run() {
        FeederSettings settings;
        settings.stop_timeout = std::chrono::milliseconds{200};
        settings.finish_timeout = std::chrono::milliseconds{100};
        FeederPlan plan{.open = ledger_.open_run(), .doubt_blocks = true, .take_over = take_over_};
        if (plan.open && plan.open->last == RecordNumber{records}) {
            plan.open->last = last_known();
        }
        feeder_ = std::make_unique<Feeder>(settings, plan);
        running_ = false;
        ended_ = false;
        to_printer_.clear();
        to_host_.clear();
        to_ledger_.clear();
        act([this](Actions& out) { feeder_->start(now_, out); });
        for (int step = 0; step < 20000 && !ended_; ++step) {
            one_step();
            if (testing::Test::HasFatalFailure()) {
                return;
            }
        }
        ASSERT_TRUE(ended_) << "the run hangs in phase " << static_cast<int>(feeder_->phase());
        while (!to_ledger_.empty()) {
            ledger_takes_one();
        }
    }

    void one_step() {
        now_ += std::chrono::microseconds{draw(1500)};
        if (const auto wake = feeder_->next_wake(); wake && *wake <= now_) {
            act([this](Actions& out) { feeder_->on_time(now_, out); });
        }
        if (faults_.slow_source && chance(4)) {
            source_goes_on();
        }
        switch (draw(8)) {
        case 0:
        case 1:
            printer_takes_one();
            break;
        case 2:
        case 3:
            host_takes_one();
            break;
        case 4:
            ledger_takes_one();
            break;
        case 5:
            print_go();
            break;
        case 6:
            printer_.finish_print();
            break;
        default:
            something_happens();
            break;
        }
        ASSERT_FALSE(printer_.overfull());
    }

    void print_go() {
        const std::uint32_t before = printer_.total();
        printer_.print_go();
        if (printer_.total() != before) {
            note("prints ", printer_.last_printed());
        }
    }

    /// The feeder has seen the stop point stand while the printer prints.
    bool stop_point_seen() const {
        return feeder_->phase() == Phase::printing && feeder_->mail().stop_at != RecordNumber{} &&
               feeder_->refill().printed_through() >= feeder_->refill().range().first();
    }

    void something_happens() {
        if (fault(faults_.link, 150)) {
            lose_link();
        } else if (fault(faults_.host_crash, 150)) {
            crash();
        } else if (fault(faults_.power, 150)) {
            note("power");
            printer_.power_cycle();
            lose_link();
        } else if (fault(faults_.errors, 100)) {
            printer_.fail();
        } else if (fault(faults_.operator_stops, 60)) {
            note("operator stops");
            printer_.stop();
        } else if (fault(faults_.restarts && stop_point_seen(), 60)) {
            note("stopped and started again");
            printer_.stop();
            printer_.start();
        } else if (fault(faults_.requests, 100)) {
            act([this](Actions& out) { feeder_->request_stop(now_, out); });
        }
    }

    /// Some of what was on the way still arrives.
    void lose_link() {
        note("link lost");
        for (std::uint32_t arrive = draw(12); arrive > 0; --arrive) {
            printer_takes_one();
        }
        to_printer_.clear();
        to_host_.clear();
        act([this](Actions& out) { feeder_->on_link_lost(out); });
    }

    void crash() {
        note("linefeed dies");
        for (std::uint32_t arrive = draw(12); arrive > 0; --arrive) {
            printer_takes_one();
        }
        for (std::uint32_t durable = draw(4); durable > 0; --durable) {
            ledger_takes_one();
        }
        to_ledger_.clear();
        ended_ = true;
    }

    /// The line does not stand still because linefeed does.
    void between_runs() {
        for (std::uint32_t steps = draw(20); steps > 0; --steps) {
            chance(2) ? print_go() : printer_.finish_print();
        }
        if (fault(faults_.power, 10)) {
            note("power");
            printer_.power_cycle();
        }
        if (chance(2)) {
            printer_.repair();
        }
    }

    /// The operator looks at the products, and knows.
    void decide_doubts() {
        for (std::uint32_t number = 1; number <= records; ++number) {
            if (ledger_.fate(number) == Fate::in_doubt) {
                ++doubts_;
                ledger_.fate(number) = on_tape(number) > 0 ? Fate::skipped : Fate::unused;
            }
        }
    }

    std::int64_t on_tape(std::uint32_t number) const {
        return std::count(printer_.tape().begin(), printer_.tape().end(), number);
    }

    void judge_tape() {
        for (std::uint32_t number = 1; number <= records; ++number) {
            ASSERT_EQ(on_tape(number), 1) << "record " << number;
        }
    }

    // What the feeder wants done.

    template <typename Fact>
    void act(const Fact& fact) {
        Actions actions;
        fact(actions);
        for (const Action& action : actions) {
            ASSERT_FALSE(ended_) << "after the end: " << action;
            note("feeder: ", action);
            carry_out(action);
        }
    }

    void carry_out(const Action& action) {
        if (const auto* send = std::get_if<SendRecords>(&action)) {
            for (std::uint32_t number = send->range.first().value(); number <= send->range.last().value(); ++number) {
                ASSERT_EQ(ledger_.fate(number), Fate::open) << "sent without a durable intent: " << number;
                to_printer_.emplace_back(SendRecords{RecordRange{RecordNumber{number}, RecordCount{1}}});
            }
        } else if (std::holds_alternative<End>(action)) {
            ended_ = true;
            last_words();
        } else if (std::holds_alternative<Settle>(action) || std::holds_alternative<BeginRun>(action) ||
                   std::holds_alternative<AdoptRun>(action) || std::holds_alternative<AskIntent>(action) ||
                   std::holds_alternative<ConfirmPrinted>(action)) {
            to_ledger_.push_back(action);
        } else if (!std::holds_alternative<Notice>(action)) {
            to_printer_.push_back(action);
        }
    }

    /// A session writes its last commands before it closes.
    void last_words() {
        while (!to_printer_.empty()) {
            printer_takes_one();
        }
    }

    void printer_takes_one() {
        if (to_printer_.empty()) {
            return;
        }
        const Action action = to_printer_.front();
        note("printer takes ", action);
        to_printer_.pop_front();
        if (const auto* inquire = std::get_if<Inquire>(&action)) {
            answer(inquire->what);
        } else if (const auto* command = std::get_if<Command>(&action)) {
            printer_.take(*command);
        } else if (const auto* stop = std::get_if<SetStopAt>(&action)) {
            printer_.take(*stop);
        } else if (const auto* send = std::get_if<SendRecords>(&action)) {
            printer_.take_record(send->range.first().value());
        } else if (const auto* marker = std::get_if<SendEndMarker>(&action)) {
            printer_.take_record(marker->number.value());
        }
    }

    void answer(protocol::Parameter what) {
        const protocol::MailStatus mail =
            what == protocol::Parameter::SM ? printer_.mail_status(chance(3)) : protocol::MailStatus{};
        const std::uint32_t total = printer_.total();
        const protocol::MachineStatus status = printer_.status();
        note("printer says: ", status.machine == protocol::MachineState::printing ? "printing" : "stands", ", error ",
             status.error.raw, ", SM ", mail.entries, ' ', mail.last_printed, ' ', mail.stop_at, ' ',
             mail.last_print_finished, ", total ", total);
        to_host_.emplace_back([this, what, mail, total, status](Actions& out) {
            switch (what) {
            case protocol::Parameter::RS:
                feeder_->on_machine_status(status, now_, out);
                break;
            case protocol::Parameter::SM:
                feeder_->on_mail_status(mail, now_, out);
                break;
            case protocol::Parameter::CC:
                if (faults_.broken_counter) {
                    feeder_->on_lost_answer(what, now_, out);
                } else {
                    feeder_->on_counters({.product = {}, .stop_after = {}, .total = total}, now_, out);
                }
                break;
            case protocol::Parameter::VS: {
                protocol::VersionInfo version;
                version.serial_number = "S1";
                feeder_->on_version(version, now_, out);
                break;
            }
            default:
                feeder_->on_job_name({}, now_, out);
                break;
            }
        });
    }

    void host_takes_one() {
        if (!to_host_.empty()) {
            const auto fact = to_host_.front();
            to_host_.pop_front();
            act(fact);
        }
    }

    // The ledger.

    void ledger_takes_one() {
        if (to_ledger_.empty()) {
            return;
        }
        const Action action = to_ledger_.front();
        const bool waits = std::holds_alternative<BeginRun>(action) && ledger_.next_printable().value_or(0) > imported_;
        if (waits) {
            imported_ = ended_ ? imported_ : ledger_.next_printable().value_or(0); // no run begins without records
        }
        note("ledger takes ", action);
        to_ledger_.pop_front();
        if (const auto* begin = std::get_if<BeginRun>(&action)) {
            grant(*begin);
        } else if (const auto* adopted = std::get_if<AdoptRun>(&action)) {
            ledger_.confirm(adopted->printed_through.value());
            begin_printing(); // the earlier run goes on
        } else if (const auto* intent = std::get_if<AskIntent>(&action)) {
            intent_wanted_ = intent->through.value();
            ledger_.issue(std::min(intent_wanted_, imported_));
            tell([this](Actions& out) { feeder_->on_durable(ledger_.issued(), now_, out); });
        } else if (const auto* printed = std::get_if<ConfirmPrinted>(&action)) {
            ledger_.confirm(printed->through.value());
        } else if (const auto* settle = std::get_if<Settle>(&action)) {
            ledger_.settle(*settle);
            intent_wanted_ = settle->earlier_run ? intent_wanted_ : 0;
            tell([this](Actions& out) { feeder_->on_settled(now_, out); });
        }
    }

    template <typename Fact>
    void tell(const Fact& fact) {
        if (!ended_) {
            act(fact);
        }
    }

    void grant(const BeginRun& begin) {
        if (ledger_.grant(begin, imported_)) {
            begin_printing();
        } else { // the truth about the earlier run left nothing to print
            tell([this](Actions& out) { feeder_->on_refused(OutcomeCode::nothing_to_print, out); });
        }
    }

    void begin_printing() {
        running_ = true;
        intent_wanted_ = 0;
        const RecordRange range = ledger_.granted();
        const RecordNumber last = range.last() == RecordNumber{records} ? last_known() : range.last();
        tell([&](Actions& out) {
            feeder_->on_granted(RecordRange::closed(range.first(), last), ledger_.issued(), now_, out);
        });
        supply();
    }

    // The source.

    RecordNumber last_known() const { return RecordNumber{end_known_ ? records : most_records}; }

    void supply() {
        tell([this](Actions& out) {
            feeder_->on_supplied(std::min(RecordNumber{imported_}, ledger_.granted().last()), now_, out);
        });
    }

    /// More records are durable, or there are no more.
    void source_goes_on() {
        if (imported_ < records) {
            imported_ = std::min(records, imported_ + draw(6));
            if (running_ && imported_ > 0) {
                supply();
                ledger_.issue(std::min({intent_wanted_, imported_, ledger_.granted().last().value()}));
                tell([this](Actions& out) { feeder_->on_durable(ledger_.issued(), now_, out); });
            }
        } else if (!end_known_) {
            note("the end is known");
            end_known_ = true;
            if (running_ && ledger_.granted().last() == RecordNumber{records}) {
                tell([this](Actions& out) { feeder_->on_end_known(RecordNumber{records}, now_, out); });
            }
        }
    }

    std::mt19937 random_;
    Faults faults_;
    PrinterDouble printer_;
    LedgerDouble ledger_;
    std::unique_ptr<Feeder> feeder_;
    Instant now_{std::chrono::seconds{1}};
    std::deque<Action> to_printer_;
    std::deque<std::function<void(Actions&)>> to_host_;
    std::deque<Action> to_ledger_;
    std::uint32_t imported_;          ///< records that are durable
    bool end_known_;                  ///< and told
    bool running_ = false;            ///< granted
    std::uint32_t intent_wanted_ = 0; ///< asked for, perhaps before the records were there
    bool take_over_ = false;
    bool ended_ = false;
    bool faults_end_ = false;
    std::uint64_t doubts_ = 0;
    std::vector<std::string> trace_;
};

} // namespace linefeed::feeder
