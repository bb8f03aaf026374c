// The settings, described once: which keys each section has, where their values live, what they may be, and when a
// change takes effect. Reader, dump, environment, reload and the schema test all walk over this description, so that
// none of them can know a key that another does not.
//
// A visitor has value(key, member, kind, rules), section(key, struct) and named(key, vector of structs with names,
// rules).
#pragma once

#include "config/collections.hpp"
#include "config/reload.hpp"
#include "config/settings.hpp"

#include <concepts>
#include <type_traits>

namespace linefeed::config {

/// What holds for a key besides the kind of its value.
struct Rules {
    Applies applies = Applies::at_once; ///< of named(): that an element is taken away
    bool required = false;
};

template <typename S, typename Section>
concept Same = std::same_as<std::remove_const_t<S>, Section>;

inline const Choice<ErrorPolicy> error_policies{
    {{"report", ErrorPolicy::report}, {"acknowledge", ErrorPolicy::acknowledge}, {"stop", ErrorPolicy::stop}}};
inline const Choice<protocol::Charset> charsets{{{"latin1", protocol::Charset::latin1},
                                                 {"windows-1252", protocol::Charset::windows_1252},
                                                 {"unicode-hex", protocol::Charset::unicode_hex}}};
inline const Choice<LogLevel> log_levels{{{"trace", LogLevel::trace},
                                          {"debug", LogLevel::debug},
                                          {"info", LogLevel::info},
                                          {"warning", LogLevel::warning},
                                          {"error", LogLevel::error}}};
inline constexpr std::uint64_t max_number = 0xFFFF'FFFF;
inline constexpr std::size_t max_name = 64;       ///< bytes
inline constexpr std::size_t max_elements = 1000; ///< printers, layouts, folders, error numbers: of each
inline constexpr std::size_t max_error_numbers = 1000;
inline constexpr std::size_t max_columns = 255; // fields of a record
inline constexpr std::chrono::milliseconds shortest_timeout{100};
inline constexpr std::chrono::minutes longest_timeout{10};

template <typename V, Same<QueueSettings> S>
void visit(V& v, S& s) {
    v.value("autostart", s.autostart, Flag{});
    v.value("chain", s.chain, Choice<Chain>{{{"stop", Chain::stop}, {"seamless", Chain::seamless}}});
}

template <typename V, Same<PrinterSettings> S>
void visit(V& v, S& s) {
    using namespace std::chrono_literals;
    v.value("address", s.address, AddressValue{}, {Applies::printer_idle, true});
    v.value("profile", s.profile, ProfileValue{}, {Applies::printer_idle});
    v.value("job_file", s.job_file, Maybe{TextValue{200}});
    v.value("open_nozzle", s.open_nozzle, Flag{});
    v.value("errors", s.errors, MapOf<ErrorNumberKey, Choice<ErrorPolicy>>{error_policies, max_error_numbers});
    v.value("poll_min", s.pacing.poll_min, DurationValue{400us, 100ms});
    v.value("poll_max", s.pacing.poll_max, DurationValue{1ms, 1s});
    v.value("expected_rate", s.expected_rate, Maybe{Whole<std::uint32_t>{1, 10'000}});
    v.value("connect_timeout", s.connect_timeout, DurationValue{shortest_timeout, longest_timeout});
    v.value("reply_timeout", s.reply_timeout, DurationValue{shortest_timeout, longest_timeout});
    v.value("watch_interval", s.watch_interval, DurationValue{0us, 1h});
    v.section("queue", s.queue);
}

template <typename V, Same<LayoutSettings> S>
void visit(V& v, S& s) {
    v.value("columns", s.columns, ListOf{TextValue{1000, true}, max_columns});
    v.value("table", s.table, Maybe{TextValue{}});
    v.value("query", s.query, Maybe{TextValue{100'000}});
    v.value("delimiter", s.delimiter, Maybe{DelimiterValue{}});
    v.value("header", s.header, Flag{});
    v.value("skip_bad", s.skip_bad, Flag{});
    v.value("encoding", s.encoding, charsets);
    v.value("column_encodings", s.column_encodings, MapOf<ColumnKey, Choice<protocol::Charset>>{charsets, max_columns});
    v.value("graphics", s.graphics, ListOf{TextValue{1000, true}, max_columns});
    v.value("graphics_folder", s.graphics_folder, Maybe{PathValue{}});
    v.value("base", s.base, Whole<std::uint32_t>{0, max_number});
    v.value("mirrored", s.mirrored, Flag{});
    v.value("orientation", s.orientation, Maybe{OrientationValue{}});
}

/// What is wrong with a pattern for file names.
[[nodiscard]] std::string pattern_problem(std::string_view text);

template <typename V, Same<FolderSettings> S>
void visit(V& v, S& s) {
    using namespace std::chrono_literals;
    v.value("path", s.path, PathValue{}, {Applies::at_once, true});
    v.value("layout", s.layout, TextValue{max_name}, {Applies::at_once, true});
    v.value("printer", s.printer, TextValue{max_name}, {Applies::at_once, true});
    v.value("pattern", s.pattern, TextValue{255, false, pattern_problem});
    v.value("autostart", s.autostart, Flag{});
    v.value("watch", s.watch, Choice<Watch>{{{"inotify", Watch::inotify}, {"poll", Watch::poll}}});
    v.value(
        "settle", s.settle,
        Choice<Settle>{
            {{"in-place", Settle::in_place}, {"rename", Settle::rename}, {"done-companion", Settle::done_companion}}});
    v.value("poll_interval", s.poll_interval, DurationValue{shortest_timeout, 1h});
    v.value("grown_files", s.grown_files,
            Choice<GrownFiles>{{{"refuse", GrownFiles::refuse}, {"print", GrownFiles::print}}});
}

/// What is wrong with a listening address, a host name as it stands in `Host:`, an origin (scheme://host[:port]).
[[nodiscard]] std::string ip_address_problem(std::string_view text);
[[nodiscard]] std::string host_problem(std::string_view text);
[[nodiscard]] std::string origin_problem(std::string_view text);

template <typename V, Same<HttpSettings> S>
void visit(V& v, S& s) {
    using namespace std::chrono_literals;
    constexpr std::size_t max_names = 100;
    v.value("listen", s.listen, TextValue{45, false, ip_address_problem}, {Applies::restart});
    v.value("port", s.port, Whole<std::uint16_t>{1, 65535}, {Applies::restart});
    // With listen: otherwise a reload could take the tokens away from an address that others reach.
    v.value("tokens_file", s.tokens_file, Maybe{PathValue{}}, {Applies::restart});
    v.value("hosts", s.hosts, ListOf{TextValue{253, false, host_problem}, max_names});
    v.value("origins", s.origins, ListOf{TextValue{300, false, origin_problem}, max_names});
    v.value("max_body", s.max_body, SizeValue{1U << 10U, std::uint64_t{4} << 30U});
    v.value("max_header", s.max_header, SizeValue{1U << 10U, 1U << 20U});
    v.value("max_connections", s.max_connections, Whole<std::uint32_t>{1, 10'000});
    v.value("request_timeout", s.request_timeout, DurationValue{1s, longest_timeout});
}

/// What is wrong with the name of a group of users.
[[nodiscard]] std::string group_problem(std::string_view text);

template <typename V, Same<ControlSettings> S>
void visit(V& v, S& s) {
    constexpr std::uint64_t longest_socket_path = 107; // sockaddr_un, with its NUL
    v.value("socket", s.socket, PathValue{longest_socket_path}, {Applies::restart});
    v.value("group", s.group, TextValue{32, false, group_problem}, {Applies::restart});
}

template <typename V, Same<LoggingSettings> S>
void visit(V& v, S& s) {
    v.value("level", s.level, log_levels);
    v.value("target", s.target,
            Choice<LogTarget>{{{"journald", LogTarget::journald}, {"stderr", LogTarget::standard_error}}},
            {Applies::restart});
    v.section("levels", s.levels);
}

/// The level of each component.
template <typename V, Same<std::array<std::optional<LogLevel>, log_components>> S>
void visit(V& v, S& s) {
    const auto of = [&](LogComponent component) -> auto& {
        return s[static_cast<std::size_t>(component)];
    };
    v.value("service", of(LogComponent::service), Maybe{log_levels});
    v.value("printer", of(LogComponent::printer), Maybe{log_levels});
    v.value("store", of(LogComponent::store), Maybe{log_levels});
    v.value("intake", of(LogComponent::intake), Maybe{log_levels});
    v.value("folder", of(LogComponent::folder), Maybe{log_levels});
    v.value("api", of(LogComponent::api), Maybe{log_levels});
}

template <typename V, Same<RealTimeSettings> S>
void visit(V& v, S& s) {
    v.value("priority", s.priority, Maybe{Whole<int>{1, 99}}, {Applies::restart});
    v.value("processor", s.processor, Maybe{Whole<int>{0, 1023}}, {Applies::restart});
    v.value("lock_memory", s.lock_memory, Flag{}, {Applies::restart});
}

template <typename V, Same<Settings> S>
void visit(V& v, S& s) {
    v.value("spool", s.spool, PathValue{}, {Applies::restart});
    v.value("errors", s.errors_file, Maybe{PathValue{}});
    v.section("real_time", s.real_time);
    v.section("control", s.control);
    v.section("http", s.http);
    v.section("logging", s.logging);
    v.named("layouts", s.layouts);
    v.named("printers", s.printers, {Applies::printer_idle});
    v.named("folders", s.folders);
}

template <typename V, Same<ErrorEntry> S>
void visit(V& v, S& s) {
    v.value("meaning", s.meaning, TextValue{1000}, {Applies::at_once, true});
    v.value("advice", s.advice, TextValue{1000}, {Applies::at_once, true});
    v.value("policy", s.policy, error_policies, {Applies::at_once, true});
}

template <typename V, Same<ErrorTable> S>
void visit(V& v, S& s) {
    v.value("unlisted", s.unlisted,
            Choice<ErrorPolicy>{{{"report", ErrorPolicy::report}, {"stop", ErrorPolicy::stop}}});
    v.named("errors", s.entries);
}

// The names of elements.

/// Letters, digits, `-` and `_`; begins with a letter or digit; at most max_name.
[[nodiscard]] bool read_name(const Entry& entry, const std::string& key, Context& context, std::string& out);

template <typename Element>
bool set_name(Element& element, const Entry& entry, const std::string& key, Context& context) {
    return read_name(entry, key, context, element.name);
}
inline bool set_name(ErrorEntry& element, const Entry& entry, const std::string& key, Context& context) {
    return ErrorNumberKey::read(entry, key, context, element.number);
}
template <typename Element>
const std::string& name_of(const Element& element) {
    return element.name;
}
inline std::string name_of(const ErrorEntry& element) {
    return ErrorNumberKey::write(element.number);
}

} // namespace linefeed::config
