// The printer besides printing: a look at it before a start or for whoever asks, one error acknowledged, the panel
// held. Each is a short conversation on a connection of its own.
#include "daemon/events.hpp"
#include "daemon/wall_clock.hpp"
#include "printer/tasks.hpp"
#include "service/line.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace linefeed::service {

/// That of the settings; an automatic one as the printer has told, if it has.
protocol::Profile Line::known_profile(const config::PrinterSettings& own) const {
    const std::lock_guard lock{mutex_};
    const auto told = protocol::is_automatic(own.profile) && heard_.version
                          ? protocol::profile_for(heard_.version->type, heard_.version->firmware)
                          : std::nullopt;
    return told.value_or(own.profile);
}

Result<printer::ClientSettings> Line::client_settings() const {
    const SharedSettings all = settings();
    const config::PrinterSettings* const own = all->printer(printer_);
    if (own == nullptr) {
        return Failure{FailureKind::stopped, "printer " + printer_ + " is being taken away"};
    }
    auto endpoints = link::resolve(own->address);
    if (!endpoints) {
        return endpoints.error();
    }
    return printer::ClientSettings{.address = link::to_string(own->address),
                                   .endpoints = std::move(*endpoints),
                                   .escapes = known_profile(*own).escapes,
                                   .connect_timeout = own->connect_timeout,
                                   .reply_timeout = own->reply_timeout};
}

std::vector<daemon::Finding> Line::look_at_printer(const printer::ClientSettings& client, const Purpose& purpose) {
    const SharedSettings all = settings();
    const daemon::PreflightFacts facts = [&] {
        const std::lock_guard alone{conversations_};
        return daemon::gather_facts(client);
    }();
    hear(facts);
    learn_identity(facts.version);
    std::string known_serial_number;
    {
        const std::lock_guard lock{mutex_};
        known_serial_number = known_serial_number_;
    }
    return daemon::judge(
        facts, {*all, *all->printer(printer_), known_serial_number, purpose.may_be_printing, purpose.record_escapes});
}

protocol::Profile Line::profile() {
    const SharedSettings all = settings();
    const config::PrinterSettings* const own = all->printer(printer_);
    if (own == nullptr) {
        return protocol::profiles.front();
    }
    const protocol::Profile known = known_profile(*own);
    const auto client = client_settings();
    if (!protocol::is_automatic(known) || !client) {
        return known;
    }
    const printer::Look look = [&] {
        const std::lock_guard alone{conversations_};
        return printer::look_at(*client);
    }();
    hear(look);
    return known_profile(*own);
}

Result<std::vector<daemon::Finding>> Line::preflight() {
    const auto client = client_settings();
    return client ? Result<std::vector<daemon::Finding>>{look_at_printer(*client, {.may_be_printing = !idle()})}
                  : client.error();
}

Result<void> Line::acknowledge(std::uint32_t error) {
    const auto client = client_settings();
    if (!client) {
        return client.error();
    }
    const auto left = [&] {
        const std::lock_guard alone{conversations_};
        return printer::acknowledge(*client, error);
    }();
    if (!left) {
        return left.error();
    }
    const std::lock_guard lock{mutex_};
    if (heard_.machine) {
        heard_.machine->error = *left;
    }
    return {};
}

Result<std::string> Line::carry_out(const printer::Task& task, std::string_view arguments,
                                    const std::function<Result<void>()>& check) {
    auto read = printer::Arguments::parse(task.arguments, arguments);
    if (!read) {
        return read.error();
    }
    const auto danger = printer::danger_of(task, *read);
    const auto empties = printer::empties_fifo(task, *read);
    if (!danger || !empties) {
        return danger ? empties.error() : danger.error();
    }
    const auto client = client_settings();
    if (!client) {
        return client.error();
    }
    std::shared_ptr<void> reservation;
    if (*danger != printer::Danger::none) {
        auto reserved = reserve();
        if (!reserved) {
            return reserved.error();
        }
        reservation = *std::move(reserved);
    }
    if (*empties) {
        if (auto checked = check(); !checked) {
            return checked.error();
        }
    }
    const auto talk = undisturbed();
    const auto connected = printer::PrinterClient::connect(*client);
    if (!connected) {
        return connected.error();
    }
    const SharedSettings all = settings();
    const auto meaning = [&all](const protocol::PrinterError& error) {
        const config::ErrorEntry* const entry = all->errors.find(error);
        return entry == nullptr ? printer::ErrorWords{} : printer::ErrorWords{entry->meaning, entry->advice};
    };
    return printer::carry_out_as_text(task, **connected, {std::move(*read), meaning});
}

Result<void> Line::talk(bool alone, const std::function<Result<void>(printer::PrinterClient&)>& words) {
    const auto client = client_settings();
    const auto reservation = alone ? reserve() : Result<std::shared_ptr<void>>{nullptr};
    if (!client || !reservation) {
        return client ? reservation.error() : client.error();
    }
    const auto talk = undisturbed();
    const auto connected = printer::PrinterClient::connect(*client);
    return connected ? words(**connected) : connected.error();
}

/// Before a conversation that may be long; until what comes back goes. A glance that is under way is waited for.
std::shared_ptr<void> Line::undisturbed() {
    const std::lock_guard alone{conversations_};
    const std::lock_guard lock{mutex_};
    ++talks_;
    return {this, [](Line* line) {
                const std::lock_guard inner{line->mutex_};
                --line->talks_;
            }};
}

/// Before what no job may meet; until the reservation goes.
Result<std::shared_ptr<void>> Line::reserve() {
    const std::lock_guard lock{mutex_};
    if (active_) {
        return Failure{FailureKind::stopped, name_of(*active_) + " is on printer " + printer_ +
                                                 ": stop it first (linefeed stop " + printer_ + ")"};
    }
    ++reserved_;
    return std::shared_ptr<void>{this, [](Line* line) {
                                     {
                                         const std::lock_guard inner{line->mutex_};
                                         --line->reserved_;
                                     }
                                     line->changed_.notify_all();
                                 }};
}

Result<void> Line::accept(const std::string& serial_number) {
    const auto client = client_settings();
    if (!client) {
        return client.error();
    }
    const printer::Look look = [&] {
        const std::lock_guard alone{conversations_};
        return printer::look_at(*client);
    }();
    if (!look.version) {
        return Failure{FailureKind::unreachable,
                       look.unreachable.empty() ? "the printer does not say its serial number" : look.unreachable};
    }
    if (look.version->serial_number != serial_number) {
        return Failure{FailureKind::stopped,
                       "the printer's serial number is " + look.version->serial_number + ", and not " + serial_number};
    }
    auto written =
        services_.access.write([&](spool::Spool& spool) { return spool.write_serial_number(printer_, serial_number); });
    if (written) {
        const std::lock_guard lock{mutex_};
        known_serial_number_ = serial_number;
        heard_.version = look.version;
    }
    return written;
}

/// The first machine that answers is the one that is meant.
void Line::learn_identity(const std::optional<protocol::VersionInfo>& version) {
    if (!version || version->serial_number.empty()) {
        return;
    }
    {
        const std::lock_guard lock{mutex_};
        if (!known_serial_number_.empty()) {
            return;
        }
        known_serial_number_ = version->serial_number;
    }
    const auto written = services_.access.write(
        [&](spool::Spool& spool) { return spool.write_serial_number(printer_, version->serial_number); });
    if (!written) {
        event(daemon::event_kind::storage_failed, {}, written.error().message);
    }
}

/// One look at the printer while nothing else is done with it, on the thread of the line: a job that is to start waits
/// for it, so it is short.
void Line::glance() {
    constexpr Duration patience = std::chrono::seconds{1};
    auto client = client_settings();
    const SharedSettings all = settings();
    const config::PrinterSettings* const own = all->printer(printer_);
    if (own == nullptr) {
        return; // it is being taken away
    }
    const std::unique_lock alone{conversations_, std::try_to_lock};
    const bool free = alone && [this] {
        const std::lock_guard lock{mutex_};
        return talks_ == 0;
    }();
    std::optional<printer::Look> look;
    if (client && free) {
        client->connect_timeout = std::min(client->connect_timeout, patience);
        client->reply_timeout = std::min(client->reply_timeout, patience);
        look = printer::look_at(*client);
    } else if (!client) {
        look.emplace().unreachable = client.error().message; // its name cannot be resolved
    }
    daemon::PrinterWatch::Known known{*all, *own};
    {
        const std::lock_guard lock{mutex_};
        looked_at_ = std::chrono::steady_clock::now();
        const bool ours = panel_ && panel_->held(); // on what may be its only connection
        if (!look || closing_ || (!look->machine && ours)) {
            return;
        }
        known.machine = heard_.machine;
        known.serial_number = known_serial_number_;
    }
    hear(*look);
    const auto news = watch_.take(*look, known);
    {
        const std::lock_guard lock{mutex_};
        link_ = watch_.link();
    }
    for (const daemon::PrinterWatch::News& one : news) {
        event(one.kind, {}, one.words);
    }
    learn_identity(look->version);
}

Result<void> Line::hold_panel(std::optional<Duration> time) {
    const std::lock_guard orders{panel_orders_};
    std::shared_ptr<printer::PanelHold> panel;
    {
        const std::lock_guard lock{mutex_};
        panel = time ? panel_ : std::exchange(panel_, nullptr);
    }
    if (!time) {
        return {}; // letting go of it releases
    }
    if (!panel || !panel->held()) { // perhaps it has another address since
        const auto client = client_settings();
        if (!client) {
            return client.error();
        }
        auto fresh = std::make_shared<printer::PanelHold>(*client);
        {
            const std::lock_guard lock{mutex_};
            panel_ = fresh;
        }
        panel = std::move(fresh); // the old one, if there was one, releases now
    }
    return panel->hold(*time);
}

/// With mutex_ held.
void Line::hear(const daemon::RunProgress& progress) {
    if (!progress.machine || !progress.heard_at) {
        return;
    }
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    const Duration ago = now - progress.heard_at->time_since_epoch();
    heard_.at_ns = daemon::wall_clock_ns() - ago.count();
    heard_.machine = progress.machine;
}

void Line::hear(const daemon::PreflightFacts& facts) {
    hear(printer::Look{{}, facts.machine, facts.version, facts.counters});
}

void Line::hear(const printer::Look& look) {
    const std::lock_guard lock{mutex_};
    if (look.machine) {
        heard_.at_ns = daemon::wall_clock_ns();
        heard_.machine = look.machine;
    }
    if (look.version) {
        heard_.version = look.version;
    }
    if (look.counters && look.counters->total) {
        heard_.total_prints = look.counters->total;
    }
}

} // namespace linefeed::service
