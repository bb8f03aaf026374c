#include "service/folder.hpp"

#include "base/assert.hpp"
#include "daemon/events.hpp"
#include "service/layouts.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <poll.h>
#include <utility>

namespace linefeed::service {

namespace event_kind = daemon::event_kind;

namespace {

/// Events are collected for so long: a file that is being written raises one for each write.
constexpr auto event_pause = std::chrono::milliseconds{50};
constexpr auto longest_wait = std::chrono::seconds{60};
/// How long a folder that cannot be used is left alone.
constexpr auto pause_when_down = std::chrono::seconds{5};
constexpr std::size_t most_shown = 100;
/// Ten thousand files that wait need not be listed behind each one that is read.
constexpr auto look_interval = std::chrono::milliseconds{500};

Instant now() {
    return Instant{std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch())};
}

int milliseconds(Duration duration) {
    const auto bounded = std::clamp<Duration>(duration, Duration{0}, longest_wait);
    return static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(bounded).count());
}

spool::Ticket ticket_for(const config::FolderSettings& settings) {
    spool::Ticket ticket;
    ticket.printer = settings.printer;
    ticket.layout = settings.layout;
    ticket.created_by = "folder " + settings.name;
    ticket.autostart = settings.autostart;
    return ticket;
}

} // namespace

Folder::Folder(const FolderServices& services, const config::FolderSettings& settings, const config::Settings& all)
    : services_(services)
    , name_(settings.name)
    , printer_(settings.printer)
    , autostart_(settings.autostart)
    , settings_(drop_settings(settings, all))
    , batches_(services.spool, ticket_for(settings), true, services.counts.records) {
    view_.name = settings.name;
    view_.path = settings.path;
    view_.printer = settings.printer;
    view_.layout = settings.layout;
    settings_.started_ns = services.started_ns;
    thread_ = std::thread{[this] { serve(); }};
}

Folder::~Folder() {
    closing_ = true;
    wake_.notify();
    thread_.join();
}

daemon::FolderView Folder::view() const {
    const std::lock_guard lock{mutex_};
    return view_;
}

void Folder::serve() {
    while (!closing_) {
        if (const auto watched = watch(); !watched && !closing_) {
            down(watched.error());
            wait(-1, now() + pause_when_down);
        }
    }
}

/// Until the service ends, or the folder cannot be used any more.
Result<void> Folder::watch() {
    auto folder = intake::DropFolder::open(settings_, batches_, *this);
    if (!folder) {
        return folder.error();
    }
    up(*folder);
    for (Instant looked = now(); !closing_;) {
        const auto next = folder->step(now());
        if (!next) {
            return next.error();
        }
        if (!next->more || now() - looked >= look_interval) {
            looked = now();
            up(*folder);
        }
        if (!next->more) {
            wait(folder->descriptor(), next->at);
        }
    }
    return {};
}

/// It works; what is not taken yet is shown.
void Folder::up(const intake::DropFolder& folder) {
    std::vector<daemon::FolderView::Staying> staying;
    for (auto& [name, why] : folder.staying()) {
        if (staying.size() == most_shown) {
            break;
        }
        staying.push_back({std::move(name), std::move(why)});
    }
    bool again = false;
    {
        const std::lock_guard lock{mutex_};
        again = !std::exchange(view_.works, true);
        view_.message.clear();
        view_.staying = std::move(staying);
    }
    if (again) {
        event(event_kind::folder_up, "it can be used again");
    }
}

void Folder::wait(int descriptor, Instant until) {
    std::array<pollfd, 2> waiting{{{wake_.descriptor(), POLLIN, 0}, {descriptor, POLLIN, 0}}};
    const Duration left = until - now();
    const Duration pause = std::min<Duration>(left, event_pause);
    if (::poll(waiting.data(), 1, milliseconds(pause)) == 0) {
        ::poll(waiting.data(), waiting.size(), milliseconds(left - pause)); // it leaves a descriptor of -1 out
    }
}

void Folder::down(const Failure& why) {
    {
        const std::lock_guard lock{mutex_};
        view_.message = why.message;
        if (!std::exchange(view_.works, false)) {
            return; // said before
        }
    }
    event(event_kind::folder_down, why.message);
}

void Folder::event(std::string_view kind, std::string message, std::optional<spool::JobId> job) {
    services_.events.add({.kind = std::string{kind},
                          .printer = printer_,
                          .job = job,
                          .message = "folder " + name_ + ": " + std::move(message)});
}

void Folder::finished(const intake::DropReport& report) {
    const std::string what = report.name + ": ";
    switch (report.verdict) {
    case intake::DropVerdict::imported:
        count(view_.imported, services_.counts.imported);
        adopt(*report.job);
        event(event_kind::folder_imported,
              what + "imported " + std::to_string(report.records.count().value()) + " records as job " +
                  std::to_string(static_cast<std::int64_t>(*report.job)) +
                  (report.reason.empty() ? "" : ", " + report.reason),
              report.job);
        services_.on_queued(printer_);
        return;
    case intake::DropVerdict::duplicate:
        count(view_.duplicates, services_.counts.duplicates);
        event(event_kind::folder_duplicate, what + "not imported again: " + report.reason, report.job);
        return;
    case intake::DropVerdict::failed:
        count(view_.failed, services_.counts.failed);
        event(event_kind::folder_failed, what + "rejected: " + report.reason);
        return;
    }
    assertion_failed("DropVerdict", __FILE__, __LINE__);
}

void Folder::count(std::uint64_t& shown, std::atomic<std::uint64_t>& of_service) {
    ++of_service;
    const std::lock_guard lock{mutex_};
    ++shown;
}

/// A job that was imported by one who writes no tickets, or by an earlier linefeed, gets one now.
void Folder::adopt(spool::JobId id) {
    const auto job = services_.spool.write([id](spool::Spool& spool) { return spool.job(id); });
    const auto adopted = job && *job ? batches_.adopt(**job) : Result<bool>{false};
    if (!job || !adopted) {
        event(event_kind::storage_failed, job ? adopted.error().message : job.error().message, id);
    }
}

void Folder::importing(const std::string& name, bool left_over) {
    if (left_over && autostart_) {
        services_.on_left_over(printer_, "folder " + name_ + ": " + name + " came before the service was started");
    }
}

void Folder::note(const std::string& name, const std::string& words) {
    event(event_kind::folder_note, name.empty() ? words : name + ": stays for now: " + words);
}

bool Folder::progress(const std::string& name, std::uint64_t rows, double fraction) {
    const std::lock_guard lock{mutex_};
    view_.message =
        (rows == 0 ? "reading " : "importing ") + name + ", " + std::to_string(static_cast<int>(fraction * 100)) + " %";
    return !closing_;
}

} // namespace linefeed::service
