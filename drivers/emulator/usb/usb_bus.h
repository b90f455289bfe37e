#pragma once

// A USB bus whose time is emulated: it runs as fast as it is read.

#include <memory>
#include <vector>

#include "drivers/emulator/usb/usb_peripheral.h"
#include "drivers/transport/usb.h"

namespace imunoise::emulator {

/// Holds one peripheral, with faults of the cable and of the host. It must outlive its devices. One
/// thread at a time.
class EmulatedBus final : public drivers::usb::Bus {
 public:
  /// Borrows the peripheral. `start_ns`: the host's clock at its power-up, ns since 1970-01-01 UTC.
  EmulatedBus(UsbPeripheral& peripheral, std::int64_t start_ns);

  std::vector<drivers::usb::Address> find(std::span<const drivers::usb::Id> ids) override;
  std::unique_ptr<drivers::usb::Handle> open(const drivers::usb::Address& address) override;

  void unplug() { plugged_ = false; }
  /// Power comes on; the host's clock went on for so long meanwhile.
  void plug(Time unplugged_for = Time(0));
  /// open() is refused for want of permission.
  void set_forbidden(bool forbidden) { forbidden_ = forbidden; }
  /// The next receive comes late: the kernel went on with at most so many transfers meanwhile, and
  /// it got no new ones. 0 transfers: the bus itself was busy.
  void hold_up(Time duration, std::size_t transfers = drivers::usb::kTransfersInFlight) {
    hold_up_ = {duration, transfers};
  }
  /// The next packet with an answer loses a byte of it.
  void lose_byte() { loses_byte_ = true; }
  /// The host's clock at a moment of the peripheral.
  std::int64_t host_time_ns(Time time) const { return start_ns_ + time.count(); }

 private:
  friend class EmulatedDevice;

  struct HoldUp {
    Time duration{};
    std::size_t transfers = 0;
  };

  UsbPeripheral& peripheral_;
  std::int64_t start_ns_;
  bool plugged_ = true;
  bool forbidden_ = false;
  HoldUp hold_up_;
  bool loses_byte_ = false;
};

}  // namespace imunoise::emulator
