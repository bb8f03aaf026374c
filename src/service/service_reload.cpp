// New settings while the service runs: all of them, or none.
#include "config/reload.hpp"
#include "daemon/events.hpp"
#include "service/service.hpp"

#include <algorithm>

namespace linefeed::service {

namespace event_kind = daemon::event_kind;

namespace {

std::string all_of(const config::Problems& problems) {
    std::string text;
    for (const config::Problem& problem : problems.kept()) {
        text += (text.empty() ? "" : "; ") + config::to_string(problem);
    }
    return problems.more() == 0 ? text : text + "; and " + std::to_string(problems.more()) + " more";
}

std::string all_of(const std::vector<config::Change>& changes) {
    std::string text;
    for (const config::Change& change : changes) {
        text += (text.empty() ? "" : "; ") + config::to_string(change);
    }
    return text;
}

/// Whether the folders look at anything that has changed.
bool concerns_folders(const config::Change& change) {
    return change.key.starts_with("folders.") || change.key.starts_with("layouts.") ||
           (change.key.starts_with("printers.") && change.key.ends_with(".profile"));
}

} // namespace

Result<std::vector<std::string>> Service::reload(const daemon::Caller& caller) {
    const std::lock_guard one_at_a_time{reloads_};
    std::vector<LinePtr> gone;
    std::vector<FolderPtr> old_folders;
    bool folders_change = false;
    auto done = audited(caller, {"reload", "settings"}, [&]() -> Result<std::vector<std::string>> {
        const auto read = load_();
        if (!read) {
            return Failure{FailureKind::usage, "the old settings stay: " + all_of(read.error())};
        }
        const std::lock_guard lock{orders_};
        if (closing_) {
            return Failure{FailureKind::stopped, "the service is ending"};
        }
        const SharedSettings before = settings();
        const std::vector<config::Change> changes = config::diff(*before, *read);
        const auto against = config::blocking(changes, [this](std::string_view printer) {
            const LinePtr there = line(printer);
            return there && !there->idle();
        });
        if (!against.empty()) {
            return Failure{FailureKind::stopped, "the old settings stay: " + all_of(against)};
        }
        const auto after = std::make_shared<const config::Settings>(config::without_restart(*before, *read));
        if (const auto taken = take_over_(*after); !taken) {
            return Failure{taken.error().kind, "the old settings stay: " + taken.error().message};
        }
        folders_change = std::ranges::any_of(changes, concerns_folders);
        {
            const std::lock_guard parts{parts_mutex_};
            settings_ = after;
            for (auto known = lines_.begin(); known != lines_.end();) {
                const auto at = known++;
                if (after->printer(at->first) == nullptr) {
                    gone.push_back(std::move(at->second));
                    lines_.erase(at);
                } else {
                    at->second->use(after);
                }
            }
            if (folders_change) {
                old_folders.swap(folders_);
            }
        }
        std::vector<std::string> lines_of_text;
        std::ranges::transform(changes, std::back_inserter(lines_of_text),
                               [](const config::Change& change) { return config::to_string(change); });
        return lines_of_text;
    });
    // Without the lock: their threads may be waiting for it.
    gone.clear();
    old_folders.clear();
    if (!done) {
        event(event_kind::service_reload_refused, {}, {}, done.error().message);
        return done;
    }
    open_lines();
    if (folders_change) {
        open_folders();
    }
    event(event_kind::service_reloaded, {}, {}, std::to_string(done->size()) + " settings have changed");
    for (const LinePtr& line : lines()) {
        look_for_work(line->printer());
    }
    return done;
}

} // namespace linefeed::service
