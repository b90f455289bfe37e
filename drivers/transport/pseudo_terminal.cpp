// A pseudo-terminal as a serial port: what an emulated device is served on.

#include <asm/termbits.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "core/support/descriptor.h"
#include "drivers/plugin/device.h"
#include "drivers/transport/serial_port.h"

namespace imunoise::transport {
namespace {

class PseudoTerminal final : public SerialPort {
 public:
  explicit PseudoTerminal(const std::string& path);
  bool set_baud(std::uint32_t baud) override;
  std::size_t read(std::span<std::uint8_t> into) override;
  void write(drivers::Bytes bytes) override;
  int descriptor() const override { return owned_.get(); }

 private:
  Descriptor owned_;
};

int open_terminal(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor >= 0) return descriptor;
  const int reason = errno;
  throw plugin::DeviceError(
      reason == EACCES ? IMUNOISE_NO_ACCESS : IMUNOISE_NOT_FOUND,
      fmt::format("pty:{}: cannot be opened ({}); is imunoise emulate running?", path,
                  std::generic_category().message(reason)));
}

PseudoTerminal::PseudoTerminal(const std::string& path)
    : SerialPort("pty:" + path), owned_(open_terminal(path)) {
  lock(owned_.get());
  termios2 mode{};
  if (::ioctl(descriptor(), TCGETS2, &mode) != 0) fail(IMUNOISE_BAD_DEVICE, "is not a terminal");
  mode.c_iflag = mode.c_oflag = mode.c_lflag = 0;  // bytes pass as they are
  ::ioctl(descriptor(), TCSETS2, &mode);
}

bool PseudoTerminal::set_baud(std::uint32_t baud) {
  termios2 mode{};
  if (::ioctl(descriptor(), TCGETS2, &mode) != 0) fail_as_gone();
  mode.c_cflag = (mode.c_cflag & ~static_cast<tcflag_t>(CBAUD)) | BOTHER;
  mode.c_ispeed = mode.c_ospeed = baud;
  const bool done = ::ioctl(descriptor(), TCSETS2, &mode) == 0;
  ::ioctl(descriptor(), TCFLSH, TCIFLUSH);
  return done;
}

std::size_t PseudoTerminal::read(std::span<std::uint8_t> into) {
  const ssize_t count = ::read(descriptor(), into.data(), into.size());
  if (count > 0) return static_cast<std::size_t>(count);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
  fail_as_gone();
}

void PseudoTerminal::write(drivers::Bytes bytes) {
  const ssize_t count = ::write(descriptor(), bytes.data(), bytes.size());
  if (count < 0 && errno != EAGAIN) fail_as_gone();
  if (count != static_cast<ssize_t>(bytes.size())) {
    fail(IMUNOISE_BAD_DEVICE, "takes no bytes; start imunoise emulate again");
  }
}

}  // namespace

std::unique_ptr<SerialPort> open_pseudo_terminal(const std::string& path) {
  return std::make_unique<PseudoTerminal>(path);
}

}  // namespace imunoise::transport
