#include "drivers/transport/can_socket.h"

#include <fmt/format.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "drivers/plugin/device.h"
#include "drivers/transport/can_frame_bytes.h"

namespace imunoise::transport {
namespace {

constexpr int kReceiveBuffer =
    4 << 20;  // bytes; some seconds of a full bus. The kernel may give less

}  // namespace

void CanSocket::fail(std::int32_t code, const std::string& what) {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
  throw plugin::DeviceError(code, fmt::format("{}: {}", interface_, what));
}

CanSocket::CanSocket(std::string interface, std::span<const CanFilter> filters)
    : interface_(std::move(interface)) {
  constexpr std::string_view kLocal = "unix:";
  if (interface_.starts_with(kLocal)) {
    connect_to_emulator(interface_.substr(kLocal.size()));
    return;
  }
  descriptor_ = ::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
  if (descriptor_ < 0) {
    if (errno == EPERM || errno == EACCES) {
      fail(IMUNOISE_NO_ACCESS, "no permission to open a CAN socket; ask the administrator");
    }
    fail(IMUNOISE_NOT_FOUND,
         fmt::format("this kernel opens no CAN socket ({}); try modprobe can_raw",
                     std::generic_category().message(errno)));
  }
  configure(filters);
  bind_to_interface();
}

CanSocket::~CanSocket() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

template <class Value>
void CanSocket::set(int level, int option, const Value& value) {
  if (::setsockopt(descriptor_, level, option, &value, sizeof value) == 0) return;
  fail(IMUNOISE_FAILED, fmt::format("socket option {}/{}: {}; is the kernel older than 3.6?", level,
                                    option, std::generic_category().message(errno)));
}

void CanSocket::configure(std::span<const CanFilter> filters) {
  std::vector<can_filter> wanted;
  for (const CanFilter& filter : filters) {
    const canid_t flags = CAN_EFF_FLAG | CAN_RTR_FLAG;
    wanted.push_back({filter.id | (filter.extended ? CAN_EFF_FLAG : 0U),
                      flags | (filter.extended ? CAN_EFF_MASK : CAN_SFF_MASK)});
  }
  const auto bytes = static_cast<socklen_t>(wanted.size() * sizeof(can_filter));
  if (::setsockopt(descriptor_, SOL_CAN_RAW, CAN_RAW_FILTER, wanted.data(), bytes) != 0) {
    fail(IMUNOISE_BAD_OPTION, fmt::format("{} messages are too many for the kernel's filter; map "
                                          "fewer with channel=",
                                          wanted.size()));
  }
  set(SOL_CAN_RAW, CAN_RAW_ERR_FILTER, can_err_mask_t{CAN_ERR_MASK});
  set(SOL_CAN_RAW, CAN_RAW_FD_FRAMES, 1);
  stamp_times();
  set(SOL_SOCKET, SO_RXQ_OVFL, 1);
  set(SOL_SOCKET, SO_RCVBUF, kReceiveBuffer);
}

void CanSocket::stamp_times() { set(SOL_SOCKET, SO_TIMESTAMPNS, 1); }

void CanSocket::connect_to_emulator(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) fail(IMUNOISE_NOT_FOUND, "the path is too long");
  std::memcpy(address.sun_path, path.data(), path.size());
  descriptor_ = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const auto* const generic = static_cast<const sockaddr*>(static_cast<const void*>(&address));
  if (descriptor_ < 0 || ::connect(descriptor_, generic, sizeof address) != 0) {
    fail(IMUNOISE_NOT_FOUND,
         fmt::format("{}; is imunoise emulate running?", std::generic_category().message(errno)));
  }
  stamp_times();
}

void CanSocket::bind_to_interface() {
  ifreq request{};
  if (interface_.size() >= sizeof request.ifr_name) {
    fail(IMUNOISE_NOT_FOUND, "no interface has so long a name; see: ip link show type can");
  }
  std::memcpy(request.ifr_name, interface_.data(), interface_.size());
  if (::ioctl(descriptor_, SIOCGIFINDEX, &request) != 0) {
    fail(IMUNOISE_NOT_FOUND, "no such network interface; see: ip -brief link show type can");
  }
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = request.ifr_ifindex;
  const auto* const generic = static_cast<const sockaddr*>(static_cast<const void*>(&address));
  if (::bind(descriptor_, generic, sizeof address) != 0) {
    fail(IMUNOISE_NOT_FOUND,
         fmt::format("no CAN interface ({})", std::generic_category().message(errno)));
  }
  if (::ioctl(descriptor_, SIOCGIFFLAGS, &request) != 0 ||
      (static_cast<unsigned>(request.ifr_flags) & IFF_UP) == 0) {
    fail(IMUNOISE_NOT_FOUND,
         fmt::format("is down; bring it up with the IMU's bit rate: ip link set {} up type can "
                     "bitrate 250000 restart-ms 100",
                     interface_));
  }
}

std::optional<ReceivedCanFrame> CanSocket::receive() {
  CanFrameBytes bytes;
  iovec part = {bytes.bytes.data(), bytes.bytes.size()};
  alignas(cmsghdr) std::array<std::uint8_t, 256> control;
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t count = ::recvmsg(descriptor_, &message, 0);
  if (count < 0) {
    if (errno == EAGAIN || errno == EINTR) return std::nullopt;
    fail(IMUNOISE_DISCONNECTED,
         fmt::format("{}; plug the adapter in, or bring it up: ip link set {} up",
                     std::generic_category().message(errno), interface_));
  }
  if (count == 0) fail(IMUNOISE_DISCONNECTED, "the emulated bus has ended; start it again");
  ReceivedCanFrame out;
  for (cmsghdr* part_of = CMSG_FIRSTHDR(&message); part_of != nullptr;
       part_of = CMSG_NXTHDR(&message, part_of)) {
    if (part_of->cmsg_level != SOL_SOCKET) continue;
    if (part_of->cmsg_type == SCM_TIMESTAMPNS) {
      timespec time{};
      std::memcpy(&time, CMSG_DATA(part_of), sizeof time);
      out.time_ns = time.tv_sec * 1'000'000'000 + time.tv_nsec;
    } else if (part_of->cmsg_type == SO_RXQ_OVFL) {
      std::uint32_t dropped = 0;
      std::memcpy(&dropped, CMSG_DATA(part_of), sizeof dropped);
      out.lost = dropped - std::exchange(dropped_, dropped);
    }
  }
  const auto frame = frame_of(drivers::Bytes(bytes.bytes).first(static_cast<std::size_t>(count)));
  if (!frame) fail(IMUNOISE_BAD_DEVICE, "the kernel delivered an invalid CAN frame");
  out.frame = *frame;
  return out;
}

}  // namespace imunoise::transport
