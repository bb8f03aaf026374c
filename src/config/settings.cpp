#include "config/settings.hpp"

#include "config/checks.hpp"

#include <algorithm>

namespace linefeed::config {

const ErrorEntry* ErrorTable::find(const protocol::PrinterError& error) const {
    for (const std::uint32_t number : {error.code(), error.code_without_bit_24()}) {
        const auto entry = std::find_if(entries.begin(), entries.end(),
                                        [&](const ErrorEntry& listed) { return listed.number == number; });
        if (entry != entries.end()) {
            return &*entry;
        }
    }
    return nullptr;
}

namespace {

template <typename T>
const T* find_by_name(const std::vector<T>& list, std::string_view name) {
    const auto found = std::find_if(list.begin(), list.end(), [&](const T& one) { return one.name == name; });
    return found == list.end() ? nullptr : &*found;
}

} // namespace

const PrinterSettings* Settings::printer(std::string_view name) const {
    return find_by_name(printers, name);
}

const LayoutSettings* Settings::layout(std::string_view name) const {
    return find_by_name(layouts, name);
}

ErrorPolicy Settings::policy(const PrinterSettings& printer, const protocol::PrinterError& error) const {
    for (const std::uint32_t number : {error.code(), error.code_without_bit_24()}) {
        if (const auto own = printer.errors.find(number); own != printer.errors.end()) {
            return own->second;
        }
    }
    const ErrorEntry* const entry = errors.find(error);
    return entry == nullptr ? errors.unlisted : entry->policy;
}

decltype(feeder::FeederSettings::acknowledge) Settings::acknowledged(const PrinterSettings& printer) const {
    decltype(feeder::FeederSettings::acknowledge) numbers;
    for (const std::uint32_t number : acknowledged_numbers(errors, printer)) {
        numbers.push_back(number);
    }
    return numbers;
}

feeder::StoppingErrors Settings::stopping(const PrinterSettings& printer) const {
    feeder::StoppingErrors stopping{.numbers = {}, .all_others = errors.unlisted == ErrorPolicy::stop};
    const auto add = [&](std::uint32_t number, ErrorPolicy policy) {
        if ((policy == ErrorPolicy::stop) != stopping.all_others) {
            stopping.numbers.push_back(number);
        }
    };
    for (const auto& [number, policy] : printer.errors) {
        add(number, policy);
    }
    for (const ErrorEntry& entry : errors.entries) {
        if (!printer.errors.contains(entry.number)) {
            add(entry.number, entry.policy);
        }
    }
    std::ranges::sort(stopping.numbers);
    return stopping;
}

} // namespace linefeed::config
