#pragma once

// The real bus, through libusb-1.0.

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "drivers/transport/usb.h"

struct libusb_context;

namespace imunoise::drivers::usb {

/// The host's clock: ns since 1970-01-01 UTC.
using HostClock = std::function<std::int64_t()>;

class LibusbBus final : public Bus {
 public:
  /// Stamps transfers by `clock`. Throws plugin::DeviceError (FAILED).
  explicit LibusbBus(HostClock clock);

  std::vector<Address> find(std::span<const Id> ids) override;
  std::unique_ptr<Handle> open(const Address& address) override;

 private:
  HostClock clock_;
  std::shared_ptr<libusb_context> context_;
};

}  // namespace imunoise::drivers::usb
