// The feeder under random facts in random order: it never aborts, and whatever it is told, what it wants done keeps to
// its rules.
#include "story.hpp"

#include <random>

namespace linefeed::feeder {
namespace {

using State = protocol::MachineState;

/// Checks every action against rules that are kept apart from the feeder.
class Rules {
public:
    explicit Rules(const FeederPlan& plan)
        : plan_(plan) {}

    void granted(RecordRange range, RecordNumber durable_through) {
        granted_ = true;
        range_ = range;
        durable_ = durable_through;
        asked_ = durable_through;
        sent_ = sent_ == RecordNumber{} ? range.first().previous() : sent_;
        confirmed_ = range.first().previous();
    }
    void durable(RecordNumber through) { durable_ = std::max(durable_, through); }
    void supplied(RecordNumber through) { supplied_ = std::max(supplied_, through); }
    void settled() { settled_ = true; }

    void check(const Actions& actions, const Feeder& feeder) {
        for (const Action& action : actions) {
            SCOPED_TRACE(testing::Message() << action);
            ASSERT_FALSE(ended_) << "after the end";
            std::visit([this](const auto& it) { check_one(it); }, action);
        }
        ASSERT_LE(feeder.refill().level(), feeder.refill().depth());
        ASSERT_EQ(ended_, feeder.phase() == Phase::ended);
        if (ended_) {
            ASSERT_EQ(feeder.next_wake(), std::nullopt);
        }
    }
    [[nodiscard]] int ends() const { return ends_; }
    /// Inquiries that a session has not answered yet.
    std::vector<protocol::Parameter> inquiries;
    std::size_t inquiries_at_most = 24;

private:
    void check_one(std::monostate) { FAIL() << "nothing"; }
    void check_one(const Inquire& inquire) {
        inquiries.push_back(inquire.what);
        ASSERT_LE(inquiries.size(), inquiries_at_most) << "more than a session remembers";
    }
    void check_one(const Command& command) {
        if (command.what == protocol::Action::flush_fifo) {
            ASSERT_TRUE(granted_ || settled_) << "flushed before the ledger knows the truth";
            flushed_ = true;
        }
    }
    void check_one(const SetStopAt& stop) { ASSERT_EQ(stop.number, range_.last()); }
    void check_one(const SendRecords& send) {
        ASSERT_TRUE(granted_);
        ASSERT_EQ(send.range.first(), sent_.next());
        sent_ = send.range.last();
        ASSERT_LE(sent_, std::min({range_.last(), durable_, supplied_}));
    }
    void check_one(const SendEndMarker& marker) {
        ASSERT_EQ(marker.number, range_.last().next());
        ASSERT_EQ(sent_, range_.last());
    }
    void check_one(const Settle& settle) {
        RecordNumber& before = settle.earlier_run ? plan_.open->printed_through : confirmed_;
        std::uint32_t next = before.value() + 1;
        for (const RecordRange& range : {settle.verdict.printed, settle.verdict.in_doubt, settle.verdict.unused}) {
            if (!range.empty()) {
                ASSERT_EQ(range.first().value(), next);
                next = range.last().value() + 1;
            }
        }
        ASSERT_EQ(granted_, !settle.earlier_run);
        ASSERT_EQ(settles_[settle.earlier_run ? 1 : 0], 0) << "settled already";
        if (settle.provisional) {
            flushed_ = false;
            if (!settle.verdict.printed.empty()) {
                before = settle.verdict.printed.last();
            }
        } else {
            ++settles_[settle.earlier_run ? 1 : 0];
            ASSERT_TRUE(flushed_ || settle.verdict.unused.empty()) << "unused, but perhaps still in the FIFO";
        }
    }
    void check_one(const BeginRun&) { ASSERT_FALSE(granted_); }
    void check_one(const AdoptRun& adopt) {
        ASSERT_TRUE(plan_.take_over && !granted_);
        ASSERT_LE(adopt.printed_through, adopt.sent_through);
        ASSERT_LE(adopt.sent_through, plan_.open->issued_through);
        sent_ = adopt.sent_through;
        supplied_ = adopt.sent_through;
        adopted_ = adopt.printed_through;
    }
    void check_one(const AskIntent& intent) {
        ASSERT_GT(intent.through, asked_);
        ASSERT_LE(intent.through, range_.last());
        asked_ = intent.through;
    }
    void check_one(const ConfirmPrinted& confirm) {
        ASSERT_GT(confirm.through, std::max(confirmed_, adopted_));
        ASSERT_LE(confirm.through, sent_);
        confirmed_ = confirm.through;
    }
    void check_one(const Notice& notice) { ASSERT_FALSE(describe(notice).empty()); }
    void check_one(const End& end) {
        ended_ = true;
        ++ends_;
        ASSERT_FALSE(describe(end.outcome).empty());
        ASSERT_TRUE(end.outcome.issued || sent_ == RecordNumber{} || !granted_ || sent_ == range_.first().previous());
    }

    FeederPlan plan_;
    bool granted_ = false;
    bool settled_ = false;
    bool flushed_ = false; ///< since the last look
    bool ended_ = false;
    int ends_ = 0;
    std::array<int, 2> settles_{};
    RecordRange range_;
    RecordNumber durable_;
    RecordNumber supplied_;
    RecordNumber asked_;
    RecordNumber sent_;
    RecordNumber confirmed_;
    RecordNumber adopted_;
};

class RandomFacts {
public:
    explicit RandomFacts(std::uint32_t seed)
        : random_(seed)
        , plan_(plan())
        , feeder_(settings(), plan_)
        , rules_(plan_) {}

    /// `orderly` = answers come only to inquiries, as from a session; else anything comes at any time.
    void run(bool orderly) {
        rules_.inquiries_at_most = orderly ? 24 : 1000;
        tell([this](Actions& out) { feeder_.start(now_, out); });
        for (int step = 0; step < 600 && !testing::Test::HasFatalFailure(); ++step) {
            now_ += std::chrono::milliseconds{draw(3) == 0 ? draw(300) : draw(3)};
            if (draw(2) == 0) {
                tell([this](Actions& out) { feeder_.on_time(now_, out); });
            } else if (draw(3) > 0 || !ledger_or_rare()) {
                answer(orderly);
            }
        }
        tell([this](Actions& out) { feeder_.on_link_lost(out); });
        ASSERT_EQ(rules_.ends(), 1);
    }

private:
    std::uint32_t draw(std::uint32_t below) { return static_cast<std::uint32_t>(random_() % below); }

    FeederPlan plan() {
        if (draw(2) == 0) {
            return {};
        }
        FeederPlan plan = plan_with(earlier_run(), draw(2) == 0);
        plan.take_over = draw(2) == 0;
        return plan;
    }
    FeederSettings settings() {
        FeederSettings settings;
        settings.open_nozzle = draw(2) == 0;
        return settings;
    }

    template <typename Fact>
    void tell(const Fact& fact) {
        Actions actions;
        fact(actions);
        ASSERT_NO_FATAL_FAILURE(rules_.check(actions, feeder_)) << text(actions);
    }

    /// Mostly something sensible, sometimes anything.
    std::uint32_t number() {
        const Refill& refill = feeder_.refill();
        switch (draw(8)) {
        case 0:
            return draw(400);
        case 1:
            return 0;
        case 2:
            return 77;
        default:
            return refill.range().empty() ? 150
                                          : refill.printed_through().value() +
                                                draw(static_cast<std::uint32_t>(refill.level().value()) + 1);
        }
    }

    void answer(bool orderly) {
        constexpr std::array all{protocol::Parameter::RS, protocol::Parameter::SM, protocol::Parameter::CC,
                                 protocol::Parameter::VS, protocol::Parameter::JL};
        protocol::Parameter what = all[draw(all.size())];
        auto& waiting = rules_.inquiries;
        if (orderly && !waiting.empty() && draw(40) > 0) {
            what = waiting.front();
        }
        const auto asked = std::find(waiting.begin(), waiting.end(), what);
        if (asked != waiting.end()) {
            waiting.erase(asked);
        } else if (orderly) {
            return;
        }
        if (!orderly && feeder_.phase() == Phase::granting) {
            return; // while the ledger is awaited, nothing is under way
        }
        if (draw(60) == 0) {
            tell([&](Actions& out) {
                if (draw(2) == 0) {
                    feeder_.on_silence(out);
                } else {
                    feeder_.on_lost_answer(what, now_, out);
                }
            });
            return;
        }
        switch (what) {
        case protocol::Parameter::RS:
            machine_status();
            break;
        case protocol::Parameter::SM:
            mail_status();
            break;
        case protocol::Parameter::CC:
            tell([this](Actions& out) {
                const auto total = draw(4) == 0 ? std::nullopt : std::optional<std::uint32_t>{800 + draw(300)};
                feeder_.on_counters({.product = {}, .stop_after = {}, .total = total}, now_, out);
            });
            break;
        case protocol::Parameter::VS:
            tell([this](Actions& out) {
                protocol::VersionInfo version;
                version.serial_number = draw(10) == 0 ? "S2" : "S1";
                feeder_.on_version(version, now_, out);
            });
            break;
        default:
            tell([this](Actions& out) { feeder_.on_job_name({}, now_, out); });
            break;
        }
    }

    void machine_status() {
        protocol::MachineStatus status;
        const bool running = feeder_.phase() == Phase::printing || feeder_.phase() == Phase::starting;
        status.machine = draw(12) == 0 ? static_cast<State>(1 + draw(6))
                         : running     ? State::printing
                                       : State::ready_to_print;
        constexpr std::array codes{1223U, 5043U, 1018U, 4711U, 10202U};
        status.error = {draw(12) == 0 ? raw_error(codes[draw(codes.size())], draw(4)) : 0};
        status.cover_open = draw(40) == 0;
        tell([&](Actions& out) { feeder_.on_machine_status(status, now_, out); });
    }

    void mail_status() {
        protocol::MailStatus mail;
        mail.depth = draw(30) == 0 ? draw(3) : 16;
        mail.entries = draw(3) == 0 ? draw(300) : (feeder_.phase() == Phase::verifying ? 15 : 0);
        mail.last_printed = RecordNumber{number()};
        const RecordRange range = feeder_.refill().range();
        mail.stop_at = draw(4) == 0 || range.empty() ? RecordNumber{} : range.last();
        mail.last_print_finished = draw(4) > 0;
        tell([&](Actions& out) { feeder_.on_mail_status(mail, now_, out); });
    }

    /// False if nothing came of it.
    bool ledger_or_rare() {
        switch (draw(12)) {
        case 0:
        case 1:
        case 2:
            return grant();
        case 3:
        case 4: {
            const RecordNumber through{100 + draw(400)};
            rules_.durable(through);
            tell([&](Actions& out) { feeder_.on_durable(through, now_, out); });
            return true;
        }
        case 5:
        case 6: {
            const RecordNumber through{100 + draw(400)};
            rules_.supplied(through);
            tell([&](Actions& out) { feeder_.on_supplied(through, now_, out); });
            return true;
        }
        case 7:
            rules_.settled();
            tell([this](Actions& out) { feeder_.on_settled(now_, out); });
            return true;
        case 8:
            if (draw(10) == 0) {
                tell([this](Actions& out) { feeder_.request_stop(now_, out); });
            }
            return true;
        case 9:
            if (draw(30) == 0) {
                tell([this](Actions& out) { feeder_.on_storage_failed(now_, out); });
            }
            return true;
        case 10:
            if (draw(20) == 0) {
                tell([this](Actions& out) { feeder_.on_refused(OutcomeCode::nothing_to_print, out); });
            }
            return true;
        default:
            if (draw(40) == 0) {
                tell([this](Actions& out) { feeder_.on_link_lost(out); });
            }
            return true;
        }
    }

    bool grant() {
        if (feeder_.phase() != Phase::granting) {
            return false;
        }
        const RecordRange range = RecordRange::closed(RecordNumber{1}, RecordNumber{200 + draw(100)});
        rules_.granted(range, RecordNumber{200});
        tell([&](Actions& out) { feeder_.on_granted(range, RecordNumber{200}, now_, out); });
        return true;
    }

    std::mt19937 random_;
    FeederPlan plan_;
    Feeder feeder_;
    Rules rules_;
    Instant now_{std::chrono::seconds{1}};
};

class FeederRandom : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Order, FeederRandom, testing::Bool());

TEST_P(FeederRandom, shouldKeepItsRulesWhateverItIsTold) {
    for (std::uint32_t seed = 1; seed <= 1500; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        RandomFacts facts{seed};
        facts.run(GetParam());
        if (testing::Test::HasFatalFailure()) {
            break;
        }
    }
}

} // namespace
} // namespace linefeed::feeder
