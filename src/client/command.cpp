#include "client/command.hpp"

#include "cli/print_report.hpp"
#include "cli/progress_view.hpp"

#include <iostream>
#include <unistd.h>

namespace linefeed::client {

namespace {

std::string dump(const Json& json, int indent) {
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

} // namespace

ExitCode run_command(bool json, const std::function<Result<ExitCode>()>& command) {
    const Result<ExitCode> result = command();
    if (!result) {
        cli::show_failure(result.error(), json);
        return cli::exit_code(result.error().kind);
    }
    std::cout.flush();
    if (!std::cout) {
        say("cannot write to standard output");
        return ExitCode::other;
    }
    return *result;
}

ExitCode run_with_service(const CommonOptions& options, const std::function<Result<ExitCode>(Service&)>& command) {
    return run_command(options.json, [&]() -> Result<ExitCode> {
        const auto place = find_service(options.service);
        if (!place) {
            return place.error();
        }
        Service service{*place};
        return command(service);
    });
}

void show_json(const Json& json) {
    std::cout << dump(json, 2) << std::endl;
}

void show_json_line(const Json& json) {
    std::cout << dump(json, -1) << std::endl;
}

void show(const std::string& text) {
    std::cout << text << std::flush;
}

void say(const std::string& message) {
    std::cerr << "linefeed: " << cli::printable(message) << std::endl;
}

Result<bool> confirm(const std::string& question, bool yes, bool json) {
    if (yes) {
        return true;
    }
    if (json || ::isatty(STDIN_FILENO) == 0 || ::isatty(STDERR_FILENO) == 0) {
        return Failure{FailureKind::usage, question + "? Nobody can be asked here: say --yes"};
    }
    std::cerr << cli::printable(question) << "? [y/N] " << std::flush;
    std::string answer;
    if (std::getline(std::cin, answer) && (answer == "y" || answer == "Y" || answer == "yes")) {
        return true;
    }
    say("nothing is done");
    return false;
}

} // namespace linefeed::client
