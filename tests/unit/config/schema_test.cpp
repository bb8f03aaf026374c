// The published schema and the code know the same keys, types, bounds, words and defaults.
#include "config/keys.hpp"
#include "config/values.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>

namespace linefeed::config {
namespace {

using testing::HasSubstr;

class Schema : public testing::Test {
protected:
    Schema() {
        std::ifstream file{std::string{LINEFEED_SOURCE_DIR} + "/config/linefeed.schema.json"};
        schema_ = Json::parse(file);
        collect({}, schema_);
    }

    /// Every property, by path, `*` for a name.
    void collect(const std::string& path, const Json& object) {
        for (const auto& [key, property] : object["properties"].items()) {
            const std::string inner = join(path, key);
            keys_[inner] = property;
            if (property.contains("properties")) {
                collect(inner, property);
            } else if (property.contains("additionalProperties") &&
                       property["additionalProperties"].contains("properties")) {
                keys_[inner + ".*"] = property["additionalProperties"];
                collect(inner + ".*", property["additionalProperties"]);
            }
        }
        for (const auto& required : object.value("required", Json::array())) {
            required_.push_back(join(path, required.get<std::string>()));
        }
        EXPECT_EQ(object["additionalProperties"], false) << path;
    }

    static std::string without_quotes(const Json& value) {
        return value.is_string() ? value.get<std::string>() : value.dump();
    }

    Json schema_;
    std::map<std::string, Json> keys_;
    std::vector<std::string> required_;
};

TEST_F(Schema, shouldHaveTheKeysOfTheCode) {
    std::vector<std::string> code;
    std::vector<std::string> code_required;
    for (const KeyInfo& key : known_keys()) {
        code.push_back(key.path);
        if (key.required) {
            code_required.push_back(key.path);
        }
    }
    std::vector<std::string> published;
    for (const auto& [path, property] : keys_) {
        published.push_back(path);
    }
    EXPECT_THAT(published, testing::UnorderedElementsAreArray(code));
    EXPECT_THAT(required_, testing::UnorderedElementsAreArray(code_required));
}

TEST_F(Schema, shouldHaveTheTypesAndBoundsOfTheCode) {
    for (const KeyInfo& key : known_keys()) {
        SCOPED_TRACE(key.path);
        const Json property = keys_[key.path];
        const std::string description = property.value("description", "");
        EXPECT_FALSE(description.empty());
        if (key.type == "flag") {
            EXPECT_EQ(property["type"], "boolean");
        } else if (key.type == "whole number") {
            EXPECT_EQ(property["type"], "integer");
            EXPECT_EQ(property["minimum"], *key.minimum);
            EXPECT_EQ(property["maximum"], *key.maximum);
        } else if (key.type == "duration") {
            EXPECT_EQ(property["$ref"], "#/$defs/duration");
            const auto text = [](std::uint64_t ns) {
                return DurationValue{}.write(Duration{static_cast<Duration::rep>(ns)}).get<std::string>();
            };
            EXPECT_THAT(description, HasSubstr(' ' + text(*key.minimum) + " to " + text(*key.maximum) + '.'));
        } else if (key.type == "size") {
            EXPECT_EQ(property["$ref"], "#/$defs/size");
            const auto text = [](std::uint64_t bytes) { return SizeValue{}.write(bytes).get<std::string>(); };
            EXPECT_THAT(description, HasSubstr(' ' + text(*key.minimum) + " to " + text(*key.maximum) + '.'));
        } else if (key.type == "text" || key.type == "path") {
            EXPECT_EQ(property["type"], "string");
            EXPECT_EQ(property["minLength"], *key.minimum);
            EXPECT_EQ(property["maxLength"], *key.maximum);
        } else if (key.type == "choice") {
            std::vector<std::string> words;
            for (const Json& word : property["enum"]) {
                words.push_back(without_quotes(word));
            }
            EXPECT_THAT(words, testing::ElementsAreArray(key.allowed));
        } else if (key.type == "list") {
            EXPECT_EQ(property["type"], "array");
            EXPECT_EQ(property["maxItems"], *key.maximum);
            EXPECT_EQ(property["uniqueItems"], true);
        } else if (key.type == "mapping") {
            EXPECT_EQ(property["type"], "object");
            EXPECT_EQ(property["maxProperties"], *key.maximum);
        } else if (key.type == "elements") {
            EXPECT_EQ(property["maxProperties"], 1000);
            EXPECT_EQ(property["propertyNames"]["$ref"], "#/$defs/name");
        } else {
            EXPECT_EQ(key.type, "section");
        }
    }
}

TEST_F(Schema, shouldHaveTheDefaultsOfTheCode) {
    for (const KeyInfo& key : known_keys()) {
        const Json property = keys_[key.path];
        EXPECT_EQ(property.contains("default") ? property["default"].dump() : "", key.standard) << key.path;
    }
}

TEST(ErrorTableKeys, shouldBeThoseOfTheFile) {
    std::vector<std::string> paths;
    for (const KeyInfo& key : known_error_table_keys()) {
        paths.push_back(key.path);
    }
    EXPECT_THAT(paths, testing::ElementsAre("unlisted", "errors", "errors.*", "errors.*.meaning", "errors.*.advice",
                                            "errors.*.policy"));
}

} // namespace
} // namespace linefeed::config
