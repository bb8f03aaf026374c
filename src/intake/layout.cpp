#include "intake/layout.hpp"

#include "spool/json_text.hpp"

#include <algorithm>

namespace linefeed::intake {

namespace {

/// One charset for each column, from "latin1" (all) and "COLUMN=unicode-hex" (one).
Result<std::vector<protocol::Charset>> charsets_for(const std::vector<std::string>& encodings,
                                                    const std::vector<std::string>& columns) {
    std::vector<protocol::Charset> charsets(columns.size(), protocol::Charset::latin1);
    for (const std::string& encoding : encodings) {
        const std::size_t equals = encoding.rfind('=');
        const auto charset =
            protocol::charset_from_name(equals == std::string::npos ? encoding : encoding.substr(equals + 1));
        if (!charset) {
            return Failure{FailureKind::usage,
                           "--encoding " + encoding +
                               ": expected latin1, windows-1252 or unicode-hex, or COLUMN=one of them"};
        }
        if (equals == std::string::npos) {
            std::fill(charsets.begin(), charsets.end(), *charset);
            continue;
        }
        const auto column = std::find(columns.begin(), columns.end(), encoding.substr(0, equals));
        if (column == columns.end()) {
            return Failure{FailureKind::usage,
                           "--encoding " + encoding + ": no column \"" + encoding.substr(0, equals) + "\" is printed"};
        }
        charsets[static_cast<std::size_t>(column - columns.begin())] = *charset;
    }
    return charsets;
}

std::string texts_json(const std::vector<std::string>& texts) {
    std::vector<std::string> quoted;
    quoted.reserve(texts.size());
    for (const std::string& text : texts) {
        quoted.push_back(spool::json_string(text));
    }
    return spool::json_array(quoted);
}

/// The indices of the columns that are graphics. They are sent as they are, whatever the encoding of the others.
Result<std::vector<std::size_t>> graphic_columns(const std::vector<std::string>& graphics,
                                                 const std::vector<std::string>& columns) {
    std::vector<std::size_t> indices;
    for (const std::string& graphic : graphics) {
        const auto column = std::find(columns.begin(), columns.end(), graphic);
        if (column == columns.end()) {
            return Failure{FailureKind::usage, "--graphic " + graphic + ": no column \"" + graphic + "\" is printed"};
        }
        indices.push_back(static_cast<std::size_t>(column - columns.begin()));
    }
    return indices;
}

SourceOptions source_options(const Layout& layout) {
    return {layout.columns, layout.delimiter, layout.header, layout.table, layout.query};
}

Result<OpenedSource> with_options(Result<std::unique_ptr<RowSource>> source, const std::filesystem::path& beside,
                                  const Layout& layout) {
    if (!source) {
        return source.error();
    }
    if (!layout.profile.record_properties && !layout.properties.empty()) {
        return Failure{FailureKind::usage,
                       "the firmware of this printer (" + protocol::to_string(layout.profile) +
                           ") turns or mirrors no single record: do that in the printer's job, and leave out the "
                           "orientation and what mirrors"};
    }
    const auto charsets = charsets_for(layout.encodings, (*source)->column_names());
    if (!charsets) {
        return charsets.error();
    }
    auto graphics = graphic_columns(layout.graphics, (*source)->column_names());
    if (!graphics) {
        return graphics.error();
    }
    OpenedSource opened{std::move(*source), {}};
    opened.options.charsets = *charsets;
    for (const std::size_t column : *graphics) {
        opened.options.charsets[column] = protocol::Charset::latin1;
    }
    opened.options.graphics = {*std::move(graphics), layout.profile.graphic_height,
                               layout.graphics_folder.value_or(beside)};
    opened.options.escapes = layout.profile.escapes;
    opened.options.properties = layout.properties;
    opened.options.skip_bad = layout.skip_bad;
    return opened;
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
    const auto parent = file.parent_path();
    return parent.empty() ? std::filesystem::path{"."} : parent;
}

} // namespace

std::string canonical_json(const Layout& layout) {
    const auto boolean = [](bool value) { return value ? "true" : "false"; };
    spool::JsonObject json;
    json.add_json("columns", texts_json(layout.columns));
    json.add_json("encodings", texts_json(layout.encodings));
    if (!layout.graphics.empty()) {
        json.add_json("graphics", texts_json(layout.graphics));
        if (layout.graphics_folder) {
            json.add("graphics_folder", layout.graphics_folder->string());
        }
    }
    json.add("profile", protocol::to_string(layout.profile));
    if (layout.table) {
        json.add("table", *layout.table);
    }
    if (layout.query) {
        json.add("query", *layout.query);
    }
    if (layout.delimiter) {
        json.add("delimiter", std::string_view{&*layout.delimiter, 1});
    }
    json.add_json("header", boolean(layout.header));
    json.add_json("skip_bad", boolean(layout.skip_bad));
    json.add_json("mirrored", boolean(layout.properties.mirrored));
    if (layout.properties.orientation) {
        json.add("orientation", static_cast<int>(*layout.properties.orientation));
    }
    return json.text();
}

bool is_same_way(std::string_view one, std::string_view other) {
    const auto without_profile = [](std::string_view canonical) {
        constexpr std::string_view key = "\"profile\":\""; // in a text its quotes would be escaped
        std::string text{canonical};
        const auto begin = text.find(key);
        if (begin != std::string::npos) {
            text.erase(begin, text.find('"', begin + key.size()) - begin);
        }
        return text;
    };
    return without_profile(one) == without_profile(other);
}

bool reads_images(std::string_view canonical) {
    return canonical.find("\"graphics\":[") != std::string_view::npos;
}

Result<OpenedSource> open_with_layout(const std::filesystem::path& file, const Layout& layout) {
    return with_options(open_source(file, source_options(layout)), folder_of(file), layout);
}

Result<OpenedSource> open_with_layout(FileInput file, const Layout& layout) {
    SourceOptions options = source_options(layout);
    options.follow_links = false;
    const std::filesystem::path beside = folder_of(file.path());
    return with_options(open_source(std::move(file), options), beside, layout);
}

} // namespace linefeed::intake
