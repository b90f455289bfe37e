#include "drivers/emulator/lines/can_line.h"

#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "drivers/transport/can_frame_bytes.h"

namespace imunoise::emulator {

SocketCanLine::SocketCanLine(const std::string& interface) {
  const auto checked = [&](int result, const char* what) {
    if (result >= 0) return result;
    const int reason = errno;
    if (descriptor_ >= 0) ::close(descriptor_);
    throw std::system_error(reason, std::generic_category(), interface + ": " + what);
  };
  descriptor_ = checked(::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW), "CAN socket");
  const int on = 1;
  checked(::setsockopt(descriptor_, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on), "CAN FD");
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(::if_nametoindex(interface.c_str()));
  checked(address.can_ifindex > 0 ? 0 : -1, "interface");
  const auto* const generic = static_cast<const sockaddr*>(static_cast<const void*>(&address));
  checked(::bind(descriptor_, generic, sizeof address), "bind");
}

SocketCanLine::~SocketCanLine() { ::close(descriptor_); }

bool SocketCanLine::send(const drivers::CanFrame& frame) {
  const transport::CanFrameBytes bytes = transport::bytes_of(frame);
  return ::write(descriptor_, bytes.bytes.data(), bytes.count) == static_cast<ssize_t>(bytes.count);
}

}  // namespace imunoise::emulator
