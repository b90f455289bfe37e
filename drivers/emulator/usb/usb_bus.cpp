#include "drivers/emulator/usb/usb_bus.h"

#include <algorithm>
#include <deque>
#include <utility>

#include "drivers/emulator/usb/usb_answers.h"
#include "drivers/plugin/device.h"

namespace imunoise::emulator {

using namespace std::chrono_literals;
using drivers::usb::Address;
using drivers::usb::Duration;
using drivers::usb::Request;
using drivers::usb::Transfer;
using plugin::DeviceError;

namespace {
constexpr Duration kControlTime = 125us;  // a microframe of high-speed USB
}  // namespace

class EmulatedDevice final : public drivers::usb::Handle {
 public:
  explicit EmulatedDevice(EmulatedBus& bus) : bus_(bus), peripheral_(bus.peripheral_) {}

  void control(const Request& request) override {
    check();
    pass(kControlTime, kForAll);
    if (!peripheral_.control(request)) {
      throw DeviceError(IMUNOISE_FAILED, "the emulated device refuses a request");
    }
  }
  void send(std::vector<std::uint8_t> bytes) override {
    check();
    to_send_.push_back(std::move(bytes));
  }
  std::vector<Transfer> receive(Duration timeout) override {
    const EmulatedBus::HoldUp hold_up = std::exchange(bus_.hold_up_, {});
    pass(hold_up.duration, kForAll, hold_up.transfers);
    if (arrived_.empty() && bus_.plugged_) pass(timeout, kForOne);
    if (arrived_.empty()) check();
    return std::exchange(arrived_, {});
  }
  Duration now() const override { return peripheral_.now(); }
  void sleep(Duration duration) override {
    check();
    pass(duration, kForAll);
  }

 private:
  enum Until { kForOne, kForAll };

  void check() const {
    if (!bus_.plugged_) throw DeviceError(IMUNOISE_DISCONNECTED, "the emulated cable is unplugged");
  }
  // Lets so much time pass, or less where one transfer is enough. The kernel takes up to
  // `transfers` of the device.
  void pass(Duration duration, Until until,
            std::size_t transfers = drivers::usb::kTransfersInFlight) {
    const Time end = peripheral_.now() + duration;
    while (peripheral_.now() < end && (until == kForAll || arrived_.empty())) {
      offer();
      peripheral_.run(end);
      if (arrived_.size() >= transfers) continue;
      if (auto packet = peripheral_.in()) {
        if (bus_.loses_byte_) bus_.loses_byte_ = !lose_byte_of(*packet);
        arrived_.push_back({std::move(*packet), bus_.host_time_ns(peripheral_.now())});
      }
    }
  }

  // Gives the device what it has room for.
  void offer() {
    while (!to_send_.empty()) {
      std::vector<std::uint8_t>& first = to_send_.front();
      const std::size_t accepted = peripheral_.out(first);
      if (accepted < first.size()) {
        first.erase(first.begin(), first.begin() + static_cast<std::ptrdiff_t>(accepted));
        return;
      }
      to_send_.pop_front();
    }
  }

  EmulatedBus& bus_;
  UsbPeripheral& peripheral_;
  std::deque<std::vector<std::uint8_t>> to_send_;
  std::vector<Transfer> arrived_;
};

EmulatedBus::EmulatedBus(UsbPeripheral& peripheral, std::int64_t start_ns)
    : peripheral_(peripheral), start_ns_(start_ns) {}

std::vector<Address> EmulatedBus::find(std::span<const drivers::usb::Id> ids) {
  const UsbIdentity& identity = peripheral_.identity();
  if (!plugged_ || std::find(ids.begin(), ids.end(), identity.id) == ids.end()) return {};
  return {{identity.id, "1-1", identity.serial}};
}

std::unique_ptr<drivers::usb::Handle> EmulatedBus::open(const Address& address) {
  if (!plugged_) throw DeviceError(IMUNOISE_NOT_FOUND, describe(address) + ": is unplugged");
  if (forbidden_) throw DeviceError(IMUNOISE_NO_ACCESS, describe(address) + ": no permission");
  return std::make_unique<EmulatedDevice>(*this);
}

void EmulatedBus::plug(Time unplugged_for) {
  start_ns_ = host_time_ns(peripheral_.now() + unplugged_for);
  peripheral_.power_up();
  plugged_ = true;
}

}  // namespace imunoise::emulator
