#include "drivers/transport/serial_port.h"

#include <fmt/format.h>
#include <sys/file.h>

#include <string_view>

#include "drivers/plugin/device.h"

namespace imunoise::transport {

std::unique_ptr<SerialPort> SerialPort::open(const std::string& path) {
  constexpr std::string_view kPseudoTerminal = "pty:";
  if (!path.starts_with(kPseudoTerminal)) return open_wired_port(path);
  return open_pseudo_terminal(path.substr(kPseudoTerminal.size()));
}

void SerialPort::lock(int descriptor) const {
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    fail(IMUNOISE_NO_ACCESS, "in use by another program (imunoise itself?); close that first");
  }
}

void SerialPort::fail(std::int32_t code, const std::string& what) const {
  throw plugin::DeviceError(code, fmt::format("{}: {}", path_, what));
}

void SerialPort::fail_as_gone() const {
  fail(IMUNOISE_DISCONNECTED, "the port disappeared; plug the device in again");
}

}  // namespace imunoise::transport
