// The configuration parser on any bytes: it refuses with places inside the text or gives settings that, written and
// read again, are the same. A first line `#LINEFEED_HTTP_PORT=80` is a variable of the environment; a text that begins
// with
// `#errors` is also read as a table of error numbers.
#include "base/assert.hpp"
#include "config/effective.hpp"
#include "config/load.hpp"
#include "config/reload.hpp"

#include <algorithm>
#include <cstdint>
#include <string_view>

namespace {

using linefeed::config::Environment;
using linefeed::config::Problem;
using linefeed::config::Problems;

Environment environment_of(std::string_view first_line) {
    const std::size_t equals = first_line.find('=');
    if (!first_line.starts_with("#LINEFEED_") || equals == std::string_view::npos) {
        return {};
    }
    return {{std::string{first_line.substr(1, equals - 1)}, std::string{first_line.substr(equals + 1)}}};
}

void check_refusals(const Problems& problems, std::string_view text) {
    const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1;
    LINEFEED_ASSERT(!problems.empty() && problems.kept().size() <= Problems::max_kept);
    for (const Problem& problem : problems.kept()) {
        LINEFEED_ASSERT(problem.place.line <= lines && problem.place.column <= text.size() + 1);
        LINEFEED_ASSERT((problem.place.line == 0) == (problem.place.column == 0));
        LINEFEED_ASSERT(!problem.message.empty());
        const std::string shown = to_string(problem);
        LINEFEED_ASSERT(std::none_of(shown.begin(), shown.end(),
                                     [](char byte) { return static_cast<unsigned char>(byte) < 0x20; }));
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text{reinterpret_cast<const char*>(data), size};
    const Environment environment = environment_of(text.substr(0, text.find('\n')));
    const auto settings = linefeed::config::parse_settings(text, "/etc/f.yaml", environment);
    if (settings) {
        const std::string yaml = effective_yaml(*settings);
        const auto again = linefeed::config::parse_settings(yaml, "/etc/f.yaml", {});
        LINEFEED_ASSERT(again.has_value() && diff(*settings, *again).empty());
        LINEFEED_ASSERT(effective_yaml(*again) == yaml);
        const auto from_json = linefeed::config::parse_settings(effective_json(*settings), "/etc/f.yaml", {});
        LINEFEED_ASSERT(from_json.has_value() && diff(*settings, *from_json).empty());
    } else {
        check_refusals(settings.error(), text);
    }
    if (text.starts_with("#errors")) {
        const auto table = linefeed::config::parse_error_table(text, "/etc/errors.yaml");
        if (!table) {
            check_refusals(table.error(), text);
        }
    }
    return 0;
}
