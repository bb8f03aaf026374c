#include "client/service.hpp"

#include "client/json_fields.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <grp.h>
#include <sys/stat.h>
#include <unistd.h>

namespace linefeed::client {

namespace {

constexpr std::string_view http = "http://";
constexpr std::string_view https = "https://";
constexpr const char* start_it = "is linefeedd running? (systemctl status linefeedd)";

/// What a user does who is not in it, or was not when he logged in.
std::string join_group(const std::string& group) {
    return "the members of the group " + group + " may: sudo usermod -aG " + group + " USER, then log in again";
}

Failure usage(std::string message) {
    return {FailureKind::usage, std::move(message)};
}

Result<api::ServiceAddress> from_url(std::string_view url) {
    if (url.starts_with(https)) {
        return usage("--url " + std::string{url} +
                     ": the service itself speaks http:// only; over a network, use a tunnel to its host");
    }
    std::string_view rest = url;
    if (!rest.starts_with(http)) {
        return usage("--url " + std::string{url} + ": expected http://HOST:PORT, without a path");
    }
    rest.remove_prefix(http.size());
    if (rest.ends_with('/')) {
        rest.remove_suffix(1);
    }
    auto address = api::parse_service_address("tcp://" + std::string{rest});
    if (!address) {
        return usage("--url " + std::string{url} + ": expected http://HOST:PORT, without a path");
    }
    return address;
}

/// The token is the first line of its file.
Result<std::string> read_token(const std::filesystem::path& file) {
    std::ifstream stream{file};
    std::string line;
    if (!stream || (!std::getline(stream, line) && stream.bad())) {
        return Failure{FailureKind::input, "cannot read the token in " + file.string() + ": " + std::strerror(errno)};
    }
    const std::size_t end = line.find_last_not_of(" \t\r");
    line.erase(end == std::string::npos ? 0 : end + 1);
    if (line.empty()) {
        return usage(file.string() + " holds no token: its first line should be one");
    }
    return line;
}

} // namespace

Result<ServicePlace> find_service(const ServiceOptions& options, std::string_view variable) {
    ServicePlace place;
    place.chosen = !options.socket.empty() || !options.url.empty() || !variable.empty();
    if (options.url.empty()) {
        if (!options.token_file.empty()) {
            return usage("--token-file belongs to --url: over the socket, the user is known by the operating system");
        }
        place.address.socket = !options.socket.empty() ? options.socket
                               : !variable.empty()     ? std::filesystem::path{variable}
                                                       : std::filesystem::path{default_socket};
        return place;
    }
    if (!options.socket.empty()) {
        return usage("--socket and --url exclude each other");
    }
    auto address = from_url(options.url);
    if (!address) {
        return address.error();
    }
    place.address = *address;
    if (!options.token_file.empty()) {
        auto token = read_token(options.token_file);
        if (!token) {
            return token.error();
        }
        place.token = *token;
    }
    return place;
}

Result<ServicePlace> find_service(const ServiceOptions& options) {
    const char* const variable = std::getenv("LINEFEED_SOCKET");
    return find_service(options, variable == nullptr ? "" : variable);
}

Trouble socket_trouble(const std::filesystem::path& socket) {
    struct stat status {};
    if (::stat(socket.c_str(), &status) != 0) {
        if (errno == EACCES) {
            return {"you may not look into " + socket.parent_path().string(), join_group("linefeed")};
        }
        return {"there is no service at " + socket.string(), start_it};
    }
    if (!S_ISSOCK(status.st_mode)) {
        return {socket.string() + " is no socket", "see control.socket in the configuration of linefeedd"};
    }
    if (::access(socket.c_str(), W_OK) != 0) {
        const group* const owner = ::getgrgid(status.st_gid);
        return {"you may not connect to " + socket.string(),
                join_group(owner == nullptr ? std::to_string(status.st_gid) : owner->gr_name)};
    }
    return {};
}

Service::Service(const ServicePlace& place)
    : Service(api::ClientSettings{.address = place.address, .token = place.token}) {}

Service::Service(const api::ClientSettings& settings)
    : settings_(settings)
    , client_(settings) {}

Service Service::impatient() const {
    api::ClientSettings settings = settings_;
    settings.connect_timeout = std::chrono::seconds{3};
    settings.answer_timeout = std::chrono::seconds{3};
    return Service{settings};
}

Failure Service::explained(const Failure& failure) const {
    if (failure.kind != FailureKind::unreachable || !problem().is_null()) { // it may be a printer that is not
        return failure;
    }
    if (over_socket()) {
        if (const Trouble trouble = socket_trouble(address().socket); !trouble.words.empty()) {
            return {failure.kind, trouble.words + ": " + trouble.advice};
        }
    }
    return failure;
}

Result<Json> Service::get(std::string_view target) {
    auto reply = client_.get(target);
    if (!reply) {
        return explained(reply.error());
    }
    return json_result(std::move(reply->body));
}

Result<std::string> Service::get_bytes(std::string_view target) {
    auto reply = client_.get(target);
    return reply ? Result<std::string>{std::move(reply->text)} : explained(reply.error());
}

Result<std::vector<Json>> Service::list(std::string_view target, std::size_t limit) {
    std::vector<Json> items;
    const auto done = each(target, [&](const Json& item) {
        if (items.size() < limit) {
            items.push_back(item);
        }
        return items.size() < limit;
    });
    if (!done) {
        return done.error();
    }
    return items;
}

Result<void> Service::each(std::string_view target, const std::function<bool(const Json&)>& on_item) {
    auto done = client_.each(target, on_item);
    return done ? done : Result<void>{explained(done.error())};
}

Result<Json> Service::post(std::string_view target, const Json& body) {
    auto reply = client_.post(target, body, api::new_key());
    if (!reply) {
        return explained(reply.error());
    }
    return json_result(std::move(reply->body));
}

Result<Json> Service::post_at_once(std::string_view target) {
    auto reply = client_.post(target, nullptr, {});
    if (!reply) {
        return explained(reply.error());
    }
    return json_result(std::move(reply->body));
}

Result<Json> Service::upload(std::string_view target, const std::filesystem::path& file,
                             std::string_view content_type) {
    auto reply = client_.upload(target, file, content_type, api::new_key());
    if (!reply) {
        return explained(reply.error());
    }
    return json_result(std::move(reply->body));
}

Result<void> Service::follow(std::optional<std::uint64_t> after, const std::function<bool(const Json&)>& on_event,
                             const std::function<bool(const Failure&)>& on_lost) {
    auto done = client_.follow(after, on_event, [&](const Failure& failure) { return on_lost(explained(failure)); });
    return done ? done : Result<void>{explained(done.error())};
}

std::string job_path(std::int64_t job, std::string_view rest) {
    return "/api/v1/jobs/" + std::to_string(job) + std::string{rest};
}

std::string printer_path(std::string_view printer, std::string_view rest) {
    return "/api/v1/printers/" + api::url_encoded(printer) + std::string{rest};
}

} // namespace linefeed::client
