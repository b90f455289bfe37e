#include "daemon/service/http/unix_socket.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

namespace imunoise::service {
namespace {

constexpr mode_t kOwnerAndGroup = 0660;
constexpr int kBacklog = 64;

struct Address {
  explicit Address(const std::string& path) {
    of.sun_family = AF_UNIX;
    path.copy(of.sun_path, sizeof of.sun_path - 1);
  }
  const sockaddr* get() const {
    return static_cast<const sockaddr*>(static_cast<const void*>(&of));
  }
  sockaddr_un of{};
};

tl::unexpected<Error> trouble(const std::string& path, std::string_view what) {
  return fail(fmt::format("{}: {}: {}", path, what, std::generic_category().message(errno)));
}

// Removes what a process that is gone left behind.
Result<void> make_room(const std::string& path) {
  struct stat found {};
  if (::lstat(path.c_str(), &found) != 0) return {};
  if (!S_ISSOCK(found.st_mode))
    return fail(path + ": exists and is not a socket; choose another path");
  const int probe = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const bool refused =
      ::connect(probe, Address(path).get(), sizeof(sockaddr_un)) != 0 && errno == ECONNREFUSED;
  ::close(probe);
  if (!refused) return fail(path + ": another process uses it; stop it, or choose another path");
  if (::unlink(path.c_str()) != 0) return trouble(path, "cannot be replaced");
  return {};
}

}  // namespace

Result<int> listen_on(const std::filesystem::path& file) {
  const std::string path = file.string();
  if (path.size() >= sizeof(sockaddr_un::sun_path))
    return fail(fmt::format("{}: the path of a socket has at most {} bytes", path,
                            sizeof(sockaddr_un::sun_path) - 1));
  if (auto done = make_room(path); !done) return tl::unexpected(done.error());
  const int out = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  // No client can connect before it listens: the mode is set by then.
  if (out < 0 || ::bind(out, Address(path).get(), sizeof(sockaddr_un)) != 0 ||
      ::chmod(path.c_str(), kOwnerAndGroup) != 0 || ::listen(out, kBacklog) != 0) {
    auto error = trouble(path, "cannot be listened on");
    if (out >= 0) ::close(out);
    return error;
  }
  return out;
}

std::string peer_of(int socket) {
  ucred who{};
  socklen_t size = sizeof who;
  if (::getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &who, &size) != 0) return "unknown";
  return fmt::format("uid {}", who.uid);
}

}  // namespace imunoise::service
