// The socket file of the service: whose it is, and who stands at its other end.
#pragma once

#include "base/failure.hpp"
#include "config/settings.hpp"

#include <boost/asio/local/stream_protocol.hpp>

#include <string>

namespace linefeed::api {

/// Listens on the socket file, which only its owner and the group may open. A file that a dead service has left is
/// replaced. FailureKind::usage if a living service answers there, it is another kind of file, or there is no such
/// group; ::unreachable if it cannot be made.
[[nodiscard]] Result<void> listen(boost::asio::local::stream_protocol::acceptor& acceptor,
                                  const config::ControlSettings& settings);

/// Removes the file, unless another service has taken its place. `inode` as socket_inode() gave it after listen().
void remove_socket(const std::filesystem::path& file, std::uint64_t inode);
/// 0 = there is no such file.
[[nodiscard]] std::uint64_t socket_inode(const std::filesystem::path& file);

/// "anna (uid 1000)": who has opened the other end, as the kernel knows it.
[[nodiscard]] std::string peer_name(int connected_socket);

} // namespace linefeed::api
