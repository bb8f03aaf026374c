// What is printed and how: `=CM =ET =GW =JL =PR =SM =SW`, and the lines of scripts (protocol, sections 4, 5 and 7).
#pragma once

#include "base/record_number.hpp"
#include "protocol/commands.hpp"
#include "protocol/limits.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace linefeed::protocol {

/// `=SM`, printer to host: mailing status (section 5). May be one inquiry old.
struct MailStatus {
    static constexpr Parameter parameter = Parameter::SM;
    std::uint32_t depth = 0;
    std::uint32_t entries = 0;
    RecordNumber last_printed{}; ///< 0 = none
    RecordNumber stop_at{};      ///< 0 = off
    bool last_print_finished = true;
    std::optional<std::uint32_t> print_go_count{}; ///< newer firmware only

    static void describe(auto& visitor, auto& self) {
        visitor.number("depth", "a FIFO depth", self.depth);
        visitor.number("entries", "a number of entries", self.entries);
        visitor.number("last_printed", "a record number", self.last_printed);
        visitor.number("stop_at", "a record number", self.stop_at);
        visitor.number("last_print_finished", "a number", self.last_print_finished);
        visitor.added("print_go_count", "a number of PrintGos", self.print_go_count);
    }
    friend bool operator==(const MailStatus&, const MailStatus&) = default;
};

/// `=CM`, host to printer: stop when this record has been printed; 0 = off.
struct StopAt {
    static constexpr Parameter parameter = Parameter::CM;
    RecordNumber number{};

    static void describe(auto& visitor, auto& self) { visitor.number("stop_at", "a record number", self.number); }
    friend bool operator==(const StopAt&, const StopAt&) = default;
};

/// `=JL`: name of the loaded job with path, or (host to printer) the job to load, which takes 50…150 ms.
struct JobName {
    static constexpr Parameter parameter = Parameter::JL;
    static constexpr bool has_text = true;
    std::string path{};

    static void describe(auto& visitor, auto& self) { visitor.text("path", self.path); }
    friend bool operator==(const JobName&, const JobName&) = default;
};

/// `=ET`: the extern text, which may contain graphics (graphic.hpp). The printer takes max_extern_text bytes, in
/// 20…40 ms.
struct ExternText {
    std::string text{}; ///< up to max_extern_text; escapes undone, NUL shown as a blank; TABs belong to it
    friend bool operator==(const ExternText&, const ExternText&) = default;
};
inline constexpr std::size_t max_extern_text = 2048;

/// PR, parameter 1: which print parameter, and from which PrintGo a new value holds.
enum class PrintParameterType : std::uint32_t {
    print_go_delay = 1,    ///< µm; from the second PrintGo on
    print_go_distance = 2, ///< µm; from the second PrintGo on
    stroke_distance = 3,   ///< µm; from the next PrintGo on
    printing_height = 4,   ///< 30…100; from the next PrintGo on
    encoder_speed = 5,     ///< of the internal encoder, dm/min (m/min on old firmware); from the next PrintGo on
};

/// The values that a print parameter may have.
[[nodiscard]] constexpr Limits limits_of(PrintParameterType type) {
    return type == PrintParameterType::printing_height ? Limits{30, 100} : Limits{};
}

/// `=PR`: a print parameter, as the host sets it and as the printer answers `?PR`.
struct PrintParameter {
    static constexpr Parameter parameter = Parameter::PR;
    PrintParameterType type = PrintParameterType::print_go_delay;
    std::uint32_t value = 0;

    static void describe(auto& visitor, auto& self) {
        visitor.number("type", "a print parameter", self.type, Limits{1, 5});
        visitor.number("value", "a value in its range", self.value, limits_of(self.type));
    }
    friend bool operator==(const PrintParameter&, const PrintParameter&) = default;
};

/// `=SW`, host to printer: the first stroke of the next `?GW`.
struct WysiwygStart {
    static constexpr Parameter parameter = Parameter::SW;
    std::uint32_t x = 0;

    static void describe(auto& visitor, auto& self) { visitor.number("x", "a place", self.x); }
    friend bool operator==(const WysiwygStart&, const WysiwygStart&) = default;
};

/// `=GW`, printer to host: a line of the WYSIWYG image (wysiwyg.hpp).
struct WysiwygLine {
    std::string bytes{}; ///< up to max_wysiwyg_line
    friend bool operator==(const WysiwygLine&, const WysiwygLine&) = default;
};
inline constexpr std::size_t max_wysiwyg_line = 30; ///< bytes: 60 nibbles

/// `^0*…`: a line of a script, both ways (section 7). Between `BEGINLJSCRIPT`, which deletes the current job, and
/// `ENDLJSCRIPT`, which hands the new one to be printed.
struct ScriptLine {
    std::string text{}; ///< escapes undone
    [[nodiscard]] bool is_begin() const { return is_word("BEGINLJSCRIPT"); }
    [[nodiscard]] bool is_end() const { return is_word("ENDLJSCRIPT"); }
    friend bool operator==(const ScriptLine&, const ScriptLine&) = default;

private:
    /// The word may be followed by parameters.
    [[nodiscard]] bool is_word(std::string_view word) const;
};

/// Words for people, e.g. "PrintGo delay in µm".
[[nodiscard]] std::string_view to_string(PrintParameterType type);

} // namespace linefeed::protocol
