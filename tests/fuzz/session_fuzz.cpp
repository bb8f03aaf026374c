// A session that prints on a simulated printer, over a line that does what the input says, byte by byte. It never
// breaks, sends its records in order and none before its intent, ends once and gives every page back. A line without
// faults has all printed. With CRC32, whatever is damaged on the way, the records are printed once and in order,
// nothing is called printed that is not, and nothing with a wrong text.
#include "base/assert.hpp"
#include "protocol/frame_decoder.hpp"
#include "session/line_fit.hpp"
#include "session/session.hpp"
#include "simulator/printer_model.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace {

using namespace linefeed;
using session::Effects;

constexpr std::uint32_t records = 24;
constexpr std::uint32_t open_records = 4; ///< of a run before, which the printer still prints

std::string text_of(std::uint32_t number) {
    return "record " + std::to_string(number);
}

RecordPage page_of_all() {
    RecordPage page{RecordNumber{1}, {}, {}};
    for (std::uint32_t number = 1; number <= records; ++number) {
        page.frames += "^0=MR" + std::to_string(number) + "\t" + text_of(number) + "\r";
        page.ends.push_back(static_cast<std::uint32_t>(page.frames.size()));
    }
    return page;
}

/// What the first byte of the input chooses.
struct Choice {
    bool crc;
    bool prints_open_run;
    bool echo;
    bool length;
    bool text; ///< bytes below 0x80 are said to the host in the printer's place

    explicit Choice(std::uint8_t byte)
        : crc((byte & 1U) != 0)
        , prints_open_run((byte & 2U) != 0)
        , echo((byte & 4U) != 0)
        , length((byte & 8U) != 0)
        , text((byte & 16U) != 0) {}
};

session::SessionSettings settings_of(const Choice& choice) {
    session::SessionSettings settings;
    settings.line = {.bytes_per_second = 11520, .crc = choice.crc};
    session::fit_to_line(settings, text_of(records).size() + 10);
    return settings;
}

feeder::FeederPlan plan_of(const Choice& choice) {
    feeder::FeederPlan plan;
    if (choice.prints_open_run) {
        plan.open = feeder::OpenRun{.first = RecordNumber{1},
                                    .printed_through = RecordNumber{0},
                                    .issued_through = RecordNumber{open_records},
                                    .serial_number = "104711",
                                    .total_before = 0,
                                    .last_printed_before = RecordNumber{0},
                                    .last = RecordNumber{records}};
        plan.take_over = true;
    }
    return plan;
}

simulator::PrinterSettings printer_of(const Choice& choice) {
    simulator::PrinterSettings settings;
    settings.depth = 8;
    settings.echo_on = choice.echo;
    settings.length_on = choice.length;
    return settings;
}

class Line {
public:
    explicit Line(const Choice& choice)
        : choice_(choice)
        , model_(printer_of(choice), now_)
        , session_(settings_of(choice), plan_of(choice)) {
        if (choice.prints_open_run) {
            to_printer_ = "^0=CM" + std::to_string(records) + "\r" +
                          page_.frames.substr(0, page_.ends[open_records - 1]) + "^0!GO\r";
            reach();
            to_host_.clear();
        }
        session_.on_connected(now_, effects_);
        settle();
    }
    /// Nothing but time has been in the input: products come, until the job is done.
    void print_all() {
        for (int i = 0; i < 400 && !ended_; ++i) {
            carry();
            print_go();
        }
        LINEFEED_ASSERT(outcome_ == feeder::OutcomeCode::finished && printed_through_ == RecordNumber{records});
    }
    void end() {
        tell_text();
        session_.on_closed(now_, effects_);
        settle();
        LINEFEED_ASSERT(ended_ && closed_ && pages_lent_ == pages_released_);
    }
    void step(std::uint8_t byte) {
        if (byte < 0x80) {
            said_ += choice_.text ? std::string{static_cast<char>(byte)} : std::string{};
            return;
        }
        tell_text();
        const std::uint8_t what = byte & 0x0FU;
        const auto place = static_cast<std::size_t>((byte >> 4U) & 7U);
        switch (what) {
        case 0:
        case 1:
            damage(to_printer_, place * 5, what == 0 ? 0x01 : 0x40);
            break;
        case 2:
        case 3:
            damage(to_host_, std::max(to_host_.size(), place + 2) - place - 2, what == 2 ? 0x02 : 0x80);
            break;
        case 4:
            to_printer_.erase(0, place == 0 ? std::string::npos : place);
            break;
        case 5:
            to_host_.erase(0, place == 0 ? std::string::npos : place);
            break;
        case 6:
            hear(place == 0 ? to_host_.size() : place * 3);
            break;
        case 7:
            print_go();
            break;
        case 8:
            pass(std::chrono::milliseconds{10 << place});
            break;
        case 9:
            if (place == 7) {
                session_.request_stop(now_, effects_);
            } else if (place == 6) {
                session_.on_storage_failed(now_, effects_);
            } else if (place == 5) {
                model_.press(protocol::Action::stop_print, now_);
            } else if (place == 4) {
                model_.open_cover(now_);
            }
            settle();
            break;
        case 10:
            for (std::size_t i = 0; i <= place; ++i) {
                print_go();
                carry();
            }
            break;
        case 11:
            reach(); // what the printer says then waits for the next
            break;
        default:
            carry();
            break;
        }
    }
    [[nodiscard]] static bool only_carries(std::uint8_t byte) { return byte >= 0x80 && (byte & 0x0FU) > 11; }

private:
    static void damage(std::string& bytes, std::size_t place, int bits) {
        if (!bytes.empty()) {
            char& byte = bytes[place % bytes.size()];
            byte = static_cast<char>(byte ^ bits);
        }
    }
    /// What is under way arrives, there and back, until both are silent; then the host's next wake-up.
    void carry() {
        for (int i = 0; i < 40 && !closed_ && !(to_printer_.empty() && to_host_.empty()); ++i) {
            reach();
            hear(to_host_.size());
        }
        if (const auto at = session_.next_wake(); at && !closed_) {
            pass(std::clamp<Duration>(*at - now_, Duration{0}, std::chrono::seconds{3}));
        }
    }
    void reach() {
        std::string bytes;
        bytes.swap(to_printer_);
        std::string_view rest = bytes;
        for (auto result = decoder_.next(rest); !std::holds_alternative<std::monostate>(result);
             result = decoder_.next(rest)) {
            if (const auto* const frame = std::get_if<protocol::Frame>(&result)) {
                now_ += std::chrono::microseconds{100};
                model_.receive(simulator::ConnectionId{1}, *frame, now_);
                take_effects();
            }
        }
    }
    void hear(std::size_t bytes) {
        const std::string heard = to_host_.substr(0, bytes);
        to_host_.erase(0, bytes);
        if (!heard.empty() && !closed_) {
            session_.on_received(heard, now_, effects_);
            settle();
        }
    }
    void tell_text() {
        if (!said_.empty() && !closed_) {
            session_.on_received(std::exchange(said_, {}), now_, effects_);
            settle();
        }
    }
    void pass(Duration time) {
        now_ += time;
        model_.advance(now_);
        take_effects();
        if (!closed_) {
            session_.on_time(now_, effects_);
            settle();
        }
    }
    void print_go() {
        now_ += std::chrono::milliseconds{20};
        model_.advance(now_);
        static_cast<void>(model_.print_go(now_));
        take_effects();
    }
    void take_effects() {
        for (const simulator::Effect& effect : model_.effects()) {
            if (const auto* const reply = std::get_if<simulator::Reply>(&effect)) {
                to_host_ += reply->bytes;
            } else if (const auto* const print = std::get_if<simulator::Printed>(&effect)) {
                judge(*print);
            }
        }
        model_.clear_effects();
    }
    /// Damage can make one right record of another without CRC32, and what is said in the printer's place is no damage.
    [[nodiscard]] bool is_judged() const { return choice_.crc && !choice_.text; }
    void judge(const simulator::Printed& print) {
        if (print.source != simulator::PrintSource::record) {
            return;
        }
        LINEFEED_ASSERT(!is_judged() || print.number == printed_through_.next());
        printed_through_ = print.number;
        if (print.text != text_of(print.number.value())) {
            wrong_.push_back(print.number);
        }
    }
    void judge_called_printed(RecordNumber first, RecordNumber through) const {
        if (is_judged()) {
            LINEFEED_ASSERT(through <= printed_through_);
            LINEFEED_ASSERT(std::ranges::none_of(
                wrong_, [=](RecordNumber number) { return first <= number && number <= through; }));
        }
    }
    /// As a link and a ledger that are quick.
    void settle() {
        while (!effects_.empty()) {
            const Effects due = effects_;
            effects_.clear();
            for (const session::Effect& effect : due) {
                LINEFEED_ASSERT(!closed_);
                carry_out(effect);
            }
        }
    }
    void carry_out(const session::Effect& effect) {
        if (std::holds_alternative<session::Write>(effect)) {
            for (const std::string_view piece : session_.pieces()) {
                to_printer_ += piece;
            }
            session_.on_written(now_, effects_);
        } else if (std::holds_alternative<feeder::BeginRun>(effect)) {
            begin_run();
        } else if (const auto* const adopt = std::get_if<feeder::AdoptRun>(&effect)) {
            grant(RecordNumber{1}, adopt->sent_through);
        } else if (const auto* const intent = std::get_if<feeder::AskIntent>(&effect)) {
            durable_through_ = intent->through;
            session_.on_durable(durable_through_, now_, effects_);
        } else if (const auto* const confirm = std::get_if<feeder::ConfirmPrinted>(&effect)) {
            judge_called_printed(RecordNumber{1}, confirm->through);
        } else if (const auto* const settle = std::get_if<feeder::Settle>(&effect)) {
            take_down(*settle);
            session_.on_settled(now_, effects_);
        } else if (const auto* const written = std::get_if<session::RecordsWritten>(&effect)) {
            LINEFEED_ASSERT(written->records.first() == sent_through_.next());
            sent_through_ = written->records.last();
            LINEFEED_ASSERT(sent_through_ <= durable_through_);
        } else if (std::holds_alternative<session::ReleasePage>(effect)) {
            ++pages_released_;
        } else if (const auto* const end = std::get_if<feeder::End>(&effect)) {
            LINEFEED_ASSERT(!ended_);
            ended_ = true;
            outcome_ = end->outcome.code;
            LINEFEED_ASSERT(!is_judged() || outcome_ != feeder::OutcomeCode::finished ||
                            printed_through_ == RecordNumber{records});
        } else if (std::holds_alternative<session::CloseLink>(effect)) {
            closed_ = true;
        }
    }
    void take_down(const feeder::Settle& settle) {
        if (!settle.verdict.printed.empty()) {
            settled_through_ = settle.verdict.printed.last();
            judge_called_printed(settle.verdict.printed.first(), settled_through_);
        }
        in_doubt_ = in_doubt_ || !settle.verdict.in_doubt.empty();
    }
    void begin_run() {
        if (in_doubt_ || settled_through_ >= RecordNumber{records}) {
            session_.on_refused(in_doubt_ ? feeder::OutcomeCode::records_in_doubt
                                          : feeder::OutcomeCode::nothing_to_print,
                                now_, effects_);
        } else {
            grant(settled_through_.next(), settled_through_);
        }
    }
    void grant(RecordNumber first, RecordNumber sent_through) {
        sent_through_ = sent_through;
        durable_through_ = RecordNumber{open_records};
        session_.on_granted(RecordRange::closed(first, RecordNumber{records}), durable_through_, now_, effects_);
        session_.on_page(&page_, now_, effects_);
        ++pages_lent_;
    }

    const RecordPage page_ = page_of_all();
    Choice choice_;
    Instant now_{std::chrono::seconds{1}};
    simulator::PrinterModel model_;
    protocol::FrameDecoder decoder_; ///< of the printer
    session::Session session_;
    Effects effects_;
    std::string to_printer_;
    std::string to_host_;
    std::string said_;
    RecordNumber sent_through_{};
    RecordNumber settled_through_{}; ///< surely printed
    bool in_doubt_ = false;          ///< a record before
    RecordNumber durable_through_{};
    RecordNumber printed_through_{};    ///< on the tape
    std::vector<RecordNumber> wrong_{}; ///< printed with a text that is not theirs
    feeder::OutcomeCode outcome_{};
    std::size_t pages_lent_ = 0;
    std::size_t pages_released_ = 0;
    bool ended_ = false;
    bool closed_ = false;
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) {
        return 0;
    }
    Line line{Choice{data[0]}};
    for (std::size_t i = 1; i < size; ++i) {
        line.step(data[i]);
    }
    if (std::all_of(data + 1, data + size, Line::only_carries)) {
        line.print_all();
    }
    line.end();
    return 0;
}
