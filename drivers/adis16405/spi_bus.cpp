#include "drivers/adis16405/spi_bus.h"

#include <cassert>
#include <utility>

#include "drivers/adis16405/cp2130_bridge.h"
#include "drivers/adis16405/ft232h_bridge.h"

namespace imunoise::drivers::adis16405 {

std::unique_ptr<SpiBridge> make_bridge(usb::Id id) {
  assert(id == kFt232hId || id == kCp2130Id);
  if (id == kCp2130Id) return std::make_unique<Cp2130Bridge>();
  return std::make_unique<Ft232hBridge>();
}

SpiBus::SpiBus(std::unique_ptr<usb::Device> usb, std::unique_ptr<SpiBridge> bridge)
    : usb_(std::move(usb)), bridge_(std::move(bridge)) {}

void SpiBus::start(Hertz clock) {
  assert(expected_.empty());
  bridge_->start(*usb_, clock);
}

void SpiBus::send(std::span<const SpiFrame> frames) {
  for (const SpiFrame& frame : frames) expected_.push_back(frame.send.size());
  for (std::vector<std::uint8_t>& transfer : bridge_->encode(frames)) {
    usb_->send(std::move(transfer));
  }
}

std::vector<SpiAnswer> SpiBus::receive(usb::Duration timeout) {
  std::vector<SpiAnswer> out;
  for (const usb::Transfer& transfer : usb_->receive(timeout)) {
    bridge_->decode(transfer.bytes, came_);
    cut(transfer.host_time_ns, out);
  }
  return out;
}

// Makes answers of the bytes that came.
void SpiBus::cut(std::int64_t host_time_ns, std::vector<SpiAnswer>& answers) {
  auto next = came_.begin();
  while (!expected_.empty() &&
         came_.end() - next >= static_cast<std::ptrdiff_t>(expected_.front())) {
    const auto end = next + static_cast<std::ptrdiff_t>(expected_.front());
    answers.push_back({{next, end}, host_time_ns});
    expected_.pop_front();
    next = end;
  }
  came_.erase(came_.begin(), expected_.empty() ? came_.end() : next);
}

}  // namespace imunoise::drivers::adis16405
