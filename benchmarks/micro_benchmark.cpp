// The parts of the refill path one by one: what each costs per record, per answer, per refill. Without arguments
// google-benchmark measures times; `--repeat N` only carries out every part N times, for callgrind to count the
// instructions of repeat<…>(), which do not depend on the noise of the machine (bench_micro.py).
#include "feed/print_job.hpp"
#include "protocol/frame_decoder.hpp"
#include "protocol/frame_encoder.hpp"
#include "protocol/messages.hpp"
#include "session/session.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <iostream>
#include <string>
#include <vector>

namespace {

using namespace linefeed;

constexpr std::uint32_t depth = 256;
constexpr std::uint32_t block = 16; ///< records of a refill
constexpr Duration beat = std::chrono::milliseconds{8};
constexpr std::uint32_t job_records = 4'000'000'000; ///< more than any measurement gets through

/// One answer `=SM`, from its bytes to the message.
class DecodeMailStatus {
public:
    static constexpr const char* name = "DecodeMailStatus";
    void step() {
        std::string_view bytes = "^0=SM256\t240\t1234567\t2000000\t1\r";
        const auto frame = decoder_.next(bytes);
        const auto message = protocol::parse_message(std::get<protocol::Frame>(frame), protocol::EscapeMode::backslash);
        benchmark::DoNotOptimize(std::get<protocol::MailStatus>(message).last_printed);
    }

private:
    protocol::FrameDecoder decoder_;
};

/// One record of one field of 30 characters, from UTF-8 to the ready frame.
class EncodeRecord {
public:
    explicit EncodeRecord(protocol::Charset charset)
        : encoder_({charset}, protocol::EscapeMode::backslash) {
        frame_.reserve(protocol::max_record_bytes);
    }
    void step() {
        frame_.clear();
        encoder_.append(frame_, RecordNumber{1234567}, std::array{std::string_view{"SN-1234567 Größe XL ABCDEFGHIJK"}})
            .value();
        benchmark::DoNotOptimize(frame_.data());
    }

private:
    protocol::MailRecordEncoder encoder_;
    std::string frame_;
};
struct EncodeLatin1 : EncodeRecord {
    static constexpr const char* name = "EncodeLatin1";
    EncodeLatin1()
        : EncodeRecord(protocol::Charset::latin1) {}
};
struct EncodeUnicodeHex : EncodeRecord {
    static constexpr const char* name = "EncodeUnicodeHex";
    EncodeUnicodeHex()
        : EncodeRecord(protocol::Charset::unicode_hex) {}
};

/// A printer that says of itself what a feeder wants to hear, and how much is printed.
struct Printer {
    std::uint32_t printed = 0;
    std::uint32_t sent = 0;
    bool printing = false;

    [[nodiscard]] protocol::MachineStatus machine() const {
        protocol::MachineStatus status;
        status.nozzle = protocol::NozzleState::open;
        status.machine = printing ? protocol::MachineState::printing : protocol::MachineState::ready_to_print;
        return status;
    }
    [[nodiscard]] protocol::MailStatus mail(bool stop_set) const {
        return {depth, sent - printed, RecordNumber{printed}, RecordNumber{stop_set ? job_records : 0}, true, {}};
    }
};

/// One `=SM` in the feeder: the report, its plausibility, the rate, and a refill of 16 records.
class FeederRefill {
public:
    static constexpr const char* name = "FeederRefill";
    FeederRefill()
        : feeder_({}, {}) {
        feeder::Actions actions;
        feeder_.start(now_, actions);
        while (feeder_.phase() != feeder::Phase::printing) {
            answer(actions);
        }
    }
    void step() {
        now_ += beat;
        printer_.printed += block;
        feeder::Actions actions;
        feeder_.on_mail_status(printer_.mail(true), now_, actions);
        for (const feeder::Action& action : actions) {
            if (const auto* intent = std::get_if<feeder::AskIntent>(&action)) {
                feeder::Actions none;
                feeder_.on_durable(intent->through, now_, none);
            } else if (const auto* send = std::get_if<feeder::SendRecords>(&action)) {
                printer_.sent = send->range.last().value();
            }
        }
        LINEFEED_ASSERT(printer_.sent >= printer_.printed + block); // it does refill
        benchmark::DoNotOptimize(actions.size());
    }

private:
    void answer(feeder::Actions& actions) {
        const feeder::Actions asked = actions;
        actions.clear();
        now_ += beat;
        for (const feeder::Action& action : asked) {
            if (const auto* inquire = std::get_if<feeder::Inquire>(&action)) {
                answer(inquire->what, actions);
            } else if (const auto* command = std::get_if<feeder::Command>(&action)) {
                printer_.printing = printer_.printing || command->what == protocol::Action::start_print;
            } else if (std::holds_alternative<feeder::SetStopAt>(action)) {
                stop_set_ = true;
            } else if (const auto* send = std::get_if<feeder::SendRecords>(&action)) {
                printer_.sent = send->range.last().value();
            } else if (std::holds_alternative<feeder::BeginRun>(action)) {
                const auto all = RecordRange::closed(RecordNumber{1}, RecordNumber{job_records});
                feeder_.on_granted(all, RecordNumber{2 * depth}, now_, actions);
                feeder_.on_supplied(all.last(), now_, actions);
            }
        }
        feeder_.on_time(now_, actions);
    }
    void answer(protocol::Parameter what, feeder::Actions& actions) {
        switch (what) {
        case protocol::Parameter::RS:
            feeder_.on_machine_status(printer_.machine(), now_, actions);
            return;
        case protocol::Parameter::SM:
            feeder_.on_mail_status(printer_.mail(stop_set_), now_, actions);
            return;
        case protocol::Parameter::CC:
            feeder_.on_counters({0, 0, printer_.printed}, now_, actions);
            return;
        default:
            feeder_.on_lost_answer(what, now_, actions);
        }
    }

    feeder::Feeder feeder_;
    Printer printer_;
    bool stop_set_ = false;
    Instant now_{};
};

/// The slices of a refill, from the pages at hand to the pieces of a gather write.
class StageRefill {
public:
    static constexpr const char* name = "StageRefill";
    StageRefill()
        : pages_(benchmarks::make_pages(records)) {
        for (const RecordPage& page : pages_) {
            window_.add(&page);
        }
    }
    void step() {
        next_ = next_ + 2 * block > records ? 1 : next_ + block;
        window_.stage({RecordNumber{next_}, RecordCount{block}}, outbox_);
        static_cast<void>(outbox_.begin_write());
        benchmark::DoNotOptimize(outbox_.pieces().size());
        outbox_.write_done();
    }

private:
    static constexpr std::uint32_t records = session::max_pages * benchmarks::records_of_page;
    std::vector<RecordPage> pages_;
    session::PageWindow window_;
    session::Outbox outbox_;
    std::uint32_t next_ = 1;
};

/// The whole way of a refill in the session: the bytes of `=SM` in, the pieces to write and the confirmation out, then
/// the next inquiry. Includes what the printer does for it, which is little. The pages are the same few over and over,
/// under new numbers.
class SessionRefill {
public:
    static constexpr const char* name = "SessionRefill";
    SessionRefill()
        : session_({}, {})
        , pages_(benchmarks::make_pages(session::max_pages * benchmarks::records_of_page)) {
        session::Effects effects;
        session_.on_connected(now_, effects);
        carry_out(effects);
        while (session_.feeder().phase() != feeder::Phase::printing) {
            pass_time();
        }
    }
    void step() {
        while (mail_asked_ == 0) {
            pass_time();
        }
        --mail_asked_;
        printer_.printed += block;
        answers_.clear();
        protocol::append_message(answers_, printer_.mail(true));
        receive();
    }

private:
    void pass_time() {
        now_ = std::max(now_, session_.next_wake().value_or(now_));
        session::Effects effects;
        session_.on_time(now_, effects);
        carry_out(effects);
    }
    void receive() {
        session::Effects effects;
        session_.on_received(answers_, now_, effects);
        carry_out(effects);
    }
    void carry_out(session::Effects& effects) {
        while (!effects.empty()) {
            session::Effects more;
            answers_.clear();
            for (const session::Effect& effect : effects) {
                if (std::holds_alternative<session::Write>(effect)) {
                    for (const std::string_view piece : session_.pieces()) {
                        take(piece);
                    }
                    session_.on_written(now_, more);
                } else if (std::holds_alternative<feeder::BeginRun>(effect)) {
                    const auto all = RecordRange::closed(RecordNumber{1}, RecordNumber{job_records});
                    session_.on_granted(all, RecordNumber{2 * depth}, now_, more);
                    for (RecordPage& page : pages_) {
                        session_.on_page(&page, now_, more);
                    }
                } else if (const auto* intent = std::get_if<feeder::AskIntent>(&effect)) {
                    session_.on_durable(intent->through, now_, more);
                } else if (const auto* release = std::get_if<session::ReleasePage>(&effect)) {
                    RecordPage& page =
                        pages_[(release->page->first.value() / benchmarks::records_of_page) % session::max_pages];
                    page.first = page.first + RecordCount{session::max_pages * benchmarks::records_of_page};
                    session_.on_page(&page, now_, more);
                }
            }
            effects = more;
            if (!answers_.empty()) {
                session_.on_received(answers_, now_, effects);
            }
        }
    }
    /// What the printer makes of the bytes: inquiries are short, and only `?SM` waits for step().
    void take(std::string_view piece) {
        if (piece.starts_with("^0=MR")) {
            printer_.sent = session_.feeder().refill().sent_through().value();
            return;
        }
        while (!piece.empty()) {
            const std::string_view frame = piece.substr(0, piece.find('\r') + 1);
            piece.remove_prefix(frame.size());
            if (frame == "^0?SM\r" && printer_.printing) {
                ++mail_asked_;
            } else if (frame == "^0?SM\r") {
                protocol::append_message(answers_, printer_.mail(stop_set_));
            } else if (frame == "^0?RS\r") {
                protocol::append_message(answers_, printer_.machine());
            } else if (frame == "^0?VS\r") {
                protocol::append_message(answers_, protocol::VersionInfo{}, protocol::EscapeMode::backslash);
            } else if (frame == "^0?JL\r") {
                protocol::append_message(answers_, protocol::JobName{}, protocol::EscapeMode::backslash);
            } else if (frame == "^0?CC\r") {
                protocol::append_message(answers_, protocol::Counters{0, 0, printer_.printed});
            } else if (frame == "^0!GO\r") {
                printer_.printing = true;
            } else if (frame.starts_with("^0=CM")) {
                stop_set_ = true;
            }
        }
    }

    session::Session session_;
    std::vector<RecordPage> pages_;
    Printer printer_;
    std::string answers_;
    bool stop_set_ = false;
    int mail_asked_ = 0;
    Instant now_{};
};

template <typename Part>
void measure(benchmark::State& state) {
    Part part;
    for (auto _ : state) {
        part.step();
    }
}

template <typename Part>
[[gnu::noinline]] void repeat(Part& part, std::uint32_t times) {
    benchmark::DoNotOptimize(Part::name); // or the compiler would make one function of those that look alike
    for (std::uint32_t i = 0; i < times; ++i) {
        part.step();
    }
}

template <typename... Parts>
void repeat_all(std::uint32_t times) {
    const auto one = [times]<typename Part>(Part part) {
        part.step(); // what is done once only does not count
        repeat(part, times);
    };
    (one(Parts{}), ...);
}

template <typename... Parts>
void register_all() {
    (benchmark::RegisterBenchmark(Parts::name, measure<Parts>), ...);
}

} // namespace

int main(int argc, char** argv) {
    using namespace std::string_view_literals;
    if (argc == 3 && argv[1] == "--repeat"sv) {
        std::uint32_t times = 0;
        const std::string_view text = argv[2];
        std::from_chars(text.data(), text.data() + text.size(), times);
        repeat_all<DecodeMailStatus, EncodeLatin1, EncodeUnicodeHex, FeederRefill, StageRefill, SessionRefill>(times);
        return 0;
    }
    benchmark::Initialize(&argc, argv);
    register_all<DecodeMailStatus, EncodeLatin1, EncodeUnicodeHex, FeederRefill, StageRefill, SessionRefill>();
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
