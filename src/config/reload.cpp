#include "config/reload.hpp"

#include "base/assert.hpp"
#include "config/keys.hpp"
#include "config/sections.hpp"
#include "config/settings_json.hpp"

#include <algorithm>

namespace linefeed::config {

namespace {

Applies applies_to(const std::string& path) {
    const std::string general = with_wildcards(path);
    const std::vector<KeyInfo>& keys = known_keys();
    const auto known = std::find_if(keys.begin(), keys.end(), [&](const KeyInfo& key) { return key.path == general; });
    return known == keys.end() ? Applies::at_once : known->applies;
}

std::string in_one_line(const Json* value) {
    return value == nullptr ? std::string{} : value->dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Compares what stands at `path`; nullptr = nothing does.
class Comparison {
public:
    void compare(const std::string& path, const Json* before, const Json* after) {
        if (before != nullptr && after != nullptr && before->is_object() && after->is_object()) {
            compare_entries(path, *before, *after);
        } else if (before == nullptr || after == nullptr || *before != *after) {
            add(path, before, after);
        }
    }

    [[nodiscard]] std::vector<Change> take() { return std::move(changes_); }

private:
    void compare_entries(const std::string& path, const Json& before, const Json& after) {
        for (const auto& [key, value] : before.items()) {
            const auto other = after.find(key);
            compare(join(path, key), &value, other == after.end() ? nullptr : &*other);
        }
        for (const auto& [key, value] : after.items()) {
            if (!before.contains(key)) {
                compare(join(path, key), nullptr, &value);
            }
        }
    }

    void add(const std::string& path, const Json* before, const Json* after) {
        Change change{path, in_one_line(before), in_one_line(after), applies_to(path), {}};
        constexpr std::string_view printers = "printers.";
        if (change.applies == Applies::printer_idle && before == nullptr) {
            change.applies = Applies::at_once; // a printer that is new does not print
        }
        if (change.applies == Applies::printer_idle) {
            LINEFEED_ASSERT(path.starts_with(printers));
            change.printer = path.substr(printers.size(), path.find('.', printers.size()) - printers.size());
        }
        changes_.push_back(std::move(change));
    }

    std::vector<Change> changes_;
};

/// Visitor that collects the values which only a restart changes, in order.
struct RestartValues {
    std::vector<const void*> members{};

    template <typename T, typename Kind>
    void value(const char*, const T& member, const Kind&, const Rules& rules = {}) {
        if (rules.applies == Applies::restart) {
            members.push_back(&member);
        }
    }
    template <typename T>
    void section(const char*, const T& member) {
        visit(*this, member);
    }
    template <typename Element>
    void named(const char*, const std::vector<Element>&, const Rules& = {}) {}
};

/// Visitor that puts them in their places again.
struct RestoreValues {
    const std::vector<const void*>& members;
    std::size_t next = 0;

    template <typename T, typename Kind>
    void value(const char*, T& member, const Kind&, const Rules& rules = {}) {
        if (rules.applies == Applies::restart) {
            member = *static_cast<const T*>(members[next++]);
        }
    }
    template <typename T>
    void section(const char*, T& member) {
        visit(*this, member);
    }
    template <typename Element>
    void named(const char*, std::vector<Element>&, const Rules& = {}) {}
};

} // namespace

std::vector<Change> diff(const Settings& before, const Settings& after) {
    Comparison comparison;
    const Json old_settings = to_json(before);
    const Json new_settings = to_json(after);
    comparison.compare({}, &old_settings, &new_settings);
    const Json old_table = to_json(before.errors);
    const Json new_table = to_json(after.errors);
    comparison.compare("error_table", &old_table, &new_table);
    return comparison.take();
}

std::vector<Change> blocking(const std::vector<Change>& changes,
                             const std::function<bool(std::string_view printer)>& prints) {
    std::vector<Change> found;
    for (const Change& change : changes) {
        if (change.applies == Applies::printer_idle && prints(change.printer)) {
            found.push_back(change);
        }
    }
    return found;
}

std::string to_string(const Change& change) {
    std::string text = change.key + ": ";
    if (change.before.empty()) {
        text += "new: " + change.after;
    } else if (change.after.empty()) {
        text += "gone; was " + change.before;
    } else {
        text += change.before + " -> " + change.after;
    }
    switch (change.applies) {
    case Applies::at_once:
        return text;
    case Applies::printer_idle:
        return text + " (not while " + change.printer + " prints)";
    case Applies::restart:
        return text + " (when the service is started again)";
    }
    assertion_failed("Applies", __FILE__, __LINE__);
}

Settings without_restart(const Settings& before, Settings after) {
    RestartValues kept;
    visit(kept, before);
    RestoreValues restore{kept.members};
    visit(restore, after);
    return after;
}

} // namespace linefeed::config
