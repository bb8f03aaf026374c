// Words for refusals: lists of what is allowed, and what was probably meant.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace linefeed::config {

/// `a, b or c`.
[[nodiscard]] std::string one_of(const std::vector<std::string>& words);

/// The nearest of `words` if it is near enough for a slip of the keyboard (without regard to case, `_` and `-`); empty
/// = none is, or two are equally near.
[[nodiscard]] std::string nearest(std::string_view wanted, const std::vector<std::string>& words);

/// `; did you mean "x"?` for the nearest, or nothing.
[[nodiscard]] std::string did_you_mean(std::string_view wanted, const std::vector<std::string>& words);

/// Upper case; everything but letters and digits becomes `_`: how a key reads in the name of an environment variable.
[[nodiscard]] std::string variable_word(std::string_view key);

} // namespace linefeed::config
