// The server over FakeOperations as a program, for the tests in Python: fake_service DIRECTORY [--tokens] [--timeout S]
// [--max-body BYTES] [--max-connections N] [--origin O] [--host H]. It prints the port, and obeys lines on its standard
// input:
//   event KIND MESSAGE · events N · fail KIND MESSAGE · fail · hold · go · reload · changes · last · bytes · quit
#include "api/core.hpp"
#include "api/server.hpp"
#include "fake_operations.hpp"

#include <grp.h>
#include <iostream>
#include <sstream>
#include <unistd.h>

namespace {

using namespace linefeed;

FailureKind kind_of(const std::string& name) {
    using enum FailureKind;
    for (const FailureKind kind : {usage, unreachable, stopped, input, in_doubt, storage, internal}) {
        if (to_string(kind) == name) {
            return kind;
        }
    }
    std::abort();
}

config::Settings settings_of(int argc, char** argv) {
    config::Settings settings;
    const std::filesystem::path directory = argv[1];
    settings.spool = directory / "spool.db";
    settings.control.socket = directory / "linefeed.sock";
    settings.control.group = ::getgrgid(::getgid())->gr_name;
    settings.http.port = 0;
    for (int k = 2; k + 1 < argc; k += 2) {
        const std::string name = argv[k];
        const std::string value = argv[k + 1];
        if (name == "--tokens") {
            settings.http.tokens_file = value;
        } else if (name == "--timeout") {
            settings.http.request_timeout = std::chrono::milliseconds{std::stoi(value)};
        } else if (name == "--max-body") {
            settings.http.max_body = std::stoull(value);
        } else if (name == "--max-connections") {
            settings.http.max_connections = static_cast<std::uint32_t>(std::stoul(value));
        } else if (name == "--origin") {
            settings.http.origins.push_back(value);
        } else if (name == "--host") {
            settings.http.hosts.push_back(value);
        } else if (name == "--listen") {
            settings.http.listen = value;
        }
    }
    return settings;
}

void obey(const std::string& line, api::FakeOperations& operations) {
    std::istringstream words{line};
    std::string what;
    std::string first;
    std::string rest;
    words >> what >> first;
    std::getline(words >> std::ws, rest);
    if (what == "event") {
        operations.add_event(first, rest);
    } else if (what == "events") {
        for (int k = 0; k < std::stoi(first); ++k) {
            operations.add_event("job.queued", std::string(static_cast<std::size_t>(std::stoi(rest)), 'x'));
        }
    } else if (what == "prune") {
        operations.prune_events(static_cast<std::size_t>(std::stoi(first)));
    } else if (what == "fail") {
        operations.fail(first.empty() ? std::nullopt : std::optional{Failure{kind_of(first), rest}});
    } else if (what == "forget") {
        operations.fail_remembering(first.empty() ? std::nullopt : std::optional{Failure{kind_of(first), rest}});
    } else if (what == "hold" || what == "go") {
        operations.hold(what == "hold");
    } else if (what == "changes") {
        std::cout << operations.changes() << std::endl;
        return;
    } else if (what == "last") {
        std::cout << operations.last_change() << std::endl;
        return;
    } else if (what == "bytes") {
        std::cout << operations.last_import_bytes() << std::endl;
        return;
    }
    std::cout << "ok" << std::endl;
}

} // namespace

int main(int argc, char** argv) {
    const config::Settings settings = settings_of(argc, argv);
    api::FakeOperations operations;
    api::Server server{operations, settings};
    if (const auto started = server.start(); !started) {
        std::cout << to_string(started.error().kind) << ": " << started.error().message << std::endl;
        return 1;
    }
    operations.on_reload = [&]() -> Result<std::vector<std::string>> {
        const auto reloaded = server.reload(settings.http);
        return reloaded ? Result<std::vector<std::string>>{std::vector<std::string>{"tokens"}}
                        : Result<std::vector<std::string>>{reloaded.error()};
    };
    std::cout << server.port() << std::endl;
    for (std::string line; std::getline(std::cin, line) && line != "quit";) {
        obey(line, operations);
    }
    operations.hold(false);
    server.stop();
    return 0;
}
