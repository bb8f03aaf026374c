// Fields of a record that are graphics (protocol, section 5): `(height width hex)` as it is, checked, or the name of an
// image file, which becomes one.
#pragma once

#include "base/failure.hpp"
#include "protocol/graphic.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace linefeed::intake {

struct GraphicOptions {
    std::vector<std::size_t> columns{};                      ///< indices of the fields that are graphics
    std::uint32_t max_height = protocol::max_graphic_height; ///< dots
    /// Where the images are; a name leads to nothing outside, not by `..` and not by a symbolic link. Empty: nowhere.
    std::filesystem::path folder{};
};

/// Flow: apply() to the fields of each row.
class GraphicFields {
public:
    /// A field that cannot be printed.
    struct Problem {
        std::size_t column = 0;
        std::string reason;
    };

    explicit GraphicFields(GraphicOptions options)
        : options_(std::move(options)) {}

    /// Puts `(height width hex)` in the place of what stands in graphic fields; empty ones stay empty. The views are
    /// valid until the next call.
    [[nodiscard]] std::optional<Problem> apply(std::vector<std::string_view>& fields);

private:
    [[nodiscard]] Result<std::string> graphic_text(const std::string& field);
    [[nodiscard]] Result<std::string> image_text(const std::string& name) const;

    GraphicOptions options_;
    /// What came of the fields seen last: a logo is the same in each row.
    std::unordered_map<std::string, std::string> known_;
    std::vector<std::string> texts_;
};

} // namespace linefeed::intake
