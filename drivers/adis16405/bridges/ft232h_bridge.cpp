#include "drivers/adis16405/bridges/ft232h_bridge.h"

#include <algorithm>
#include <array>

#include "drivers/adis16405/bridges/mpsse.h"
#include "drivers/plugin/device.h"

namespace imunoise::drivers::adis16405 {
namespace {

using namespace std::chrono_literals;

constexpr std::uint16_t kInterfaceA = 1;
enum Command : std::uint8_t { kReset = 0x00, kLatencyTimer = 0x09, kBitMode = 0x0b };
constexpr std::uint16_t kResetAll = 0;
constexpr std::uint16_t kPurgeReceived = 1;
constexpr std::uint16_t kPurgeToSend = 2;
constexpr std::uint16_t kModeOff = 0x0000;
constexpr std::uint16_t kModeMpsse =
    0x020b;  // upper byte the mode, lower the pins that are outputs
// Every frame ends with "send immediately", so the timer only paces packets without data; under
// 12 ms some find that bytes are lost (pyftdi).
constexpr std::uint16_t kLatencyMs = 16;
constexpr usb::Duration kAnswerTime = 1s;

}  // namespace

void Ft232hBridge::start(usb::Handle& usb, Hertz clock) {
  clock_ = clock;
  usb.control({kBitMode, kModeOff, kInterfaceA});  // also ends a wait for data-ready
  usb.control({kReset, kResetAll, kInterfaceA});
  usb.control({kReset, kPurgeReceived, kInterfaceA});
  usb.control({kReset, kPurgeToSend, kInterfaceA});
  usb.control({kLatencyTimer, kLatencyMs, kInterfaceA});
  usb.control({kBitMode, kModeMpsse, kInterfaceA});
  synchronise(usb);
  usb.send(mpsse_setup(clock));
}

// The engine answers a wrong opcode; what came before the answer is of an earlier life.
void Ft232hBridge::synchronise(usb::Handle& usb) const {
  constexpr std::array kAnswer = {kMpsseBadOpcodeAnswer, kMpsseBadOpcode};
  usb.send({kMpsseBadOpcode});
  std::vector<std::uint8_t> came;
  for (const usb::Duration end = usb.now() + kAnswerTime; usb.now() < end;) {
    for (const usb::Transfer& transfer : usb.receive(end - usb.now())) decode(transfer.bytes, came);
    if (std::search(came.begin(), came.end(), kAnswer.begin(), kAnswer.end()) != came.end()) return;
  }
  throw plugin::DeviceError(IMUNOISE_BAD_DEVICE,
                            "FT232H: its MPSSE engine does not answer; unplug it and plug it in "
                            "again; is it an FT232H, not another chip of that identity?");
}

std::vector<std::vector<std::uint8_t>> Ft232hBridge::encode(
    std::span<const SpiFrame> frames) const {
  std::vector<std::uint8_t> out;
  for (const SpiFrame& frame : frames) {
    append_mpsse_transfer(out, frame.send, frame.on_data_ready);
    append_mpsse_mark(out);
    append_mpsse_flush(out);
    if (frame.pause > 0us) append_mpsse_pause(out, frame.pause, clock_);
  }
  return {std::move(out)};
}

bool Ft232hBridge::is_mark(Bytes bytes) const { return is_mpsse_mark(bytes.front()); }

void Ft232hBridge::decode(Bytes transfer, std::vector<std::uint8_t>& out) const {
  strip_ftdi_status(transfer, out);
}

}  // namespace imunoise::drivers::adis16405
