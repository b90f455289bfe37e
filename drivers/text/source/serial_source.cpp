#include <fmt/format.h>

#include "drivers/plugin/device.h"
#include "drivers/text/source/source.h"
#include "drivers/transport/serial_port.h"

namespace imunoise::text {
namespace {

class SerialSource final : public Source {
 public:
  SerialSource(const std::string& path, std::uint32_t baud)
      : port_(transport::SerialPort::open(path)) {
    if (!port_->set_baud(baud))
      throw plugin::DeviceError(IMUNOISE_BAD_OPTION,
                                fmt::format("{}: the port cannot run at {} baud", path, baud));
  }
  int descriptor() const override { return port_->descriptor(); }
  std::optional<std::size_t> read(std::span<std::uint8_t> into) override {
    return port_->read(into);
  }

 private:
  std::unique_ptr<transport::SerialPort> port_;
};

}  // namespace

SourcePlace serial_source(const std::string& path, std::uint32_t baud) {
  return {path, true,
          [path, baud](const plugin::Wait&) { return std::make_unique<SerialSource>(path, baud); }};
}

}  // namespace imunoise::text
