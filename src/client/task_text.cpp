#include "client/task_text.hpp"

#include "client/table.hpp"

#include <algorithm>

namespace linefeed::client {

namespace {

std::string spaced(std::string name) {
    std::ranges::replace(name, '_', ' ');
    return name;
}

std::string upper_case(std::string name) {
    std::ranges::transform(name, name.begin(),
                           [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    return name;
}

/// The number of what stands in words beside it.
bool is_code(const Json& object, const std::string& key) {
    constexpr std::string_view ending = "_code";
    return key.ends_with(ending) && object.contains(key.substr(0, key.size() - ending.size()));
}

bool is_list(const Json& value) {
    return value.is_array() && !value.empty() && value.front().is_object();
}

/// An error: its words, what the plant's table says of it, and what to do.
std::string error_text(const Json& error) {
    std::string line = text(error, "words");
    for (const char* more : {"meaning", "advice"}) {
        if (const std::string words = text(error, more); !words.empty()) {
            line += "; " + words;
        }
    }
    return line;
}

void add_facts(Facts& facts, const Json& object, const std::string& prefix) {
    for (const auto& [key, value] : object.items()) {
        const std::string name = prefix + spaced(key);
        if (is_code(object, key) || is_list(value)) {
            continue;
        }
        if (value.is_object() && !value.contains("words")) {
            add_facts(facts, value, name + ' ');
        } else {
            facts.add(name, {value_text(value), key == "note" ? Colour::warning : Colour::none});
        }
    }
}

/// The names that any row has, in the order in which they come; those that say something.
std::vector<std::string> columns_of(const Json& rows) {
    std::vector<std::string> names;
    for (const Json& row : rows) {
        for (const auto& [key, value] : row.items()) {
            const bool empty = value.is_null() || value == "";
            if (!empty && !is_code(row, key) && std::ranges::find(names, key) == names.end()) {
                names.push_back(key);
            }
        }
    }
    return names;
}

std::string table_text(const Json& rows, const Screen& screen) {
    const std::vector<std::string> names = columns_of(rows);
    std::vector<Column> columns;
    for (const std::string& name : names) {
        const bool numbers = std::ranges::all_of(
            rows, [&name](const Json& row) { return member(row, name).is_number() || member(row, name).is_null(); });
        const bool long_words = name == "meaning" || name == "advice" || name == "words";
        columns.push_back({upper_case(spaced(name)), numbers, long_words});
    }
    Table table{columns};
    for (const Json& row : rows) {
        std::vector<Cell> cells;
        for (const std::string& name : names) {
            cells.push_back({member(row, name).is_null() ? "" : value_text(member(row, name))});
        }
        table.add(std::move(cells));
    }
    return table.text(screen);
}

/// Frames that came: each with its fields, and as it came.
std::string answers_text(const Json& answers, const Screen& screen) {
    std::string all;
    for (const Json& answer : answers) {
        Facts facts;
        facts.add(text(answer, "command").empty() ? "?" : text(answer, "command"),
                  {text(answer, "what"), Colour::strong});
        add_facts(facts, member(answer, "fields"), "");
        facts.add("raw", {text(answer, "raw"), Colour::faint});
        all += facts.text(screen);
        for (const auto& [key, value] : member(answer, "fields").items()) {
            all += is_list(value) ? table_text(value, screen) : "";
        }
    }
    return all;
}

} // namespace

std::string value_text(const Json& value) {
    if (value.is_null()) {
        return "-";
    }
    if (value.is_string()) {
        return value.get<std::string>();
    }
    if (value.is_boolean()) {
        return value.get<bool>() ? "yes" : "no";
    }
    if (value.is_object() && value.contains("words")) {
        return error_text(value);
    }
    if (value.is_array() || value.is_object()) {
        std::string all;
        for (const auto& [key, element] : value.items()) {
            all += (all.empty() ? "" : ", ") + (value.is_object() ? spaced(key) + ' ' : std::string{}) +
                   value_text(element);
        }
        return all.empty() ? "none" : all;
    }
    return value.dump();
}

std::string task_text(const Json& answer, const Screen& screen) {
    if (is_list(member(answer, "answers"))) {
        return answers_text(member(answer, "answers"), screen);
    }
    Facts facts;
    add_facts(facts, answer, "");
    std::string all = facts.text(screen);
    for (const auto& [key, value] : answer.items()) {
        all += is_list(value) ? table_text(value, screen) : "";
    }
    return all;
}

} // namespace linefeed::client
