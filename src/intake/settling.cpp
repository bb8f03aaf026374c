#include "intake/settling.hpp"

#include <charconv>
#include <chrono>

namespace linefeed::intake {

namespace {

constexpr int patience_with_empty_files = 5;

constexpr std::int64_t longest_quiet_ms = std::int64_t{24} * 60 * 60 * 1000;

/// "500ms", "2s", "1min".
std::optional<Duration> parse_time(std::string_view text) {
    std::int64_t number = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const std::string_view unit = text.substr(static_cast<std::size_t>(stop - text.data()));
    const std::int64_t unit_ms = unit == "ms" ? 1 : unit == "s" ? 1000 : unit == "min" ? 60'000 : 0;
    if (error != std::errc{} || unit_ms == 0 || number < 1 || number > longest_quiet_ms / unit_ms) {
        return std::nullopt;
    }
    return std::chrono::milliseconds{number * unit_ms};
}

} // namespace

std::optional<SettleRule> parse_settle_rule(std::string_view text) {
    constexpr std::string_view with_time = "quiet=";
    SettleRule rule;
    if (text == "rename") {
        rule.by = SettleBy::renaming;
    } else if (text == "done") {
        rule.by = SettleBy::done_mark;
    } else if (text.starts_with(with_time)) {
        const auto quiet = parse_time(text.substr(with_time.size()));
        if (!quiet) {
            return std::nullopt;
        }
        rule.quiet = *quiet;
    } else if (text != "quiet") {
        return std::nullopt;
    }
    return rule;
}

SettleDecision SettlingFile::decide(const SettleRule& rule, const FileLook& look, const std::optional<FileLook>& mark,
                                    Instant now) {
    using Kind = SettleDecision::Kind;
    if (look_ != look) {
        look_ = look;
        since_ = now;
    }
    if (look.kind == FileKind::directory) {
        return {Kind::hold, {}, "this is a directory"};
    }
    if (look.kind != FileKind::regular) {
        return {Kind::ready}; // to be refused
    }
    if (look.names > 1) {
        return {Kind::hold,
                {},
                "it has " + std::to_string(look.names) + " names (hard links): it is taken when this is the only one"};
    }
    if (open_for_writing_) {
        return {Kind::hold, {}, "it is open for writing"};
    }
    if (never_closed_ && look.size_bytes == 0) {
        return {Kind::hold, {}, "it is empty, and whoever made it has not closed it yet"};
    }
    if (mark && mark->kind == FileKind::regular && mark->changed_ns >= look.changed_ns) {
        return {Kind::ready};
    }
    if (rule.by == SettleBy::done_mark) {
        return {Kind::hold, {}, mark ? "its .done is older than its last change" : "its .done is missing"};
    }
    const bool complete_at_once = rule.by == SettleBy::renaming && !in_place_;
    const Duration quiet = complete_at_once      ? Duration{0}
                           : look.size_bytes > 0 ? rule.quiet
                                                 : rule.quiet * patience_with_empty_files;
    if (now - since_ >= quiet) {
        return {Kind::ready};
    }
    return {Kind::wait, since_ + quiet, look.size_bytes > 0 ? "it may still be written" : "it is empty so far"};
}

} // namespace linefeed::intake
