// Columns chosen by the user: a name, or a number from 1 if no column has that name.
#pragma once

#include "base/failure.hpp"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::intake {

/// Whether a name that was asked for is this column.
using SameName = std::function<bool(std::string_view wanted, std::string_view column)>;

/// The indices of the columns that were asked for, all if none was. `width` = how many there are; `names` may be fewer
/// (a file without header has none). Fails with FailureKind::usage for an unknown or ambiguous one, naming those that
/// exist; the message has no place: the caller puts it in front.
[[nodiscard]] Result<std::vector<std::size_t>> choose(const std::vector<std::string>& wanted,
                                                      const std::vector<std::string>& names, std::size_t width,
                                                      const SameName& same_name);

/// `"a", "b", "c"`, the first twenty.
[[nodiscard]] std::string quoted_list(const std::vector<std::string>& names);

} // namespace linefeed::intake
