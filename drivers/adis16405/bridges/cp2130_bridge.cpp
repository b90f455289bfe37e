#include "drivers/adis16405/bridges/cp2130_bridge.h"

#include <cassert>

#include "drivers/adis16405/bridges/cp2130.h"

namespace imunoise::drivers::adis16405 {
namespace {

using namespace std::chrono_literals;

constexpr std::uint8_t kChannel = 0;
constexpr usb::Duration kQuiet = 20ms;

}  // namespace

void Cp2130Bridge::start(usb::Handle& usb, Hertz clock) {
  // Requests while a transfer runs hang the chip: first hear the answers of an earlier life.
  while (!usb.receive(kQuiet).empty()) {
  }
  for (const Cp2130Request& request :
       {cp2130_select_only(kChannel), cp2130_spi_word(kChannel, clock),
        cp2130_no_delays(kChannel)}) {
    usb.control({request.request, 0, 0, request.data});
  }
}

std::vector<std::vector<std::uint8_t>> Cp2130Bridge::encode(
    std::span<const SpiFrame> frames) const {
  std::vector<std::vector<std::uint8_t>> out;
  for (const SpiFrame& frame : frames) {
    assert(!frame.on_data_ready);
    out.push_back(cp2130_write_read(frame.send));
  }
  return out;
}

void Cp2130Bridge::decode(Bytes transfer, std::vector<std::uint8_t>& out) const {
  out.insert(out.end(), transfer.begin(), transfer.end());
}

}  // namespace imunoise::drivers::adis16405
