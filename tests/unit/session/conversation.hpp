// A conversation with a session: the printer's bytes go in, everything the host sends is gathered as text, and the
// other effects are told as a story.
#pragma once

#include "session/session.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::session {

/// Pages of records `^0=MR<no>TAB<text>CR`, `per_page` each.
template <typename Text>
std::vector<std::unique_ptr<RecordPage>> make_pages(std::uint32_t first, std::uint32_t last, std::uint32_t per_page,
                                                    const Text& text_of) {
    std::vector<std::unique_ptr<RecordPage>> pages;
    for (std::uint64_t number = first; number <= last; ++number) {
        if (pages.empty() || pages.back()->ends.size() == per_page) {
            pages.push_back(std::make_unique<RecordPage>());
            pages.back()->first = RecordNumber{static_cast<std::uint32_t>(number)};
        }
        RecordPage& page = *pages.back();
        page.frames += "^0=MR" + std::to_string(number) + "\t" + text_of(static_cast<std::uint32_t>(number)) + "\r";
        page.ends.push_back(static_cast<std::uint32_t>(page.frames.size()));
    }
    return pages;
}

inline std::string plain_text(std::uint32_t number) {
    return "record " + std::to_string(number);
}

class Conversation {
public:
    explicit Conversation(const SessionSettings& settings = {}, const feeder::FeederPlan& plan = {},
                          FrameObserver* observer = nullptr)
        : session(settings, plan, observer) {}

    void connect() { session.on_connected(now, effects), settle(); }
    void receive(std::string_view bytes) { session.on_received(bytes, now, effects), settle(); }
    void close() { session.on_closed(now, effects), settle(); }
    void grant(std::uint32_t first, std::uint32_t last) { grant(first, last, last); }
    void grant(std::uint32_t first, std::uint32_t last, std::uint32_t durable_through) {
        session.on_granted(RecordRange::closed(RecordNumber{first}, RecordNumber{last}), RecordNumber{durable_through},
                           now, effects);
        settle();
    }
    void refuse(feeder::OutcomeCode why) { session.on_refused(why, now, effects), settle(); }
    void durable(std::uint32_t through) { session.on_durable(RecordNumber{through}, now, effects), settle(); }
    void settled() { session.on_settled(now, effects), settle(); }
    void storage_failed() { session.on_storage_failed(now, effects), settle(); }
    void page(const RecordPage& page) {
        ++pages_lent;
        session.on_page(&page, now, effects);
        settle();
    }
    void stop() { session.request_stop(now, effects), settle(); }
    void wait(Duration time) {
        now += time;
        session.on_time(now, effects);
        settle();
    }
    /// Jumps to the next wake-up.
    void wake() {
        const auto at = session.next_wake();
        ASSERT_TRUE(at.has_value());
        now = std::max(now, *at);
        session.on_time(now, effects);
        settle();
    }
    void written() { session.on_written(now, effects), settle(); }

    /// Everything the host has sent since the last call, CR shown as line end.
    std::string sent() {
        std::string text;
        text.swap(sent_);
        for (char& byte : text) {
            byte = byte == '\r' ? '\n' : byte;
        }
        return text;
    }
    std::string story() {
        std::string text;
        text.swap(story_);
        return text;
    }
    /// Brings a run of `first`…`last` to the state printing with everything at hand.
    void print(const std::vector<std::unique_ptr<RecordPage>>& pages) {
        const std::uint32_t first = pages.front()->first.value();
        const std::string last = std::to_string(pages.back()->range().last().value());
        connect();
        receive("^0=RS2\t5\t0\t0\t0\t0\r");
        receive("^0=VS1\t1\t1\t1\t1\t1\t1\t1\t1\t1\tS1\r^0=JLA\r^0=SM256\t0\t0\t0\t1\r^0=SM256\t0\t0\t0\t1\r^0="
                "CC0\t0\t1000\r");
        grant(first, pages.back()->range().last().value());
        receive("^0=SM256\t0\t0\t0\t1\r^0=SM256\t0\t0\t" + last + "\t1\r");
        for (const auto& each : pages) {
            page(*each);
        }
        const std::uint64_t loaded = session.feeder().refill().level().value() - 1;
        receive("^0=SM256\t" + std::to_string(loaded) + "\t0\t" + last + "\t1\r");
        wake(); // !GO comes a moment later
        receive("^0=RS2\t6\t0\t0\t0\t0\r");
        ASSERT_EQ(session.feeder().phase(), feeder::Phase::printing);
        sent_.clear();
        story_.clear();
    }

    Instant now{std::chrono::seconds{1}};
    Session session;
    Effects effects;
    bool writes_complete_at_once = true; ///< else with written()
    std::size_t writes = 0;
    std::size_t largest_write = 0; ///< pieces
    std::vector<RecordsWritten> records_written;
    std::size_t pages_lent = 0;
    std::size_t pages_released = 0;
    bool ended = false;
    bool closed = false;
    feeder::Outcome outcome;

private:
    /// Carries the effects out as a link would.
    void settle() {
        while (!effects.empty()) {
            const Effects now_due = effects;
            effects.clear();
            for (const Effect& effect : now_due) {
                carry_out(effect);
            }
        }
    }
    void carry_out(const Effect& effect) {
        ASSERT_FALSE(closed) << "after CloseLink";
        std::ostringstream told;
        if (std::holds_alternative<Write>(effect)) {
            ++writes;
            const WritePieces pieces = session.pieces();
            largest_write = std::max(largest_write, pieces.size());
            for (const std::string_view piece : pieces) {
                ASSERT_FALSE(piece.empty());
                sent_ += piece;
            }
            if (writes_complete_at_once) {
                session.on_written(now, effects);
            }
        } else if (const auto* release = std::get_if<ReleasePage>(&effect)) {
            ++pages_released;
            told << "release page " << release->page->first;
        } else if (const auto* records = std::get_if<RecordsWritten>(&effect)) {
            records_written.push_back(*records);
        } else if (std::holds_alternative<CloseLink>(effect)) {
            closed = true;
            told << "close";
        } else {
            std::visit([&told](const auto& it) { tell(told, it); }, effect);
        }
        if (const auto* end = std::get_if<feeder::End>(&effect)) {
            ASSERT_FALSE(ended) << "ended twice";
            ended = true;
            outcome = end->outcome;
        }
        if (!told.str().empty()) {
            story_ += (story_.empty() ? "" : "; ") + told.str();
        }
    }
    template <typename T>
    static void tell(std::ostream& out, const T& effect) {
        if constexpr (std::is_constructible_v<feeder::Action, T>) {
            out << feeder::Action{effect};
        }
    }

    std::string sent_;
    std::string story_;
};

} // namespace linefeed::session
