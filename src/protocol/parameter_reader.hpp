// Takes the TAB-separated parameters of a command apart and remembers the first that cannot be read (protocol, section
// 1: an empty parameter is an absent one, excess parameters are ignored).
#pragma once

#include "base/record_number.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace linefeed::protocol {

/// Flow: read the parameters in order, then ask whether there was a problem(). Never allocates unless there is one.
class ParameterReader {
public:
    /// `text` is everything behind the two letters of the command.
    explicit ParameterReader(std::string_view text)
        : rest_(text) {}

    /// The next parameter as it came; std::nullopt if it is empty or there is none.
    [[nodiscard]] std::optional<std::string_view> text();

    /// The same without blanks around it; empty if there is none.
    [[nodiscard]] std::string_view trimmed();
    /// The next parameter as a decimal of at most `largest`, blanks around it ignored. `what` names it in problem(),
    /// e.g. "a record number".
    [[nodiscard]] std::optional<std::uint32_t> optional_number(std::string_view what,
                                                               std::uint32_t largest = UINT32_MAX);

    /// The same for a parameter that must be there, `smallest`…`largest`; otherwise `smallest` and a problem().
    [[nodiscard]] std::uint32_t number(std::string_view what, std::uint32_t smallest = 0,
                                       std::uint32_t largest = UINT32_MAX);
    [[nodiscard]] RecordNumber record_number() { return RecordNumber{number("a record number")}; }
    /// The next parameter, which must be there, as 32 bits written as a signed or an unsigned decimal.
    [[nodiscard]] std::int32_t signed_number(std::string_view what);
    /// The same for a parameter that may be empty or missing.
    [[nodiscard]] std::optional<std::int32_t> optional_signed_number(std::string_view what);
    /// The next parameter, which must be there, as a decimal of up to `largest`, which may need more than 32 bits.
    [[nodiscard]] std::uint64_t wide_number(std::string_view what, std::uint64_t largest);
    /// Everything that is left, TABs included, as it came.
    [[nodiscard]] std::string_view rest();

    /// Notes that what text() or rest() gave last is not what the command wants.
    void refuse(std::string_view what, std::string_view value) { complain(what, value); }

    [[nodiscard]] bool ok() const { return expected_.empty(); }
    /// E.g. "parameter 3 is not a record number: \"x\"". Precondition: not ok().
    [[nodiscard]] std::string problem() const;

private:
    void complain(std::string_view what, std::string_view value);

    std::optional<std::string_view> rest_;
    std::uint32_t position_ = 0;
    std::uint32_t bad_position_ = 0;
    std::string_view expected_;
    std::string_view value_;
};

} // namespace linefeed::protocol
