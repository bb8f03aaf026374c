// Paths and parameters of a request target, taken apart strictly: what is not understood is refused, not passed over.
#pragma once

#include "api/problem.hpp"
#include "base/record_number.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace linefeed::api {

/// %NN taken back; `plus_is_blank` in queries only. std::nullopt if a `%` is not followed by two hex digits, or a
/// decoded character is NUL.
[[nodiscard]] std::optional<std::string> percent_decoded(std::string_view text, bool plus_is_blank);

/// The decoded parameters of a query, each name once.
class Query {
public:
    static constexpr std::size_t max_parameters = 16;

    Query() = default;
    /// `text` is what follows the `?`. ProblemType::malformed if it cannot be decoded, has more than max_parameters, or
    /// a name comes twice.
    [[nodiscard]] static Checked<Query> parse(std::string_view text);

    /// nullptr = not given.
    [[nodiscard]] const std::string* find(std::string_view name) const;
    [[nodiscard]] std::string text(std::string_view name) const;
    /// Whole number from `least` to `most`; `otherwise` if it is not given.
    [[nodiscard]] Checked<std::uint64_t> number(std::string_view name, std::uint64_t least, std::uint64_t most,
                                                std::uint64_t otherwise) const;
    /// true or false, or the name alone = true; false if it is not given.
    [[nodiscard]] Checked<bool> flag(std::string_view name) const;
    [[nodiscard]] const std::vector<std::pair<std::string, std::string>>& all() const { return parameters_; }

private:
    std::vector<std::pair<std::string, std::string>> parameters_;
};

/// "N" or "N-M".
[[nodiscard]] Checked<RecordRange> parse_records(std::string_view text);

/// A whole number without sign, blanks or leading zeros, at most `most`.
[[nodiscard]] std::optional<std::uint64_t> parse_number(std::string_view text, std::uint64_t most);

} // namespace linefeed::api
