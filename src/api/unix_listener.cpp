#include "api/unix_listener.hpp"

#include <array>
#include <cerrno>
#include <grp.h>
#include <optional>
#include <pwd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <system_error>
#include <unistd.h>

namespace linefeed::api {

namespace {

using boost::asio::local::stream_protocol;

constexpr std::size_t name_service_bytes = 16384; ///< for the texts of an entry

std::string system_message(int error) {
    return std::generic_category().message(error);
}

std::optional<gid_t> group_id(const std::string& name) {
    group entry{};
    group* found = nullptr;
    std::array<char, name_service_bytes> texts{};
    ::getgrnam_r(name.c_str(), &entry, texts.data(), texts.size(), &found);
    return found == nullptr ? std::nullopt : std::optional{entry.gr_gid};
}

/// Takes the file of a dead service away.
Result<void> clear_place(const std::filesystem::path& file) {
    struct stat status {};
    if (::lstat(file.c_str(), &status) != 0) {
        return {};
    }
    if (!S_ISSOCK(status.st_mode)) {
        return Failure{FailureKind::usage,
                       "control.socket " + file.string() + " is a file of another kind: move it away"};
    }
    boost::asio::io_context context;
    stream_protocol::socket probe{context};
    boost::system::error_code error;
    probe.connect(stream_protocol::endpoint{file.string()}, error);
    if (error != boost::asio::error::connection_refused) {
        return Failure{FailureKind::usage, "control.socket " + file.string() +
                                               " is in use: " + (error ? error.message() : "a service answers there") +
                                               ". Stop that one, or set another path"};
    }
    ::unlink(file.c_str());
    return {};
}

} // namespace

Result<void> listen(stream_protocol::acceptor& acceptor, const config::ControlSettings& settings) {
    const std::string file = settings.socket.string();
    const auto failed = [&](const std::string& why) {
        return Failure{FailureKind::unreachable, "cannot listen on " + file + ": " + why};
    };
    const auto group = group_id(settings.group);
    if (!group) {
        return Failure{FailureKind::usage, "control.group: there is no group \"" + settings.group + '"'};
    }
    if (const auto free = clear_place(settings.socket); !free) {
        return free.error();
    }
    boost::system::error_code error;
    acceptor.open(stream_protocol{}, error);
    // The file gets the mode of the socket: until the group is set, only the owner may open it.
    if (!error && ::fchmod(acceptor.native_handle(), S_IRUSR | S_IWUSR) != 0) {
        return failed(system_message(errno));
    }
    if (!error) {
        acceptor.bind(stream_protocol::endpoint{file}, error);
    }
    if (!error) {
        acceptor.listen(boost::asio::socket_base::max_listen_connections, error);
    }
    if (error) {
        return failed(error.message());
    }
    // Not asked for without need: a hardened unit may not give files away.
    struct stat status {};
    const bool has_group = ::lstat(file.c_str(), &status) == 0 && status.st_gid == *group;
    constexpr mode_t owner_and_group = S_IRUSR | S_IWUSR | S_IRGRP | S_IWGRP;
    if ((!has_group && ::chown(file.c_str(), static_cast<uid_t>(-1), *group) != 0) ||
        ::chmod(file.c_str(), owner_and_group) != 0) {
        const std::string why = system_message(errno);
        ::unlink(file.c_str());
        return failed("it cannot be given to the group " + settings.group + ": " + why);
    }
    return {};
}

std::uint64_t socket_inode(const std::filesystem::path& file) {
    struct stat status {};
    return ::lstat(file.c_str(), &status) == 0 ? status.st_ino : 0;
}

void remove_socket(const std::filesystem::path& file, std::uint64_t inode) {
    if (inode != 0 && socket_inode(file) == inode) {
        ::unlink(file.c_str());
    }
}

std::string peer_name(int connected_socket) {
    ucred credentials{};
    socklen_t size = sizeof credentials;
    if (::getsockopt(connected_socket, SOL_SOCKET, SO_PEERCRED, &credentials, &size) != 0) {
        return "unknown";
    }
    const std::string uid = "(uid " + std::to_string(credentials.uid) + ')';
    passwd entry{};
    passwd* found = nullptr;
    std::array<char, name_service_bytes> texts{};
    ::getpwuid_r(credentials.uid, &entry, texts.data(), texts.size(), &found);
    return found == nullptr ? uid : std::string{entry.pw_name} + ' ' + uid;
}

} // namespace linefeed::api
