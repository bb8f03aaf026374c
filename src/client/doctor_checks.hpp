// What can be seen of the service's surroundings without the service: each check gives one finding with what to do.
#pragma once

#include "client/json_fields.hpp"
#include "config/settings.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace linefeed::client {

/// Finding objects of openapi.yaml.
[[nodiscard]] Json ok(std::string check, std::string words);
[[nodiscard]] Json warning(std::string check, std::string words, std::string advice);
[[nodiscard]] Json problem(std::string check, std::string words, std::string advice);

/// Whether this user may connect to the socket file, and why not.
[[nodiscard]] Json check_socket(const std::filesystem::path& socket);

/// Whether both sides are of one version.
[[nodiscard]] Json check_version(const std::string& client, const std::string& service);

struct ConfigurationCheck {
    Json finding;
    std::optional<config::Settings> settings; ///< if it could be read
};
/// `required` = it was named by the user. `socket` is where the service is looked for; empty = over TCP.
[[nodiscard]] ConfigurationCheck check_configuration(const std::filesystem::path& file, bool required,
                                                     const std::filesystem::path& socket);

/// Room and kind of the file system that a spool lies on.
struct DiskFacts {
    std::uint64_t free_bytes = 0;
    std::uint64_t all_bytes = 0;
    std::string network; ///< name of a network file system; empty = it is none
    bool in_memory = false;
};
/// Absent if nobody may look, or there is no such directory.
[[nodiscard]] std::optional<DiskFacts> disk_facts(const std::filesystem::path& directory);
[[nodiscard]] Json check_disk(const std::filesystem::path& spool, const std::optional<DiskFacts>& facts);

/// The clock of this machine: `synchronised` by NTP or the like.
struct ClockFacts {
    std::int64_t now_ns = 0;
    bool synchronised = false;
};
[[nodiscard]] ClockFacts clock_facts();
[[nodiscard]] Json check_clock(const ClockFacts& facts);

/// `granted` is Status.real_time of the service; `runtime_us` is kernel.sched_rt_runtime_us, absent = not known.
[[nodiscard]] Json check_real_time(const std::string& granted, std::optional<std::int64_t> runtime_us);
[[nodiscard]] std::optional<std::int64_t> real_time_runtime_us();

} // namespace linefeed::client
