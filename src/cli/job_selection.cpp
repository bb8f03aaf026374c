#include "cli/job_selection.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace linefeed::cli {

namespace {

using Json = nlohmann::ordered_json;

/// Every option that changes the records, in a fixed form.
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

Result<JobSelection> import(const PrintOptions& options, spool::Spool& spool, const spool::JobSpec& spec,
                            const ImportProgress& on_progress) {
    auto source = intake::open_source(
        options.file, {options.columns, options.delimiter, options.header, options.table, options.query});
    if (!source) {
        return source.error();
    }
    const auto charsets = charsets_for(options.encodings, (*source)->column_names());
    if (!charsets) {
        return charsets.error();
    }
    intake::ImportOptions import_options;
    import_options.charsets = *charsets;
    import_options.escapes = options.profile.escapes;
    import_options.properties = options.properties;
    import_options.skip_bad = options.skip_bad;
    import_options.on_progress = on_progress;
    auto outcome = intake::import_source(**source, spool, spec, import_options);
    if (!outcome) {
        return outcome.error();
    }
    return JobSelection{std::move(outcome->job), std::move(outcome->report), true};
}

/// The first records of `grown` are exactly those of `old`.
Result<bool> begins_with(spool::Spool& spool, const spool::Job& grown, const spool::Job& old) {
    if (grown.frame_bytes < old.frame_bytes || grown.records.first() != old.records.first()) {
        return false;
    }
    for (RecordNumber number = old.records.first(); old.records.contains(number);) {
        const auto a = spool.read_page(old.id, number);
        const auto b = spool.read_page(grown.id, number);
        if (!a || !b) {
            return a ? b.error() : a.error();
        }
        const RecordRange both = RecordRange::closed(number, std::min(a->range().last(), b->range().last()));
        if (a->slice(both) != b->slice(both)) {
            return false;
        }
        if (both.last() == old.records.last()) {
            break;
        }
        number = both.last().next();
    }
    return true;
}

/// Printing the same records as a new job is for jobs that are done: otherwise the command that was meant to start
/// again would, given once more to continue, start over.
Result<void> check_finished(spool::Spool& spool, const spool::Job& twin) {
    const auto state = spool.ledger_state(twin.id);
    if (!state) {
        return state.error();
    }
    const bool waiting = state->count(spool::RecordState::open) > RecordCount{0} ||
                         state->count(spool::RecordState::in_doubt) > RecordCount{0} ||
                         !state->next_printable(twin.records).empty();
    if (!state->segments().empty() && waiting) {
        return Failure{FailureKind::usage, "job " + std::to_string(static_cast<std::int64_t>(twin.id)) +
                                               " has the same records and is not finished (" +
                                               std::to_string(state->count(spool::RecordState::printed).value()) +
                                               " of " + std::to_string(twin.records.count().value()) +
                                               " printed): continue it without --new-job"};
    }
    return {};
}

/// Refuses new records under the name of an earlier job whose records they may repeat.
Result<void> check_earlier_jobs(spool::Spool& spool, const spool::Job& job) {
    const auto earlier = spool.find_by_path(job.spec.source.path);
    if (!earlier) {
        return earlier.error();
    }
    for (const spool::Job& old : *earlier) {
        if (old.id == job.id) {
            continue;
        }
        const auto state = spool.ledger_state(old.id);
        if (!state) {
            return state.error();
        }
        if (state->segments().empty()) {
            continue; // nothing of it was ever issued
        }
        const RecordCount printed =
            state->count(spool::RecordState::printed) + state->count(spool::RecordState::skipped);
        const std::string name = "job " + std::to_string(static_cast<std::int64_t>(old.id));
        if (printed < old.records.count()) {
            return Failure{FailureKind::input,
                           job.spec.source.path + " or the way to read it has changed since " + name +
                               " was imported from it, of which " + std::to_string(printed.value()) + " of " +
                               std::to_string(old.records.count().value()) +
                               " records are printed: restore the file and options to go on, or print it from its "
                               "first record as a new job with --new-job"};
        }
        const auto grown = begins_with(spool, job, old);
        if (!grown) {
            return grown.error();
        }
        if (*grown) {
            return Failure{FailureKind::input, job.spec.source.path + " has grown: its first " +
                                                   std::to_string(old.records.count().value()) + " records are " +
                                                   name +
                                                   ", printed already; print the new ones with --new-job --from " +
                                                   std::to_string(old.records.last().value() + std::uint64_t{1}) +
                                                   ", or all of them again with --new-job"};
        }
    }
    return {};
}

} // namespace

Result<JobSelection> select_job(const PrintOptions& options, spool::Spool& spool, const ImportProgress& on_progress) {
    const auto source = intake::fingerprint(options.file);
    if (!source) {
        return source.error();
    }
    const spool::JobSpec spec{*source, layout_of(options), RecordNumber{options.base}};
    const auto known = spool.find_by_source(spec);
    if (!known) {
        return known.error();
    }
    if (*known && !options.new_job) {
        return JobSelection{**known, {}, false};
    }
    auto selection = import(options, spool, spec, on_progress);
    if (!selection || !selection->job) {
        return selection;
    }
    const spool::Job& job = *selection->job;
    const auto same = spool.find_by_content(job.content_sha256, spec.layout);
    if (!same) {
        return same.error();
    }
    const auto twin =
        std::find_if(same->rbegin(), same->rend(), [&](const spool::Job& other) { return other.id != job.id; });
    if (twin != same->rend()) {
        const auto again = options.new_job ? check_finished(spool, *twin) : Result<void>{};
        if (options.new_job && again) {
            return selection;
        }
        if (const auto removed = spool.remove_job(job.id); !removed) {
            return removed.error();
        }
        if (!again) {
            return again.error();
        }
        if (const auto updated = spool.update_source(twin->id, *source); !updated) {
            return updated.error();
        }
        return JobSelection{*twin, {}, false};
    }
    if (options.new_job) {
        return selection;
    }
    if (const auto checked = check_earlier_jobs(spool, job); !checked) {
        if (const auto removed = spool.remove_job(job.id); !removed) {
            return removed.error();
        }
        return checked.error();
    }
    return selection;
}

} // namespace linefeed::cli
