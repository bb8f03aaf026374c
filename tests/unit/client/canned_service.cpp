#include "canned_service.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <poll.h>
#include <stdexcept>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace linefeed::client {

namespace {

constexpr int look_ms = 20;

std::string head(int status, const std::string& type) {
    return "HTTP/1.1 " + std::to_string(status) + " Canned\r\nContent-Type: " + type + "\r\n";
}

std::string in_lower_case(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

AskedRequest parse_head(const std::string& head) {
    AskedRequest request;
    std::size_t at = head.find("\r\n");
    request.line = head.substr(0, head.rfind(" HTTP/", at));
    while (at + 2 < head.size()) {
        const std::size_t end = head.find("\r\n", at + 2);
        const std::string field = head.substr(at + 2, end - at - 2);
        if (const std::size_t colon = field.find(": "); colon != std::string::npos) {
            request.fields[in_lower_case(field.substr(0, colon))] = field.substr(colon + 2);
        }
        at = end;
    }
    return request;
}

bool readable(int descriptor) {
    pollfd waiting{descriptor, POLLIN, 0};
    return ::poll(&waiting, 1, look_ms) > 0;
}

} // namespace

CannedService::CannedService() {
    std::string name = "/tmp/linefeed-canned-XXXXXX";
    if (::mkdtemp(name.data()) == nullptr) {
        throw std::runtime_error("mkdtemp");
    }
    directory_ = name;
    socket_ = directory_ / "socket";
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    socket_.native().copy(&address.sun_path[0], sizeof address.sun_path - 1);
    listener_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (::bind(listener_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
        ::listen(listener_, 8) != 0) {
        throw std::runtime_error("bind");
    }
    thread_ = std::thread{[this] { run(); }};
}

CannedService::~CannedService() {
    ending_ = true;
    thread_.join();
    ::close(listener_);
    std::filesystem::remove_all(directory_);
}

void CannedService::prepare(const std::string& line, Prepared prepared) {
    const std::lock_guard lock{mutex_};
    answers_[line].push_back(std::move(prepared));
}

void CannedService::answer(const std::string& line, const Json& body, int status) {
    const std::string text = body.dump();
    const std::string type = status < 300 ? "application/json" : "application/problem+json";
    prepare(line, {head(status, type) + "Content-Length: " + std::to_string(text.size()) + "\r\n\r\n" + text, false});
}

void CannedService::problem(const std::string& line, int status, const std::string& kind, const std::string& detail,
                            const Json& more) {
    Json body{{"type", "urn:linefeed:problem:canned"},
              {"title", "Canned"},
              {"status", status},
              {"detail", detail},
              {"kind", kind}};
    body.update(more);
    answer(line, body, status);
}

void CannedService::stream(const std::string& line, const std::string& text) {
    prepare(line, {head(200, "text/event-stream") + "Connection: close\r\n\r\n" + text, true});
}

void CannedService::hang_up(const std::string& line) {
    prepare(line, {"", true});
}

std::vector<AskedRequest> CannedService::asked() {
    const std::lock_guard lock{mutex_};
    return asked_;
}

std::vector<std::string> CannedService::lines() {
    std::vector<std::string> lines;
    for (const AskedRequest& request : asked()) {
        lines.push_back(request.line);
    }
    return lines;
}

/// One connection after the other, since a command has one at a time; a new one ends the one before.
void CannedService::run() {
    while (!ending_) {
        if (readable(listener_)) {
            const int connection = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
            serve(connection);
            ::close(connection);
        }
    }
}

void CannedService::serve(int connection) {
    std::string received;
    while (!ending_) {
        if (const std::size_t end = received.find("\r\n\r\n"); end != std::string::npos) {
            AskedRequest request = parse_head(received.substr(0, end + 2));
            const auto length = request.fields.find("content-length");
            const std::size_t body = length == request.fields.end() ? 0 : std::stoul(length->second);
            if (received.size() >= end + 4 + body) {
                request.body = received.substr(end + 4, body);
                received.erase(0, end + 4 + body);
                if (!give(connection, request)) {
                    return;
                }
                continue;
            }
        }
        if (readable(connection)) {
            std::array<char, 4096> piece{};
            const ssize_t got = ::read(connection, piece.data(), piece.size());
            if (got <= 0) {
                return;
            }
            received.append(piece.data(), static_cast<std::size_t>(got));
        } else if (readable(listener_)) {
            return;
        }
    }
}

bool CannedService::give(int connection, const AskedRequest& request) {
    Prepared prepared{head(404, "text/plain") + "Content-Length: 0\r\n\r\n", false};
    {
        const std::lock_guard lock{mutex_};
        asked_.push_back(request);
        if (const auto found = answers_.find(request.line); found != answers_.end()) {
            prepared = found->second.front();
            if (found->second.size() > 1) {
                found->second.pop_front();
            }
        }
    }
    ::send(connection, prepared.text.data(), prepared.text.size(), MSG_NOSIGNAL);
    return !prepared.close;
}

Json job_json(std::int64_t id, const std::string& phase, std::int64_t printed, std::int64_t in_doubt) {
    constexpr std::int64_t all = 1000;
    const Json next = printed < all ? Json{{"first", printed + 1}, {"last", all}, {"count", all - printed}} : Json();
    return {{"id", id},
            {"name", "names.csv"},
            {"source", "/data/names.csv"},
            {"printer", "line1"},
            {"layout", "names"},
            {"phase", phase},
            {"message", ""},
            {"autostart", false},
            {"place", nullptr},
            {"records", {{"first", 1}, {"last", all}, {"count", all}}},
            {"printed", printed},
            {"in_doubt", in_doubt},
            {"open", 0},
            {"skipped", 0},
            {"last_printed", printed == 0 ? Json() : Json(printed)},
            {"next", next},
            {"created", "2026-11-22T19:45:50.123Z"},
            {"created_ns", 1795376750123000000},
            {"created_by", "anna (uid 1000)"}};
}

Json printer_json(const std::string& name) {
    return {{"name", name},
            {"address", "tcp://192.168.1.20:3000"},
            {"profile", "jet3up"},
            {"link", "up"},
            {"watched", true},
            {"phase", "idle"},
            {"machine", "ready for action"},
            {"nozzle", "open"},
            {"cover_open", false},
            {"serial_number", "JET-1"},
            {"known_serial_number", "JET-1"},
            {"firmware", "72.0"},
            {"total_prints", 4711},
            {"error", nullptr},
            {"panel_suspended", false},
            {"job", nullptr},
            {"queue", Json::array()},
            {"autostart", false},
            {"held", false},
            {"figures",
             {{"fifo_depth", 0},
              {"fifo_entries", 0},
              {"credit", 0},
              {"rate_per_s", 0.0},
              {"lead_time_s", nullptr},
              {"time_to_empty_s", nullptr},
              {"data_left_s", nullptr}}},
            {"warnings", Json::array()},
            {"heard", "2026-11-22T19:45:50.123Z"},
            {"heard_ns", 1795376750123000000}};
}

Json page(const std::vector<Json>& items) {
    return {{"items", items}, {"next", nullptr}};
}

Json event_json(std::int64_t id, const std::string& kind, const std::string& message) {
    return {{"id", id},
            {"time", "2026-11-22T19:45:50.123Z"},
            {"time_ns", 1795376750123000000},
            {"kind", kind},
            {"printer", "line1"},
            {"job", 12},
            {"record", nullptr},
            {"message", message}};
}

} // namespace linefeed::client
