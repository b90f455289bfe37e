#include <utility>

#include "drivers/transport/serial_port.h"

namespace imunoise::transport {
namespace {

class TappedPort final : public SerialPort {
 public:
  TappedPort(std::unique_ptr<SerialPort> port, std::function<void(drivers::Bytes)> tap)
      : SerialPort(port->path()), port_(std::move(port)), tap_(std::move(tap)) {}

  bool set_baud(std::uint32_t baud) override { return port_->set_baud(baud); }
  std::size_t read(std::span<std::uint8_t> into) override {
    const std::size_t count = port_->read(into);
    if (count > 0) tap_(into.first(count));
    return count;
  }
  void write(drivers::Bytes bytes) override { port_->write(bytes); }
  int descriptor() const override { return port_->descriptor(); }

 private:
  std::unique_ptr<SerialPort> port_;
  std::function<void(drivers::Bytes)> tap_;
};

}  // namespace

std::unique_ptr<SerialPort> tapped(std::unique_ptr<SerialPort> port,
                                   std::function<void(drivers::Bytes)> tap) {
  if (!tap) return port;
  return std::make_unique<TappedPort>(std::move(port), std::move(tap));
}

}  // namespace imunoise::transport
