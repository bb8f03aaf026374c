// Looks at the printer besides printing: before a start, for whoever asks, and now and then while nothing else is done
// with it. Which machine stands behind its name, what firmware it has, and what state it is in.
#include "daemon/events.hpp"
#include "daemon/wall_clock.hpp"
#include "printer/look.hpp"
#include "service/line.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace linefeed::service {

/// That of the settings; an automatic one as the printer has told, now or before the service was started.
protocol::Profile Line::known_profile(const config::PrinterSettings& own) const {
    const std::lock_guard lock{mutex_};
    const auto told = !protocol::is_automatic(own.profile) ? std::nullopt
                      : heard_.version ? protocol::profile_for(heard_.version->type, heard_.version->firmware)
                      : memory_        ? protocol::profile_for(memory_->type, memory_->firmware)
                                       : std::nullopt;
    return told ? with_own_properties(*told, own.profile.own) : own.profile;
}

std::string Line::known_serial_number() const {
    const std::lock_guard lock{mutex_};
    return known_serial_number_;
}

std::optional<protocol::VersionInfo> Line::look_for_identity(const printer::ClientSettings& client) {
    const printer::Look look = [&] {
        const std::lock_guard alone{conversations_};
        return printer::look_at(client);
    }();
    hear(look);
    learn_identity(look.version);
    return look.version;
}

std::vector<daemon::Finding> Line::look_at_printer(const printer::ClientSettings& client, const Purpose& purpose) {
    const SharedSettings all = settings();
    const daemon::PreflightFacts facts = [&] {
        const std::lock_guard alone{conversations_};
        return daemon::gather_facts(client);
    }();
    hear(facts);
    learn_identity(facts.version);
    const std::string known = known_serial_number();
    return daemon::judge(facts, {*all, *all->printer(printer_), known, purpose.may_be_printing, purpose.records,
                                 printers_of_same_machine(known), keeps_stop_at()});
}

protocol::Profile Line::profile() {
    const SharedSettings all = settings();
    const config::PrinterSettings* const own = all->printer(printer_);
    if (own == nullptr) {
        return protocol::profiles.front();
    }
    const protocol::Profile known = known_profile(*own);
    const bool has_told = [this] {
        const std::lock_guard lock{mutex_};
        return heard_.version.has_value();
    }();
    const auto client = client_settings();
    if (!protocol::is_automatic(known) || has_told || !client) {
        return known;
    }
    const auto reservation = reserve();
    if (!reservation) {
        return known; // a printer that prints is not disturbed for it
    }
    static_cast<void>(look_for_identity(*client));
    return known_profile(*own);
}

Result<std::vector<daemon::Finding>> Line::preflight() {
    const auto client = client_settings();
    return client ? Result<std::vector<daemon::Finding>>{look_at_printer(*client, {.may_be_printing = !idle()})}
                  : client.error();
}

Result<void> Line::accept(const std::string& serial_number) {
    const auto client = client_settings();
    const auto reservation = reserve();
    if (!client || !reservation) {
        return client ? reservation.error() : client.error();
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

/// Other printers of the settings that are known to be this machine.
std::vector<std::string> Line::printers_of_same_machine(const std::string& serial_number) {
    if (serial_number.empty()) {
        return {};
    }
    auto names = services_.access.write([&](spool::Spool& spool) { return spool.printers_of_machine(serial_number); });
    if (!names) {
        return {}; // the spool has said so, or does when something is written
    }
    const SharedSettings all = settings();
    std::erase_if(*names, [&](const std::string& name) { return name == printer_ || all->printer(name) == nullptr; });
    return *std::move(names);
}

/// What a probe has found holds for the machine and the firmware that it has found it of.
void Line::remember(const protocol::VersionInfo& version) {
    spool::PrinterMemory memory{version.serial_number, version.type, version.firmware, {}, 0};
    {
        const std::lock_guard lock{mutex_};
        const auto is_known = [&](const spool::PrinterMemory& known) {
            return known.serial_number == memory.serial_number && known.type == memory.type &&
                   known.firmware == memory.firmware;
        };
        if (memory_ && is_known(*memory_)) {
            return;
        }
        memory_ = memory;
    }
    write_memory(memory);
}

void Line::remember_probe(std::string_view found) {
    spool::PrinterMemory memory;
    {
        const std::lock_guard lock{mutex_};
        memory = memory_.value_or(spool::PrinterMemory{});
        memory.probe = found;
        memory.probed_ns = daemon::wall_clock_ns();
        memory_ = memory;
    }
    write_memory(memory);
}

void Line::write_memory(const spool::PrinterMemory& memory) {
    const auto written =
        services_.access.write([&](spool::Spool& spool) { return spool.write_printer_memory(printer_, memory); });
    if (!written) {
        event(daemon::event_kind::storage_failed, {}, written.error().message);
    }
}

/// By the last probe.
std::optional<bool> Line::keeps_stop_at() const {
    const std::lock_guard lock{mutex_};
    const printer::Json found = memory_ ? printer::Json::parse(memory_->probe, nullptr, false) : printer::Json{};
    const bool told = found.is_object() && found.contains("keeps_stop_at") && found["keeps_stop_at"].is_boolean();
    return told ? std::optional{found["keeps_stop_at"].get<bool>()} : std::nullopt;
}

/// The first machine that answers is the one that is meant, unless another one is known already.
void Line::learn_identity(const std::optional<protocol::VersionInfo>& version) {
    if (version) {
        remember(*version);
    }
    if (!version || version->serial_number.empty()) {
        return;
    }
    const std::string& told = version->serial_number;
    if (!known_serial_number().empty()) {
        return;
    }
    const auto stands =
        services_.access.write([&](spool::Spool& spool) { return spool.learn_serial_number(printer_, told); });
    {
        const std::lock_guard lock{mutex_};
        known_serial_number_ = stands ? *stands : told;
    }
    if (!stands) {
        event(daemon::event_kind::storage_failed, {}, stands.error().message);
    }
    if (const auto names = printers_of_same_machine(told); !names.empty()) {
        event(daemon::event_kind::printer_warning, {},
              "it is the same machine as printer " + names.front() + ", serial number " + told +
                  ". Look at the addresses of both: what one of them starts loses what the other has in the printer");
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
        return talks_ == 0 && !(panel_ && panel_->held()); // what is held is held on what may be its only connection
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
        if (!look || closing_) {
            return;
        }
        failed_looks_ = look->unreachable.empty() ? 0 : failed_looks_ + 1;
        if (look->silent) {
            heard_.machine.reset();
        }
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
    hear(printer::Look{.machine = facts.machine, .version = facts.version, .counters = facts.counters});
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
