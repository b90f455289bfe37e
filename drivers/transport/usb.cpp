#include "drivers/transport/usb.h"

#include <fmt/format.h>

namespace imunoise::drivers::usb {

std::string describe(const Address& address) {
  return fmt::format("{:04x}:{:04x} at USB port {}{}{}", address.id.vendor, address.id.product,
                     address.port, address.serial.empty() ? "" : ", serial number ",
                     address.serial);
}

}  // namespace imunoise::drivers::usb
