#include "config/load.hpp"

#include "config/checks.hpp"
#include "config/section_reader.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sys/stat.h>

namespace linefeed::config {

namespace {

/// The whole of a regular file; refused if it is missing, something else or too large.
std::optional<std::string> read_file(const std::filesystem::path& file, const std::string& key, Context& context) {
    const auto refuse = [&](const std::string& why) {
        if (key.empty()) {
            context.refuse(Place{}, key, why);
        } else {
            context.refuse(key, "cannot read " + in_quotes(file.string()) + ": " + why);
        }
        return std::nullopt;
    };
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) {
        return refuse(std::strerror(errno));
    }
    if (!S_ISREG(status.st_mode)) {
        return refuse("not a file");
    }
    std::ifstream stream{file, std::ios::binary};
    if (!stream) {
        return refuse(std::strerror(errno));
    }
    std::string text(max_file_bytes + 1, '\0'); // one more, so that read_yaml() sees that it is too large
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (stream.bad()) {
        return refuse("cannot be read");
    }
    text.resize(static_cast<std::size_t>(stream.gcount()));
    return text;
}

Context context_for(const std::filesystem::path& file) {
    // A relative name stays relative in problems, but not in what paths are relative to.
    return {file.string(), std::filesystem::absolute(file).parent_path().lexically_normal()};
}

/// An empty file is refused and unusable.
Node read_root(std::string_view text, Context& context) {
    Node root = read_yaml(text, context.file, context.problems);
    if (root.kind == Node::Kind::nothing) {
        context.refuse(Place{}, {}, "the file is empty");
        root.kind = Node::Kind::unusable;
    }
    return root;
}

Settings read_settings(std::string_view text, const Environment& environment, Context& context) {
    Settings settings;
    Node root = read_root(text, context);
    apply_environment(environment, root, context);
    read_section(settings, root, {}, context);
    if (root.kind != Node::Kind::unusable) {
        check_settings(settings, context);
    }
    return settings;
}

ErrorTable read_error_table(std::string_view text, Context& context) {
    ErrorTable table;
    const Node root = read_root(text, context);
    read_section(table, root, {}, context);
    return table;
}

template <typename T>
Checked<T> finish(T value, Context& context) {
    if (context.problems.empty()) {
        return value;
    }
    context.problems.sort();
    return std::move(context.problems);
}

} // namespace

Checked<Settings> parse_settings(std::string_view text, const std::filesystem::path& file,
                                 const Environment& environment) {
    Context context = context_for(file);
    Settings settings = read_settings(text, environment, context);
    check_policies(settings, context);
    return finish(std::move(settings), context);
}

Checked<ErrorTable> parse_error_table(std::string_view text, const std::filesystem::path& file) {
    Context context = context_for(file);
    ErrorTable table = read_error_table(text, context);
    return finish(std::move(table), context);
}

Checked<Settings> load(const std::filesystem::path& file, const Environment& environment) {
    Context context = context_for(file);
    const auto text = read_file(file, {}, context);
    if (!text) {
        return std::move(context.problems);
    }
    Settings settings = read_settings(*text, environment, context);
    Problems of_table;
    if (settings.errors_file) {
        if (const auto table_text = read_file(*settings.errors_file, "errors", context)) {
            auto table = parse_error_table(*table_text, *settings.errors_file);
            if (table) {
                settings.errors = std::move(*table);
            } else {
                of_table = table.error();
            }
        }
    }
    check_policies(settings, context);
    context.problems.sort();
    context.problems.append(of_table);
    return context.problems.empty() ? Checked<Settings>{std::move(settings)} : std::move(context.problems);
}

} // namespace linefeed::config
