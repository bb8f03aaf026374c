// The JSON that stands in the spool, evidence of ledger rows and reports of imports, put together by hand: when memory
// runs out, nlohmann-json ends the process in the destructor of an object, and nobody could say that it has.
#pragma once

#include <concepts>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::spool {

/// One JSON object as text. Flow: add() in the order wanted, each key once; then text().
class JsonObject {
public:
    /// The text may hold any bytes: what is not UTF-8 is replaced.
    JsonObject& add(std::string_view key, std::string_view text);
    template <std::integral Number>
    JsonObject& add(std::string_view key, Number number) {
        return add_json(key, std::to_string(number));
    }
    /// `json` is JSON already.
    JsonObject& add_json(std::string_view key, std::string_view json);
    [[nodiscard]] std::string text() const { return text_ + '}'; }

private:
    std::string text_ = "{";
};

/// A text as JSON, in quotes; what is not UTF-8 is replaced.
[[nodiscard]] std::string json_string(std::string_view text);

/// [a,b,…] of values that are JSON already.
[[nodiscard]] std::string json_array(const std::vector<std::string>& values);

} // namespace linefeed::spool
