// The printer besides printing: one error acknowledged, the panel held, whatever else is asked of it. Each is a
// conversation on a connection of its own.
#include "printer/tasks.hpp"
#include "service/line.hpp"

#include <utility>

namespace linefeed::service {

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
                                   .profile = known_profile(*own),
                                   .connect_timeout = own->connect_timeout,
                                   .reply_timeout = own->reply_timeout};
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
    auto found = printer::carry_out_as_text(task, **connected, {std::move(*read), meaning});
    if (found && task.remembered) {
        if (const auto version = printer::ask_version(**connected)) {
            remember(*version);
        }
        remember_probe(*found);
    }
    return found;
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

} // namespace linefeed::service
