#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "drivers/emulator/lines/can_line.h"
#include "drivers/transport/can_frame_bytes.h"

namespace imunoise::emulator {
namespace {

constexpr int kBacklog = 8;

}  // namespace

LocalCanLine::LocalCanLine(std::filesystem::path path) : path_(std::move(path)) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = path_.string();
  const auto checked = [&](bool done, int reason) {
    if (done) return;
    if (descriptor_ >= 0) ::close(descriptor_);
    throw std::system_error(reason, std::generic_category(), name);
  };
  checked(name.size() < sizeof address.sun_path, ENAMETOOLONG);
  std::memcpy(address.sun_path, name.data(), name.size());
  descriptor_ = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  checked(descriptor_ >= 0, errno);
  const auto* const generic = static_cast<const sockaddr*>(static_cast<const void*>(&address));
  // What a server that was killed has left refuses connections; anything else stays.
  if (std::filesystem::is_socket(path_)) {
    const bool served = ::connect(descriptor_, generic, sizeof address) == 0;
    checked(!served, EADDRINUSE);
    std::filesystem::remove(path_);
  }
  checked(::bind(descriptor_, generic, sizeof address) == 0, errno);
  checked(::listen(descriptor_, kBacklog) == 0, errno);
}

LocalCanLine::~LocalCanLine() {
  for (const int listener : listeners_) ::close(listener);
  ::close(descriptor_);
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

void LocalCanLine::accept_listeners() {
  for (;;) {
    const int listener = ::accept4(descriptor_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (listener < 0) return;
    listeners_.push_back(listener);
  }
}

bool LocalCanLine::send(const drivers::CanFrame& frame) {
  accept_listeners();
  const transport::CanFrameBytes bytes = transport::bytes_of(frame);
  bool heard = false;
  std::erase_if(listeners_, [&](int listener) {
    const bool sent = ::send(listener, bytes.bytes.data(), bytes.count, MSG_NOSIGNAL) >= 0;
    heard = heard || sent;
    if (sent || errno == EAGAIN) return false;  // one that does not keep up loses frames
    ::close(listener);
    return true;
  });
  return heard;
}

}  // namespace imunoise::emulator
