// A port with a wire behind it, by libserialport.

#include <fmt/format.h>
#include <libserialport.h>
#include <linux/serial.h>
#include <sys/ioctl.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "drivers/plugin/device.h"
#include "drivers/transport/serial_port.h"

namespace imunoise::transport {
namespace {

namespace fs = std::filesystem;

constexpr unsigned kWriteTimeoutMs = 1000;

// libserialport knows ports by their names in /sys/class/tty; a link is followed where it leads to
// one.
std::string port_name(const std::string& path) {
  std::error_code error;
  const fs::path target = fs::canonical(path, error);
  if (error || !fs::exists("/sys/class/tty" / target.filename(), error)) return path;
  return target.string();
}

std::string known_ports() {
  sp_port** ports = nullptr;
  if (sp_list_ports(&ports) != SP_OK) return "none can be listed";
  std::vector<std::string> names;
  for (sp_port** port = ports; *port != nullptr; ++port)
    names.emplace_back(sp_get_port_name(*port));
  sp_free_port_list(ports);
  return names.empty() ? "there is none" : fmt::format("there are {}", fmt::join(names, ", "));
}

// USB converters of FTDI keep bytes back for up to 16 ms unless told not to. Ports that have no
// such setting say so, and nothing is lost.
void ask_for_low_latency(int descriptor) {
  serial_struct settings{};
  if (::ioctl(descriptor, TIOCGSERIAL, &settings) != 0) return;
  settings.flags = static_cast<int>(static_cast<unsigned>(settings.flags) | ASYNC_LOW_LATENCY);
  ::ioctl(descriptor, TIOCSSERIAL, &settings);
}

class WiredPort final : public SerialPort {
 public:
  explicit WiredPort(const std::string& path);
  bool set_baud(std::uint32_t baud) override;
  std::size_t read(std::span<std::uint8_t> into) override;
  void write(drivers::Bytes bytes) override;
  int descriptor() const override { return descriptor_; }

 private:
  struct Closer {
    void operator()(sp_port* port) const {
      sp_close(port);
      sp_free_port(port);
    }
  };
  std::unique_ptr<sp_port, Closer> port_;
  int descriptor_ = -1;
};

WiredPort::WiredPort(const std::string& path) : SerialPort(path) {
  sp_port* port = nullptr;
  if (sp_get_port_by_name(port_name(path).c_str(), &port) != SP_OK) {
    fail(IMUNOISE_NOT_FOUND, fmt::format("no such serial port; {}", known_ports()));
  }
  const auto opened = sp_open(port, SP_MODE_READ_WRITE);
  const int reason = errno;
  if (opened != SP_OK) {
    sp_free_port(port);
    if (reason == EACCES || reason == EPERM) {
      fail(IMUNOISE_NO_ACCESS,
           "no permission; add yourself to the group dialout (usermod -aG dialout USER) and log in "
           "again");
    }
    if (reason == EBUSY) fail(IMUNOISE_NO_ACCESS, "in use by another program; close that first");
    fail(IMUNOISE_NOT_FOUND,
         fmt::format("cannot be opened: {}", std::generic_category().message(reason)));
  }
  port_.reset(port);
  sp_get_port_handle(port, &descriptor_);
  lock(descriptor_);
  if (sp_set_bits(port, 8) != SP_OK || sp_set_parity(port, SP_PARITY_NONE) != SP_OK ||
      sp_set_stopbits(port, 1) != SP_OK || sp_set_flowcontrol(port, SP_FLOWCONTROL_NONE) != SP_OK) {
    fail(IMUNOISE_BAD_DEVICE, "cannot be set to 8 bits without parity and flow control");
  }
  ask_for_low_latency(descriptor_);
}

bool WiredPort::set_baud(std::uint32_t baud) {
  sp_drain(port_.get());  // what was written leaves at the old rate
  const bool done = sp_set_baudrate(port_.get(), static_cast<int>(baud)) == SP_OK;
  if (!done && sp_input_waiting(port_.get()) < 0) fail_as_gone();
  sp_flush(port_.get(), SP_BUF_INPUT);
  return done;
}

std::size_t WiredPort::read(std::span<std::uint8_t> into) {
  const int count = sp_nonblocking_read(port_.get(), into.data(), into.size());
  // The library reads nothing from a port that was hung up, for ever; only other calls fail.
  if (count < 0 || (count == 0 && sp_input_waiting(port_.get()) < 0)) fail_as_gone();
  return static_cast<std::size_t>(count);
}

void WiredPort::write(drivers::Bytes bytes) {
  const int count = sp_blocking_write(port_.get(), bytes.data(), bytes.size(), kWriteTimeoutMs);
  if (count < 0) fail_as_gone();
  if (static_cast<std::size_t>(count) < bytes.size()) {
    fail(IMUNOISE_BAD_DEVICE, "takes no bytes; unplug the device and plug it in again");
  }
}

}  // namespace

std::unique_ptr<SerialPort> open_wired_port(const std::string& path) {
  return std::make_unique<WiredPort>(path);
}

}  // namespace imunoise::transport
