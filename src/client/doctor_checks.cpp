#include "client/doctor_checks.hpp"

#include "cli/wall_time.hpp"
#include "client/service.hpp"
#include "config/load.hpp"
#include "daemon/wall_clock.hpp"
#include "intake/folder_watch.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <linux/magic.h>
#include <sys/statfs.h>
#include <sys/timex.h>
#include <unistd.h>

namespace linefeed::client {

namespace {

Json finding(std::string check, const char* severity, std::string words, std::string advice) {
    return {{"check", std::move(check)},
            {"severity", severity},
            {"words", std::move(words)},
            {"advice", std::move(advice)}};
}

std::string in_gibibytes(std::uint64_t bytes) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f GiB", static_cast<double>(bytes) / (1024.0 * 1024 * 1024));
    return text;
}

} // namespace

Json ok(std::string check, std::string words) {
    return finding(std::move(check), "ok", std::move(words), "");
}

Json warning(std::string check, std::string words, std::string advice) {
    return finding(std::move(check), "warning", std::move(words), std::move(advice));
}

Json problem(std::string check, std::string words, std::string advice) {
    return finding(std::move(check), "problem", std::move(words), std::move(advice));
}

Json check_socket(const std::filesystem::path& socket) {
    const Trouble trouble = socket_trouble(socket);
    return trouble.words.empty() ? ok("socket", "you may connect to " + socket.string())
                                 : problem("socket", trouble.words, trouble.advice);
}

Json check_version(const std::string& client, const std::string& service) {
    if (client == service) {
        return ok("version", "both sides are linefeed " + client);
    }
    return warning("version", "this is linefeed " + client + ", the service is " + service,
                   "restart the service when no printer prints: systemctl restart linefeedd");
}

ConfigurationCheck check_configuration(const std::filesystem::path& file, bool required,
                                       const std::filesystem::path& socket) {
    constexpr const char* name = "configuration";
    if (::access(file.c_str(), R_OK) != 0) {
        const std::string words = "cannot read " + file.string() + ": " + std::strerror(errno);
        const std::string advice =
            errno == EACCES ? "run linefeed doctor as root, or as a member of the group of the file"
                            : "name the configuration of the service with --config FILE (systemctl cat linefeedd)";
        return {required ? problem(name, words, advice) : warning(name, words, advice), std::nullopt};
    }
    const auto settings = config::load(file, {}); // the environment is the client's, not the service's
    if (!settings) {
        const config::Problems& problems = settings.error();
        const std::size_t more = problems.kept().size() - 1 + problems.more();
        return {problem(name,
                        config::to_string(problems.kept().front()) +
                            (more == 0 ? "" : ", and " + std::to_string(more) + " more"),
                        "linefeed check-config " + file.string() + " names all of it"),
                std::nullopt};
    }
    if (!socket.empty() && settings->control.socket != socket) {
        return {warning(name,
                        file.string() + " is good, but its control.socket is " + settings->control.socket.string() +
                            ", and not " + socket.string(),
                        "set LINEFEED_SOCKET, or use --socket"),
                *settings};
    }
    return {ok(name, file.string() + " is good"), *settings};
}

std::optional<DiskFacts> disk_facts(const std::filesystem::path& directory) {
    const int descriptor = ::open(directory.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) {
        return std::nullopt;
    }
    struct statfs status {};
    const bool known = ::fstatfs(descriptor, &status) == 0;
    DiskFacts facts;
    facts.network = intake::network_file_system(descriptor);
    ::close(descriptor);
    if (!known) {
        return std::nullopt;
    }
    const auto block = static_cast<std::uint64_t>(status.f_frsize);
    facts.free_bytes = block * status.f_bavail;
    facts.all_bytes = block * status.f_blocks;
    facts.in_memory = status.f_type == TMPFS_MAGIC || status.f_type == RAMFS_MAGIC;
    return facts;
}

Json check_disk(const std::filesystem::path& spool, const std::optional<DiskFacts>& facts) {
    constexpr const char* name = "spool disk";
    constexpr std::uint64_t problem_bytes = 256ULL << 20U;
    constexpr std::uint64_t warning_bytes = 2ULL << 30U;
    const std::string place = spool.parent_path().string();
    if (!facts) {
        return warning(name, "cannot look at " + place, "is it there? Run linefeed doctor as root");
    }
    if (!facts->network.empty()) {
        return problem(name, place + " is on a network file system (" + facts->network + ")",
                       "SQLite needs a local disk: move the spool (spool: in the configuration)");
    }
    const std::string room = in_gibibytes(facts->free_bytes) + " of " + in_gibibytes(facts->all_bytes) + " are free";
    if (facts->free_bytes < problem_bytes) {
        return problem(name, place + ": " + room, "make room: without it nothing can be printed");
    }
    if (facts->in_memory) {
        return problem(name, place + " is in memory, and gone when the machine is switched off",
                       "move the spool to a disk (spool: in the configuration)");
    }
    if (facts->free_bytes < warning_bytes) {
        return warning(name, place + ": " + room, "make room before it is used up");
    }
    return ok(name, place + ": " + room);
}

ClockFacts clock_facts() {
    timex state{};
    const int result = ::ntp_adjtime(&state);
    return {daemon::wall_clock_ns(), result >= 0 && result != TIME_ERROR && (state.status & STA_UNSYNC) == 0};
}

Json check_clock(const ClockFacts& facts) {
    constexpr const char* name = "clock";
    constexpr std::int64_t year_2024_ns = 1'704'067'200'000'000'000;
    const std::string now = cli::format_local_time(facts.now_ns);
    if (facts.now_ns < year_2024_ns) {
        return problem(name, "it is not " + now, "set the clock: the ledger keeps the times of every print");
    }
    if (!facts.synchronised) {
        return warning(name, now + ", not synchronised",
                       "let systemd-timesyncd or chrony set it: timedatectl set-ntp true");
    }
    return ok(name, now + ", synchronised");
}

Json check_real_time(const std::string& granted, std::optional<std::int64_t> runtime_us) {
    constexpr const char* name = "real time";
    if (runtime_us == 0) {
        return problem(name, "the kernel lets no real-time thread run (kernel.sched_rt_runtime_us is 0)",
                       "sysctl kernel.sched_rt_runtime_us=950000");
    }
    if (granted.find("refused") != std::string::npos) {
        return warning(name, granted,
                       "the unit of the package has the limits: systemctl cat linefeedd, LimitRTPRIO and LimitMEMLOCK");
    }
    return granted.empty() ? warning(name, "nothing is asked for: the feed thread is scheduled like any other",
                                     "set real_time in the configuration")
                           : ok(name, granted);
}

std::optional<std::int64_t> real_time_runtime_us() {
    std::ifstream stream{"/proc/sys/kernel/sched_rt_runtime_us"};
    std::int64_t runtime_us = 0;
    return stream >> runtime_us ? std::optional{runtime_us} : std::nullopt;
}

} // namespace linefeed::client
