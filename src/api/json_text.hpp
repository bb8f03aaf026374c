// JSON as the interface speaks it: texts of files and printers are any bytes, and JSON is UTF-8.
#pragma once

#include "api/problem.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>
#include <string_view>

namespace linefeed::api {

using Json = nlohmann::ordered_json;

/// `text` with every byte that is not part of valid UTF-8 as `\xNN`. Control characters stay: JSON has its own escapes.
[[nodiscard]] std::string visible(std::string_view text);
/// Printable ASCII as it is, everything else and the backslash as `\xNN`: for frames.
[[nodiscard]] std::string visible_ascii(std::string_view bytes);

/// On one line. Precondition: every text in it is UTF-8.
[[nodiscard]] std::string dump(const Json& json);
/// `text` as JSON object; null if it is none (empty, or not ours).
[[nodiscard]] Json parsed_object(std::string_view text);

/// RFC 3339 in UTC with milliseconds, e.g. "2026-11-22T19:45:50.123Z". `ns` since the Unix epoch, not negative.
[[nodiscard]] std::string rfc3339(std::int64_t ns);

/// Reads the members of a request's JSON object. Flow: parse(), then a call for each member that there may be, then
/// finish(), which names the first thing that is wrong.
class BodyReader {
public:
    /// An empty text is an empty object. ProblemType::malformed if it is no JSON object, or a member comes twice.
    [[nodiscard]] static Checked<BodyReader> parse(std::string_view text);

    [[nodiscard]] std::optional<std::string> text(std::string_view member);
    [[nodiscard]] std::optional<bool> flag(std::string_view member);
    /// Whole number from `least` to `most`.
    [[nodiscard]] std::optional<std::int64_t> number(std::string_view member, std::int64_t least, std::int64_t most);
    /// The same for members that must be there; what is missing comes back as empty or `least`.
    [[nodiscard]] std::string required_text(std::string_view member);
    [[nodiscard]] std::int64_t required_number(std::string_view member, std::int64_t least, std::int64_t most);
    [[nodiscard]] bool required_flag(std::string_view member);

    /// The members that were not asked for, which are asked for by this.
    [[nodiscard]] Json rest();

    /// ProblemType::not_valid if a member was of another type, out of range, missing, or never asked for.
    [[nodiscard]] Checked<void> finish() const;

private:
    explicit BodyReader(Json object)
        : object_(std::move(object)) {}
    /// nullptr = it is not there.
    const Json* take(std::string_view member);
    void refuse(std::string_view member, std::string_view expected);

    Json object_;
    std::vector<std::string> known_; ///< members that were asked for
    std::string wrong_;              ///< the first thing; empty = nothing
};

} // namespace linefeed::api
