#include "tests/drivers/can/fake_can_bus.h"

#include <dlfcn.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstring>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "drivers/transport/can_frame_bytes.h"

namespace imunoise::testing {
namespace {

constexpr int kIndex = 7;

struct FakeSocket {
  int bus_end = -1;  // -1: the link went down
  bool bound = false;
  bool fd_frames = false;
  bool counts_lost = false;
  can_err_mask_t errors = 0;
  std::vector<can_filter> filters = {{0, 0}};
  std::uint32_t lost = 0;
};

struct FakeKernel {
  std::mutex mutex;
  std::string name;
  bool present = false;
  bool up = false;
  std::map<int, FakeSocket> sockets;  // by the host's descriptor

  void hang_up() {
    for (auto& [descriptor, socket] : sockets) {
      if (socket.bus_end >= 0) ::close(std::exchange(socket.bus_end, -1));
    }
  }
};

FakeKernel& kernel() {
  static FakeKernel kernel;
  return kernel;
}

bool passes(const FakeSocket& socket, const canfd_frame& frame, std::size_t bytes) {
  if (!socket.bound || (bytes == CANFD_MTU && !socket.fd_frames)) return false;
  if ((frame.can_id & CAN_ERR_FLAG) != 0) return (frame.can_id & socket.errors) != 0;
  return std::any_of(socket.filters.begin(), socket.filters.end(), [&](const can_filter& filter) {
    return (frame.can_id & filter.can_mask) == (filter.can_id & filter.can_mask);
  });
}

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

FakeCanBus::FakeCanBus(const std::string& name) {
  const std::lock_guard lock(kernel().mutex);
  kernel().name = name;
  kernel().present = kernel().up = true;
}

FakeCanBus::~FakeCanBus() { unplug(); }

bool FakeCanBus::send(const drivers::CanFrame& frame) {
  const std::lock_guard lock(kernel().mutex);
  if (!kernel().present || !kernel().up) return false;
  const transport::CanFrameBytes bytes = transport::bytes_of(frame);
  canfd_frame raw{};
  std::memcpy(&raw, bytes.bytes.data(), bytes.count);
  bool heard = false;  // a frame that nobody listens to, or no longer, is as good as not sent
  for (auto& [descriptor, socket] : kernel().sockets) {
    if (socket.bus_end < 0 || !passes(socket, raw, bytes.count)) continue;
    heard = ::send(socket.bus_end, bytes.bytes.data(), bytes.count, MSG_NOSIGNAL) >= 0 || heard;
  }
  return heard;
}

void FakeCanBus::lose(std::uint32_t frames) {
  const std::lock_guard lock(kernel().mutex);
  for (auto& [descriptor, socket] : kernel().sockets) socket.lost += frames;
}

void FakeCanBus::set_up(bool up) {
  const std::lock_guard lock(kernel().mutex);
  kernel().up = up;
  if (!up) kernel().hang_up();
}

void FakeCanBus::unplug() {
  const std::lock_guard lock(kernel().mutex);
  kernel().present = false;
  kernel().hang_up();
}

void FakeCanBus::plug_in() {
  const std::lock_guard lock(kernel().mutex);
  kernel().present = kernel().up = true;
}

}  // namespace imunoise::testing

// The C library's functions, for CAN sockets. The program's own are found before those.

using imunoise::testing::FakeSocket;
using imunoise::testing::kernel;
using imunoise::testing::next;

extern "C" int socket(int family, int type, int protocol) noexcept {
  static auto* const real = next<int(int, int, int)>("socket");
  if (family != AF_CAN || protocol != CAN_RAW) return real(family, type, protocol);
  int ends[2];
  const int flags = type & (SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | flags, 0, ends) != 0) return -1;
  const std::lock_guard lock(kernel().mutex);
  FakeSocket fresh;
  fresh.bus_end = ends[1];
  FakeSocket& place = kernel().sockets[ends[0]];  // a closed one had the same number
  if (place.bus_end >= 0) ::close(place.bus_end);
  place = fresh;
  return ends[0];
}

extern "C" int setsockopt(int descriptor, int level, int option, const void* value,
                          socklen_t size) noexcept {
  static auto* const real = next<int(int, int, int, const void*, socklen_t)>("setsockopt");
  {
    const std::lock_guard lock(kernel().mutex);
    const auto found = kernel().sockets.find(descriptor);
    if (found != kernel().sockets.end()) {
      if (level == SOL_SOCKET && option == SO_RXQ_OVFL) found->second.counts_lost = true;
      if (level == SOL_CAN_RAW) {
        switch (option) {
          case CAN_RAW_FILTER:
            found->second.filters.resize(size / sizeof(can_filter));
            std::memcpy(found->second.filters.data(), value, size);
            return 0;
          case CAN_RAW_ERR_FILTER:
            std::memcpy(&found->second.errors, value, sizeof found->second.errors);
            return 0;
          case CAN_RAW_FD_FRAMES:
            found->second.fd_frames = true;
            return 0;
          default:
            errno = ENOPROTOOPT;
            return -1;
        }
      }
    }
  }
  return real(descriptor, level, option, value, size);
}

extern "C" int ioctl(int descriptor, unsigned long request, ...) noexcept {
  static auto* const real = next<int(int, unsigned long, void*)>("ioctl");
  va_list arguments;
  va_start(arguments, request);
  void* const argument = va_arg(arguments, void*);
  va_end(arguments);
  const std::lock_guard lock(kernel().mutex);
  if ((request != SIOCGIFINDEX && request != SIOCGIFFLAGS) ||
      !kernel().sockets.contains(descriptor)) {
    return real(descriptor, request, argument);
  }
  auto& asked = *static_cast<ifreq*>(argument);
  if (!kernel().present || kernel().name != asked.ifr_name) {
    errno = ENODEV;
    return -1;
  }
  if (request == SIOCGIFINDEX) {
    asked.ifr_ifindex = imunoise::testing::kIndex;
  } else {
    asked.ifr_flags = kernel().up ? IFF_UP : 0;
  }
  return 0;
}

extern "C" int bind(int descriptor, const sockaddr* address, socklen_t size) noexcept {
  static auto* const real = next<int(int, const sockaddr*, socklen_t)>("bind");
  if (address->sa_family != AF_CAN) return real(descriptor, address, size);
  const std::lock_guard lock(kernel().mutex);
  kernel().sockets.at(descriptor).bound = true;
  return 0;
}

extern "C" ssize_t recvmsg(int descriptor, msghdr* message, int flags) {
  static auto* const real = next<ssize_t(int, msghdr*, int)>("recvmsg");
  const std::size_t room = message->msg_controllen;
  const ssize_t count = real(descriptor, message, flags);
  const std::lock_guard lock(kernel().mutex);
  const auto found = kernel().sockets.find(descriptor);
  if (found == kernel().sockets.end()) return count;
  if (count == 0) {  // the bus's end is closed
    errno = kernel().present ? ENETDOWN : ENODEV;
    return -1;
  }
  if (count > 0 && found->second.counts_lost && found->second.lost > 0) {
    const std::size_t used = message->msg_controllen;
    message->msg_controllen = room;
    auto* const bytes = static_cast<std::uint8_t*>(message->msg_control) + CMSG_ALIGN(used);
    cmsghdr header{};
    header.cmsg_len = CMSG_LEN(sizeof(std::uint32_t));
    header.cmsg_level = SOL_SOCKET;
    header.cmsg_type = SO_RXQ_OVFL;
    std::memcpy(bytes, &header, sizeof header);
    std::memcpy(bytes + CMSG_LEN(0), &found->second.lost, sizeof found->second.lost);
    message->msg_controllen = CMSG_ALIGN(used) + CMSG_SPACE(sizeof(std::uint32_t));
  }
  return count;
}
