#include "linefeed/definitions.hpp"

#include <cstdlib>
#include <iostream>
#include <limits>

namespace linefeed {

namespace {} // namespace

cli::ExitCode usage_error(const std::string& problem) {
    std::cerr << "linefeed: " << problem << '\n';
    return cli::ExitCode::usage;
}

void add_output(CLI::App& command, bool& json) {
    command
        .add_option_function<std::string>(
            "-o,--output", [&json](const std::string& format) { json = format == "json"; }, "text or json")
        ->default_str("text")
        ->check(CLI::IsMember({"text", "json"}));
}

std::filesystem::path default_spool() {
    if (const char* state = std::getenv("XDG_STATE_HOME"); state != nullptr && *state != '\0') {
        return std::filesystem::path{state} / "linefeed" / "spool.db";
    }
    if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0') {
        return std::filesystem::path{home} / ".local" / "state" / "linefeed" / "spool.db";
    }
    return "linefeed-spool.db";
}

void add_service(CLI::App& command, client::ServiceOptions& options) {
    constexpr const char* group = "Service";
    command
        .add_option("--socket", options.socket,
                    "Socket of the service; default: LINEFEED_SOCKET, or " + std::string{client::default_socket})
        ->group(group);
    command.add_option("--url", options.url, "Ask the service over TCP instead: http://HOST:PORT (8631 without PORT)")
        ->group(group);
    command.add_option("--token-file", options.token_file, "File with the token for --url")->group(group);
}

void add_common(CLI::App& command, client::CommonOptions& options) {
    add_output(command, options.json);
    add_service(command, options.service);
}

CLI::Option* add_job(CLI::App& command, std::int64_t& job) {
    return command.add_option("JOB", job, "Number of the job, see linefeed jobs")
        ->check(CLI::Range(std::int64_t{1}, std::numeric_limits<std::int64_t>::max()));
}

void add_layout(CLI::App& command, intake::Layout& layout, RawLayout& raw) {
    command
        .add_option("--columns", layout.columns,
                    "Columns to print, by name or number from 1, separated by commas; default: all")
        ->allow_extra_args(false)
        ->delimiter(',');
    command.add_option("--table", layout.table, "Table or view of the SQLite database");
    command.add_option("--query", layout.query, "SELECT statement that gives the records of the SQLite database");
    command.add_option("--delimiter", raw.delimiter,
                       "Separator of the CSV file: one character, or tab; default: found out from the first line");
    command.add_flag("--no-header", raw.no_header, "The first line of the CSV file is a record, not column names");
    command.add_flag("--skip-bad", layout.skip_bad,
                     "Leave rows out that cannot be printed, instead of refusing the file");
    command
        .add_option("--encoding", layout.encodings,
                    "What the printer's font wants: latin1 (default), windows-1252 or unicode-hex; COLUMN=ENCODING for "
                    "one column")
        ->allow_extra_args(false)
        ->delimiter(',');
    command
        .add_option("--graphic", layout.graphics,
                    "Column whose fields are graphics: (height width hex), or the name of a PNG or PBM image of two "
                    "colours")
        ->allow_extra_args(false)
        ->delimiter(',');
    command.add_option("--graphics-folder", raw.graphics_folder, "Where these images are; default: where the file is");
    command.add_option("--profile", raw.profile, "Firmware profile: " + protocol::profile_names())
        ->capture_default_str();
    command.add_option("--base", layout.base, "Record k has number BASE + k")->capture_default_str();
    command.add_flag("--mirrored", layout.properties.mirrored, "Print every record mirrored");
    command.add_option("--orientation", raw.orientation, "Turn every record by 0, 90, 180 or 270 degrees")
        ->check(CLI::IsMember({0, 90, 180, 270}));
}

std::string finish_layout(intake::Layout& layout, const RawLayout& raw) {
    layout.header = !raw.no_header;
    if (!raw.graphics_folder.empty()) {
        layout.graphics_folder = std::filesystem::absolute(raw.graphics_folder).lexically_normal();
    }
    if (raw.delimiter == "tab" || raw.delimiter == "\\t") {
        layout.delimiter = '\t';
    } else if (raw.delimiter.size() == 1) {
        layout.delimiter = raw.delimiter.front();
    } else if (!raw.delimiter.empty()) {
        return "--delimiter: expected one character, or tab";
    }
    const auto profile = protocol::parse_profile(raw.profile);
    if (!profile) {
        return "--profile: " + profile.error().message;
    }
    layout.profile = *profile;
    if (raw.orientation) {
        layout.properties.orientation = static_cast<protocol::Orientation>(*raw.orientation / 90);
    }
    if (layout.table && layout.query) {
        return "--table and --query exclude each other";
    }
    return {};
}

void add_word(CLI::App& command, daemon::OperatorWord& word, RawWord& raw) {
    command.add_option("--last-printed", word.last_printed,
                       "Number or text of the record on the last product: settles records in doubt, where that tells");
    command.add_option(
        "--printed", word.printed,
        "The records in doubt that are on products, all of them: N-M,N or none; the others will be printed");
    command
        .add_option("--in-doubt", raw.in_doubt,
                    "Records in doubt: ask (stop with exit code 6), skip (do not print them again) or reprint")
        ->capture_default_str()
        ->check(CLI::IsMember({"ask", "skip", "reprint"}));
}

std::string finish_word(daemon::OperatorWord& word, const RawWord& raw) {
    word.policy = raw.in_doubt == "skip"      ? daemon::InDoubtPolicy::skip
                  : raw.in_doubt == "reprint" ? daemon::InDoubtPolicy::reprint
                                              : daemon::InDoubtPolicy::ask;
    const bool last_printed = !word.last_printed.empty();
    if (last_printed && word.printed) {
        return "--last-printed and --printed exclude each other";
    }
    if (word.policy != daemon::InDoubtPolicy::ask && (last_printed || word.printed)) {
        return "--in-doubt " + raw.in_doubt + (last_printed ? " and --last-printed" : " and --printed") +
               " exclude each other";
    }
    return {};
}

} // namespace linefeed
