// A service that gives prepared answers over a Unix socket, and remembers what it was asked. The answers have the
// shapes of openapi.yaml.
#pragma once

#include "client/json_fields.hpp"

#include <atomic>
#include <deque>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace linefeed::client {

/// What came with a request.
struct AskedRequest {
    std::string line;                          ///< "POST /api/v1/jobs"
    std::map<std::string, std::string> fields; ///< names in lower case
    std::string body;
};

/// Flow: construct, answer() what will be asked, run the command, asked().
class CannedService {
public:
    CannedService();
    ~CannedService();
    CannedService(const CannedService&) = delete;
    CannedService& operator=(const CannedService&) = delete;

    /// The answer to "GET /api/v1/jobs/1"; several answers are given one after the other, the last one again and again.
    void answer(const std::string& line, const Json& body, int status = 200);
    void problem(const std::string& line, int status, const std::string& kind, const std::string& detail,
                 const Json& more = Json::object());
    /// Pieces of a stream, after which the connection is closed.
    void stream(const std::string& line, const std::string& text);
    /// The connection is closed without an answer.
    void hang_up(const std::string& line);

    [[nodiscard]] const std::filesystem::path& socket() const { return socket_; }
    [[nodiscard]] const std::filesystem::path& directory() const { return directory_; }
    [[nodiscard]] std::vector<AskedRequest> asked();
    /// Their first lines.
    [[nodiscard]] std::vector<std::string> lines();

private:
    struct Prepared {
        std::string text; ///< head and body
        bool close = false;
    };
    void prepare(const std::string& line, Prepared prepared);
    void run();
    void serve(int connection);
    bool give(int connection, const AskedRequest& request);

    std::filesystem::path directory_;
    std::filesystem::path socket_;
    int listener_ = -1;
    std::atomic<bool> ending_{false};
    std::mutex mutex_; ///< for what follows
    std::map<std::string, std::deque<Prepared>> answers_;
    std::vector<AskedRequest> asked_;
    std::thread thread_;
};

/// A Job object.
[[nodiscard]] Json job_json(std::int64_t id, const std::string& phase, std::int64_t printed = 0,
                            std::int64_t in_doubt = 0);
/// A Printer object that is reachable and does nothing.
[[nodiscard]] Json printer_json(const std::string& name);
/// A page of a list.
[[nodiscard]] Json page(const std::vector<Json>& items);
[[nodiscard]] Json event_json(std::int64_t id, const std::string& kind, const std::string& message);

} // namespace linefeed::client
