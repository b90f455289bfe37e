#pragma once

// The file of a listening Unix socket.

#include <filesystem>

#include "core/support/result.h"

namespace imunoise::service {

/// A listening socket: its owner and group may connect. A file that a dead process left there is
/// replaced. Error: a path that is too long, a file that is not a socket, a socket in use, or the
/// system's.
Result<int> listen_on(const std::filesystem::path& path);

/// "uid 1000", by whom a connected Unix socket was opened.
std::string peer_of(int socket);

}  // namespace imunoise::service
