// Scenario files: whatever stands in them, they are read or refused with the line that is wrong.
#include "base/assert.hpp"
#include "simulator/fault.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(data, data + size);
    const auto faults = linefeed::simulator::parse_scenario(text);
    if (faults) {
        LINEFEED_ASSERT(faults->size() <= static_cast<std::size_t>(std::ranges::count(text, '\n')) + 1);
    } else {
        LINEFEED_ASSERT(faults.error().message.starts_with("line "));
    }
    return 0;
}
