#include "cli/source_import.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace linefeed::cli {

namespace {

using Json = nlohmann::ordered_json;

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

/// A source that is open, and how its records are made.
struct Opened {
    std::unique_ptr<intake::RowSource> rows;
    intake::ImportOptions options;
};

Result<Opened> open(const PrintOptions& options) {
    auto source = intake::open_source(
        options.file, {options.columns, options.delimiter, options.header, options.table, options.query});
    if (!source) {
        return source.error();
    }
    const auto charsets = charsets_for(options.encodings, (*source)->column_names());
    if (!charsets) {
        return charsets.error();
    }
    Opened opened{std::move(*source), {}};
    opened.options.charsets = *charsets;
    opened.options.escapes = options.profile.escapes;
    opened.options.properties = options.properties;
    opened.options.skip_bad = options.skip_bad;
    return opened;
}

std::unique_ptr<daemon::RunningImport> start(spool::JobImport job, Opened opened, const spool::JobSpec& spec) {
    auto import = std::make_unique<daemon::RunningImport>(std::move(job), std::move(opened.rows), spec,
                                                          std::move(opened.options));
    import->start();
    return import;
}

} // namespace

std::string layout_of(const PrintOptions& options) {
    Json json{{"columns", options.columns}, {"encodings", options.encodings}, {"profile", options.profile.name}};
    if (options.table) {
        json["table"] = *options.table;
    }
    if (options.query) {
        json["query"] = *options.query;
    }
    if (options.delimiter) {
        json["delimiter"] = std::string(1, *options.delimiter);
    }
    json["header"] = options.header;
    json["skip_bad"] = options.skip_bad;
    json["mirrored"] = options.properties.mirrored;
    if (options.properties.orientation) {
        json["orientation"] = static_cast<int>(*options.properties.orientation);
    }
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Result<intake::ImportOutcome> import_whole(const PrintOptions& options, spool::Spool& spool, const spool::JobSpec& spec,
                                           const ImportProgress& on_progress) {
    auto opened = open(options);
    if (!opened) {
        return opened.error();
    }
    opened->options.on_progress = [&](const intake::ImportReport& report, double fraction) {
        return on_progress(report.rows, fraction);
    };
    return intake::import_source(*opened->rows, spool, spec, opened->options);
}

Result<std::unique_ptr<daemon::RunningImport>> start_import(const PrintOptions& options, spool::Spool& spool,
                                                            const spool::JobSpec& spec) {
    auto opened = open(options);
    if (!opened) {
        return opened.error();
    }
    auto job = spool.begin_import(spec, intake::to_json(intake::empty_report(*opened->rows, opened->options)));
    if (!job) {
        return job.error();
    }
    return start(std::move(*job), std::move(*opened), spec);
}

Result<std::unique_ptr<daemon::RunningImport>> go_on_with_import(const PrintOptions& options, spool::Spool& spool,
                                                                 const spool::Job& job,
                                                                 const spool::SourceFingerprint& source) {
    auto opened = open(options);
    if (!opened) {
        return opened.error();
    }
    auto import = spool.resume_import(job, source);
    if (!import) {
        return import.error();
    }
    return start(std::move(*import), std::move(*opened), {source, job.spec.layout, job.spec.base});
}

Result<void> import_on(daemon::RunningImport& import, const std::function<bool()>& enough,
                       const ImportProgress& on_progress) {
    constexpr int wait_ms = 50;
    while (!enough() && !import.over()) {
        if (import.wants_step()) {
            import.step();
        } else {
            import.wait(wait_ms);
        }
        if (!on_progress(import.rows(), import.fraction())) {
            return Failure{FailureKind::stopped, "the import was cancelled"};
        }
    }
    return import.failure() ? Result<void>{*import.failure()} : Result<void>{};
}

} // namespace linefeed::cli
