#include "intake/drop_folder.hpp"

#include "intake/drop_names.hpp"

#include <algorithm>

namespace linefeed::intake {

namespace {

/// So many candidates are looked at in a step that has nothing to import.
constexpr int looks_per_step = 256;
/// A file that is held for so long gets a word: shorter waits are usual.
constexpr Duration silence = std::chrono::seconds{10};

} // namespace

Result<DropFolder> DropFolder::open(DropSettings settings, BatchStore& store, DropEvents& events) {
    auto directory = DropDirectory::open(settings.folder);
    if (!directory) {
        return directory.error();
    }
    const std::string_view network = network_file_system(directory->descriptor());
    const WatchMode mode = settings.mode.value_or(network.empty() ? WatchMode::inotify : WatchMode::poll);
    auto watch = watch_folder(directory->descriptor(), mode, settings.rescan);
    if (!watch) {
        return watch.error();
    }
    if (!network.empty()) {
        const std::string kind{network};
        events.note("", mode == WatchMode::poll ? "the folder lies on " + kind + ": it is polled"
                                                : "the folder lies on " + kind +
                                                      ": what other machines do there may only be seen at the next "
                                                      "look at the whole folder");
    }
    const auto left_over = directory->claimed();
    if (!left_over) {
        return left_over.error();
    }
    DropFolder folder{std::move(settings), std::move(*directory), std::move(*watch), mode, store, events};
    folder.take_up_claimed(*left_over);
    return folder;
}

DropFolder::DropFolder(DropSettings settings, DropDirectory directory, std::unique_ptr<FolderWatch> watch,
                       WatchMode mode, BatchStore& store, DropEvents& events)
    : settings_(std::move(settings))
    , directory_(std::move(directory))
    , watch_(std::move(watch))
    , mode_(mode)
    , store_(store)
    , events_(events)
    , layout_json_(canonical_json(settings_.layout)) {}

void DropFolder::take_up_claimed(const std::vector<std::string>& names) {
    for (const std::string& name : names) {
        const auto look = directory_.look_claimed(name);
        const bool left_over = look && *look && (*look)->changed_ns < settings_.started_ns;
        claimed_.push_back({.kept = name, .name = name, .begun = true, .left_over = left_over});
        // Its done mark may have been left behind; one of a new file of this name has to stay.
        const auto again = directory_.look(name);
        const auto mark = directory_.look(name + std::string{done_mark_ending});
        if (again && !*again && mark && *mark) {
            directory_.remove_mark(name + std::string{done_mark_ending}, **mark);
        }
    }
}

Result<DropFolder::Next> DropFolder::step(Instant now) {
    if (!scan_at_ || now >= *scan_at_) {
        if (auto scanned = scan(now); !scanned) {
            return scanned.error();
        }
    }
    // After the scan: what it has found may just be being written.
    if (auto taken = take_events(now); !taken) {
        return taken.error();
    }
    const auto can_be_read = [now](const Claimed& claimed) { return claimed.not_before <= now; };
    for (int looks = 0; looks < looks_per_step && std::ranges::none_of(claimed_, can_be_read) && !due_.empty() &&
                        due_.begin()->first <= now;
         ++looks) {
        consider(candidates_.find(due_.begin()->second), now);
    }
    const auto batch = std::ranges::find_if(claimed_, can_be_read);
    if (batch == claimed_.end()) {
        return next(now);
    }
    const auto over = handle(*batch, now);
    if (!over) {
        return over.error();
    }
    if (*over) {
        claimed_.erase(batch);
    }
    return next(now);
}

DropFolder::Next DropFolder::next(Instant now) const {
    if (!scan_at_) {
        return {true, now, false}; // events were lost
    }
    Next next{false, *scan_at_, claimed_.empty() && due_.empty()};
    if (!due_.empty()) {
        next.at = std::min(next.at, due_.begin()->first);
    }
    for (const Claimed& claimed : claimed_) {
        next.at = std::min(next.at, claimed.not_before);
    }
    next.more = next.at <= now;
    return next;
}

/// Looks at the whole folder: what is new, what has gone, and all that was held.
Result<void> DropFolder::scan(Instant now) {
    const auto names = directory_.names();
    if (!names) {
        return names.error();
    }
    scan_at_ = now + watch_->rescan_interval();
    for (auto candidate = candidates_.begin(); candidate != candidates_.end();) {
        const auto known = candidate++;
        if (!std::ranges::binary_search(*names, known->first)) {
            forget(known);
        }
    }
    for (const std::string& name : *names) {
        if (!is_batch_name(name, settings_.pattern)) {
            continue;
        }
        const auto [candidate, is_new] = candidates_.try_emplace(name);
        if (is_new || !candidate->second.due) {
            look_at(candidate, now);
        }
    }
    return {};
}

Result<void> DropFolder::take_events(Instant now) {
    read_events_.clear();
    if (auto read = watch_->read(read_events_); !read) {
        return read;
    }
    for (const FolderEvent& event : read_events_) {
        take_event(event, now);
    }
    return {};
}

void DropFolder::take_event(const FolderEvent& event, Instant now) {
    using Kind = FolderEvent::Kind;
    if (event.kind == Kind::lost) {
        for (auto& [name, candidate] : candidates_) {
            candidate.file.events_lost();
        }
        scan_at_.reset();
        return;
    }
    // A mark matters to the file that it speaks of.
    if (const auto marked = candidates_.find(marked_name(event.name)); marked != candidates_.end()) {
        look_at(marked, now);
        return;
    }
    if (!is_batch_name(event.name, settings_.pattern)) {
        return;
    }
    const auto candidate = candidates_.try_emplace(event.name).first;
    SettlingFile& file = candidate->second.file;
    switch (event.kind) {
    case Kind::created:
        file.created();
        break;
    case Kind::moved_in:
        file.moved_in();
        break;
    case Kind::modified:
        file.modified();
        return; // it is looked at when it is closed, or due anyway
    case Kind::closed:
        file.closed();
        break;
    case Kind::gone:
        forget(candidate);
        return;
    case Kind::lost:
        return; // see above
    }
    look_at(candidate, now);
}

void DropFolder::look_at(Candidates::iterator candidate, std::optional<Instant> due) {
    auto& [name, state] = *candidate;
    if (state.due) {
        due_.erase({*state.due, name});
    }
    state.due = due;
    if (due) {
        due_.emplace(*due, name);
    }
}

void DropFolder::forget(Candidates::iterator candidate) {
    look_at(candidate, std::nullopt);
    candidates_.erase(candidate);
}

void DropFolder::consider(Candidates::iterator candidate, Instant now) {
    using Kind = SettleDecision::Kind;
    const std::string& name = candidate->first;
    const auto look = directory_.look(name);
    if (look && !*look) {
        forget(candidate);
        return;
    }
    if (!look) {
        put_off(candidate, {Kind::hold, {}, look.error().message}, now);
        return;
    }
    const auto mark = directory_.look(name + std::string{done_mark_ending});
    auto decision =
        candidate->second.file.decide(settings_.settle, **look, mark ? *mark : std::optional<FileLook>{}, now);
    if (decision.kind == Kind::ready) {
        // Renamed alone, a database would lose what is not copied into it yet.
        for (const char* const companion : {"-wal", "-journal"}) {
            const auto beside = directory_.look(name + companion);
            if (beside && *beside && (*beside)->size_bytes > 0) {
                decision = {Kind::hold, {}, "its " + std::string{companion} + " lies beside it: it is in use"};
            }
        }
    }
    if (decision.kind != Kind::ready) {
        put_off(candidate, decision, now);
        return;
    }
    const std::string ready = name;
    // A rename counts as a change: so this is when it came, or when it was said to be whole.
    const std::int64_t came_ns = std::max((*look)->changed_ns, mark && *mark ? (*mark)->changed_ns : 0);
    events_.reached(DropStep::settled);
    auto kept = directory_.claim(ready);
    if (!kept) {
        put_off(candidate, {Kind::hold, {}, kept.error().message}, now);
        return;
    }
    forget(candidate);
    if (!*kept) {
        return; // it has vanished
    }
    events_.reached(DropStep::claimed);
    if (mark && *mark) {
        directory_.remove_mark(ready + std::string{done_mark_ending}, **mark);
    }
    const auto claimed_look = directory_.look_claimed(**kept);
    const bool same = claimed_look && *claimed_look && same_content(**claimed_look, **look);
    // Another file, or more of it, than that which has settled: it has to settle where it is now.
    claimed_.push_back({.kept = std::move(**kept),
                        .name = ready,
                        .not_before = same ? now : now + settings_.settle.quiet,
                        .left_over = came_ns < settings_.started_ns});
}

void DropFolder::put_off(Candidates::iterator candidate, const SettleDecision& decision, Instant now) {
    using Kind = SettleDecision::Kind;
    auto& [name, state] = *candidate;
    look_at(candidate, decision.kind == Kind::wait ? std::optional{decision.until} : std::nullopt);
    if (state.why != decision.why) {
        state.why = decision.why;
        state.since = now;
        state.told = false;
    }
    if (!state.told && now - state.since >= silence) {
        state.told = true;
        events_.note(name, state.why);
    }
}

std::vector<DropFolder::Staying> DropFolder::staying() const {
    std::vector<Staying> staying;
    for (const auto& [name, candidate] : candidates_) {
        staying.push_back({name, candidate.why});
    }
    return staying;
}

} // namespace linefeed::intake
