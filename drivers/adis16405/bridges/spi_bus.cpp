#include "drivers/adis16405/bridges/spi_bus.h"

#include <fmt/format.h>

#include <cassert>
#include <iterator>
#include <utility>

#include "drivers/adis16405/bridges/cp2130_bridge.h"
#include "drivers/adis16405/bridges/ft232h_bridge.h"
#include "drivers/plugin/device.h"

namespace imunoise::drivers::adis16405 {

std::unique_ptr<SpiBridge> make_bridge(usb::Id id) {
  assert(id == kFt232hId || id == kCp2130Id);
  if (id == kCp2130Id) return std::make_unique<Cp2130Bridge>();
  return std::make_unique<Ft232hBridge>();
}

SpiBus::SpiBus(std::unique_ptr<usb::Handle> usb, std::unique_ptr<SpiBridge> bridge)
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
  if (lost_bytes_) {
    throw plugin::DeviceError(
        IMUNOISE_DISCONNECTED,
        fmt::format("{}: bytes were lost on their way; it is started again. If "
                    "that happens often, use another USB port or cable",
                    bridge_->name()));
  }
  std::vector<SpiAnswer> out;
  for (const usb::Transfer& transfer : usb_->receive(timeout)) {
    bridge_->decode(transfer.bytes, came_);
    cut(transfer.host_time_ns, out);
  }
  return out;
}

// Makes answers of the bytes that came.
void SpiBus::cut(std::int64_t host_time_ns, std::vector<SpiAnswer>& answers) {
  const std::size_t mark = bridge_->mark_bytes();
  Bytes rest = came_;
  while (!expected_.empty() && rest.size() >= mark + expected_.front()) {
    const Bytes answer = rest.first(expected_.front());
    lost_bytes_ = !bridge_->is_mark(rest.subspan(answer.size(), mark));
    if (lost_bytes_) break;
    answers.push_back({{answer.begin(), answer.end()}, host_time_ns});
    rest = rest.subspan(mark + answer.size());
    expected_.pop_front();
  }
  came_.erase(came_.begin(), expected_.empty() ? came_.end() : came_.end() - std::ssize(rest));
}

}  // namespace imunoise::drivers::adis16405
