#pragma once

#include <sys/socket.h>
#include <sys/types.h>

#include <optional>

namespace imunoise::service {

/// The user whose socket is at the other end of a connected TCP socket, both on this machine:
/// `socket` is ours. The kernel is asked, which answers at once. Nothing where it does not tell.
std::optional<uid_t> owner_of_peer(int socket);

}  // namespace imunoise::service
