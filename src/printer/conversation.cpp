#include "printer/conversation.hpp"

#include "printer/message_json.hpp"

#include <algorithm>
#include <chrono>

namespace linefeed::printer {

namespace {

constexpr std::size_t max_gap_s = 3600;

/// The frames that came behind frame `at`, before the next one that was sent.
std::vector<std::string> answers_behind(const std::vector<SpokenFrame>& frames, std::size_t at) {
    std::vector<std::string> answers;
    for (std::size_t i = at + 1; i < frames.size() && !frames[i].sent; ++i) {
        answers.push_back(frames[i].raw);
    }
    return answers;
}

Result<void> check_whole(const std::vector<SpokenFrame>& frames) {
    for (const SpokenFrame& frame : frames) {
        if (frame.sent && !frame.whole) {
            return Failure{FailureKind::usage,
                           "the recording holds only the beginning of what was sent (the service keeps no records): it "
                           "cannot be said again"};
        }
    }
    return {};
}

} // namespace

std::string to_line(const Utterance& utterance) {
    Json json{{"time_ns", utterance.time_ns},
              {"direction", utterance.sent ? "sent" : "received"},
              {"bytes", escaped_bytes(utterance.bytes)}};
    if (!utterance.whole()) {
        json["size"] = utterance.size;
    }
    return json.dump();
}

Result<Utterance> read_line(std::string_view line) {
    const Json json = Json::parse(line, nullptr, false);
    const auto has = [&json](const char* name, auto is) { return json.contains(name) && is(json[name]); };
    const bool right = json.is_object() && has("time_ns", [](const Json& j) { return j.is_number_integer(); }) &&
                       has("direction", [](const Json& j) { return j == "sent" || j == "received"; }) &&
                       has("bytes", [](const Json& j) { return j.is_string(); });
    const auto bytes = right ? unescaped_bytes(json["bytes"].get<std::string>()) : std::nullopt;
    if (!bytes) {
        return Failure{FailureKind::input, "this is no line of a recorded conversation"};
    }
    Utterance utterance{json["time_ns"].get<std::int64_t>(), json["direction"] == "sent", *bytes, bytes->size()};
    if (has("size", [](const Json& j) { return j.is_number_unsigned(); })) {
        utterance.size = std::max(utterance.size, json["size"].get<std::uint64_t>());
    }
    return utterance;
}

Json to_json(const SpokenFrame& frame) {
    Json json{{"time_ns", frame.time_ns}, {"direction", frame.sent ? "sent" : "received"}};
    json.update(to_json(frame.message));
    json["words"] = in_words(frame.message);
    json["raw"] = escaped_bytes(frame.raw);
    json["whole"] = frame.whole;
    return json;
}

FrameFinder::FrameFinder(protocol::EscapeMode escapes)
    : escapes_(escapes)
    , decoders_{protocol::FrameDecoder{escapes}, protocol::FrameDecoder{escapes}} {}

void FrameFinder::add(const Utterance& utterance, const std::function<void(const SpokenFrame&)>& on_frame) {
    protocol::FrameDecoder& decoder = decoders_[utterance.sent ? 1 : 0];
    const auto take = [&](std::string_view bytes, bool whole) {
        for (auto result = decoder.next(bytes); result.index() != 0; result = decoder.next(bytes)) {
            if (const auto* const frame = std::get_if<protocol::Frame>(&result)) {
                on_frame({utterance.time_ns, utterance.sent, std::string{frame->raw},
                          protocol::parse_message(*frame, escapes_), whole});
            }
        }
    };
    take(utterance.bytes, utterance.whole());
    if (!utterance.whole()) {
        take("\r", false); // ends the beginning that was kept; nothing if it ended there
        decoder.reset();
    }
}

Result<Rerun> say_again(PrinterClient& printer, const std::vector<SpokenFrame>& frames,
                        const std::function<void(Duration)>& wait) {
    if (auto whole = check_whole(frames); !whole) {
        return whole.error();
    }
    Rerun rerun;
    printer.set_secured(false); // what was secured then brings its checksum along
    std::int64_t before_ns = frames.empty() ? 0 : frames.front().time_ns;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        if (!frames[i].sent) {
            continue;
        }
        const std::int64_t gap_ns = frames[i].time_ns - before_ns;
        before_ns = frames[i].time_ns;
        wait(std::clamp<Duration>(std::chrono::nanoseconds{gap_ns}, Duration{0}, std::chrono::seconds{max_gap_s}));
        const auto expected = answers_behind(frames, i);
        std::vector<std::string> got;
        const auto listen = [&](const protocol::Message& /*message*/, std::string_view raw) {
            got.emplace_back(raw);
            return got.size() == expected.size() ? PrinterClient::Heard::done : PrinterClient::Heard::more;
        };
        const Duration patience = expected.empty() ? Duration{0} : printer.settings().reply_timeout;
        static_cast<void>(printer.converse(frames[i].raw + '\r', listen, patience));
        if (!printer.open()) {
            return Failure{FailureKind::unreachable, printer.settings().address + ": the connection is lost"};
        }
        ++rerun.sent;
        rerun.compared += expected.size();
        for (std::size_t k = 0; k < expected.size(); ++k) {
            if (k >= got.size() || got[k] != expected[k]) {
                rerun.differences.push_back({frames[i].raw, expected[k], k < got.size() ? got[k] : std::string{}});
            }
        }
    }
    return rerun;
}

} // namespace linefeed::printer
