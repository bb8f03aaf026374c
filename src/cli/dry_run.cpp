#include "cli/dry_run.hpp"

#include "intake/layout.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <unistd.h>
#include <utility>

namespace linefeed::cli {

namespace {

using Json = nlohmann::ordered_json;
using spool::RecordState;

/// A frame with its bytes made visible.
Result<std::string> frame_text(spool::Spool& spool, const spool::Job& job, RecordNumber number) {
    const auto page = spool.read_page(job.id, number);
    if (!page) {
        return page.error();
    }
    std::string text;
    for (const char c : page->slice({number, RecordCount{1}})) {
        const auto byte = static_cast<unsigned char>(c);
        char escaped[8];
        std::snprintf(escaped, sizeof escaped, byte < 0x20 || byte >= 0x7F ? "<%02X>" : "%c", byte);
        text += c == '\t' ? "<TAB>" : c == '\r' ? "<CR>" : escaped;
    }
    return text;
}

/// What the spool knows of the same records.
struct Known {
    spool::JobId job{};
    RecordCount printed;
    RecordCount in_doubt; ///< of the whole job: any of them blocks the next run
    RecordCount open;     ///< the same
    RecordRange next;
};

RecordCount count_within(const spool::LedgerState& state, RecordState kind, RecordRange wanted) {
    RecordCount count;
    for (const RecordRange& range : state.ranges(kind)) {
        count +=
            RecordRange::closed(std::max(range.first(), wanted.first()), std::min(range.last(), wanted.last())).count();
    }
    return count;
}

/// The job that a real run would go on with; absent = it would be a new one.
Result<std::optional<Known>> look_up(const PrintOptions& options, const spool::Job& job, RecordRange wanted) {
    std::error_code ignored;
    if (options.new_job || !std::filesystem::exists(options.spool, ignored)) {
        return std::optional<Known>{};
    }
    auto spool = spool::Spool::open_for_reading(options.spool, {});
    if (!spool) {
        return spool.error();
    }
    const auto same = spool->find_by_content(job.content_sha256);
    if (!same) {
        return same.error();
    }
    const auto known = std::find_if(same->rbegin(), same->rend(), [&job](const spool::Job& other) {
        return intake::is_same_way(other.spec.layout, job.spec.layout);
    });
    if (known == same->rend()) {
        return std::optional<Known>{};
    }
    const spool::JobId id = known->id;
    const auto state = spool->ledger_state(id);
    if (!state) {
        return state.error();
    }
    return std::optional{Known{id, count_within(*state, RecordState::printed, wanted),
                               state->count(RecordState::in_doubt), state->count(RecordState::open),
                               state->next_printable(wanted)}};
}

void show_json(const std::vector<std::string>& frames, RecordRange wanted, const std::optional<Known>& known) {
    Json json{{"result", "dry_run"},
              {"exit_code", 0},
              {"records", wanted.count().value()},
              {"first", wanted.first().value()},
              {"last", wanted.last().value()},
              {"frames", frames},
              {"job", nullptr}};
    if (known) {
        json["job"] = static_cast<std::int64_t>(known->job);
        json["printed"] = known->printed.value();
        json["in_doubt"] = known->in_doubt.value();
        json["issued_unknown"] = known->open.value();
        json["next"] = known->next.empty() ? Json(nullptr) : Json(known->next.first().value());
    }
    std::cout << json.dump(2) << std::endl;
}

void show_text(const std::vector<std::string>& frames, RecordRange wanted, const std::optional<Known>& known) {
    for (const std::string& frame : frames) {
        std::cout << frame << '\n';
    }
    if (wanted.count() > RecordCount{frames.size()}) {
        std::cout << "… and " << (wanted.count() - RecordCount{frames.size()}) << " more\n";
    }
    std::cout << "dry run: " << wanted.count() << " records (" << wanted << ") can be printed; nothing was sent\n";
    if (known) {
        std::cout << "job " << static_cast<std::int64_t>(known->job) << ": " << known->printed
                  << " of them are printed";
        if (known->in_doubt > RecordCount{0}) {
            std::cout << "; " << known->in_doubt << " records of the job are in doubt: an operator must decide first";
        } else if (known->open > RecordCount{0}) {
            std::cout << "; the printer would be asked for the fate of " << known->open << " records";
        } else if (!known->next.empty()) {
            std::cout << "; a run would begin with record " << known->next.first();
        }
        std::cout << '\n';
    }
    std::cout.flush();
}

} // namespace

Result<TemporaryDirectory> TemporaryDirectory::make() {
    std::string path = (std::filesystem::temp_directory_path() / "linefeed-XXXXXX").string();
    if (::mkdtemp(path.data()) == nullptr) {
        return Failure{FailureKind::storage, "a temporary directory cannot be made: " + path};
    }
    return TemporaryDirectory{path};
}

TemporaryDirectory::TemporaryDirectory(std::filesystem::path path)
    : path_(std::move(path)) {}

TemporaryDirectory::TemporaryDirectory(TemporaryDirectory&& other) noexcept
    : path_(std::exchange(other.path_, {})) {}

TemporaryDirectory::~TemporaryDirectory() {
    if (!path_.empty()) {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
}

Result<ExitCode> show_dry_run(const PrintOptions& options, spool::Spool& temporary, const spool::Job& job,
                              RecordRange wanted) {
    constexpr std::uint64_t frames_shown = 5;
    std::vector<std::string> frames;
    for (std::uint64_t k = 0; k < std::min(wanted.count().value(), frames_shown); ++k) {
        auto frame = frame_text(temporary, job, wanted.first() + RecordCount{k});
        if (!frame) {
            return frame.error();
        }
        frames.push_back(std::move(*frame));
    }
    const auto known = look_up(options, job, wanted);
    if (!known) {
        return known.error();
    }
    if (options.json) {
        show_json(frames, wanted, *known);
    } else {
        show_text(frames, wanted, *known);
    }
    return ExitCode::done;
}

} // namespace linefeed::cli
