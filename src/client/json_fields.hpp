// Members of the service's answers. A service of another version may have more or fewer of them: what is missing, or of
// another type, reads as nothing, and never ends the command.
#pragma once

#include "api/client.hpp"
#include "base/failure.hpp"
#include "printer/json.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace linefeed::client {

using api::Json;

using printer::json_result;

/// Null if it is not there.
[[nodiscard]] const Json& member(const Json& object, std::string_view name);
/// Empty if it is no text.
[[nodiscard]] std::string text(const Json& object, std::string_view name);
[[nodiscard]] std::optional<std::int64_t> whole(const Json& object, std::string_view name);
/// 0 if it is not there.
[[nodiscard]] std::int64_t number(const Json& object, std::string_view name);
[[nodiscard]] std::optional<double> real(const Json& object, std::string_view name);
[[nodiscard]] bool flag(const Json& object, std::string_view name);
/// An empty array if it is none.
[[nodiscard]] const Json& items(const Json& object, std::string_view name = "items");
/// A whole number as text; empty if it is not there.
[[nodiscard]] std::string number_text(const Json& object, std::string_view name);

/// "5-9" of a Range of openapi.yaml; empty if it is null.
[[nodiscard]] std::string range_text(const Json& range);
/// "2026-11-22 20:45:50" in local time; empty if the member (…_ns) is not there.
[[nodiscard]] std::string local_time(const Json& object, std::string_view name);

} // namespace linefeed::client
