#include "drivers/xsens/search.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "drivers/plugin/device.h"
#include "drivers/xsens/codec/messages.h"
#include "drivers/xsens/dialogue.h"

namespace imunoise::xsens {
namespace {

using drivers::XsensMessage;
using std::chrono::milliseconds;

// An awake device acknowledges within milliseconds, behind what waits in buffers.
constexpr milliseconds kQuick{300};
// After a reset it took 1.8 s with an MTi-G-700.
constexpr milliseconds kAfterReset{2500};

std::vector<std::uint32_t> in_order(std::optional<std::uint32_t> first) {
  const auto known = drivers::baud_rates();
  std::vector<std::uint32_t> out(known.begin(), known.end());
  if (!first) return out;
  const auto place = std::find(out.begin(), out.end(), *first);
  if (place != out.end()) std::rotate(out.begin(), place, place + 1);
  return out;
}

class Search {
 public:
  Search(transport::SerialPort& port, const plugin::CancelSignal& cancel)
      : port_(port), cancel_(cancel) {}

  // The rate at which the device is in its configuration state.
  std::uint32_t find(const std::vector<std::uint32_t>& rates) {
    bool heard = false;
    for (const std::uint32_t baud : rates) {
      if (!port_.set_baud(baud)) continue;
      switch (knock(kQuick)) {
        case Knock::kObeys:
          return baud;
        case Knock::kTalks:  // it is here, and must be reset to listen
          if (obeys_after_reset()) return baud;
          [[fallthrough]];
        case Knock::kNoise:
          heard = true;
          break;
        case Knock::kSilent:
          break;
      }
    }
    if (!heard && port_.set_baud(rates.front()) && obeys_after_reset()) return rates.front();
    throw plugin::DeviceError(IMUNOISE_NOT_FOUND, in_vain(rates, heard));
  }

 private:
  enum class Knock { kObeys, kTalks, kNoise, kSilent };

  Knock knock(milliseconds patience) {
    Dialogue dialogue(port_, cancel_);
    if (dialogue.go_to_config(patience)) return Knock::kObeys;
    if (dialogue.heard_messages()) return Knock::kTalks;
    return dialogue.heard_bytes() ? Knock::kNoise : Knock::kSilent;
  }

  bool obeys_after_reset() {
    Dialogue(port_, cancel_).send(XsensMessage::kReset);
    return knock(kAfterReset) == Knock::kObeys;
  }

  std::string in_vain(const std::vector<std::uint32_t>& rates, bool heard) const {
    if (heard) {
      return fmt::format(
          "{}: bytes come, but nothing that answers as an Xsens device at {} to {} baud; is "
          "another program or device on this line?",
          port_.path(), *std::min_element(rates.begin(), rates.end()),
          *std::max_element(rates.begin(), rates.end()));
    }
    return fmt::format(
        "{}: silent at every baud rate; check power, and that the cable carries data",
        port_.path());
  }

  transport::SerialPort& port_;
  const plugin::CancelSignal& cancel_;
};

void change_baud(transport::SerialPort& port, std::uint32_t wanted,
                 const plugin::CancelSignal& cancel) {
  const auto code = drivers::baud_code_of(wanted);
  if (!code) {
    throw plugin::DeviceError(IMUNOISE_BAD_OPTION,
                              fmt::format("{}: the device has no {} baud; it has {}", port.path(),
                                          wanted, fmt::join(drivers::baud_rates(), ", ")));
  }
  Dialogue dialogue(port, cancel);
  dialogue.require(XsensMessage::kSetBaudRate, drivers::payload_of(*code));
  dialogue.ask(XsensMessage::kReset);  // the new rate is in force after it
  if (!port.set_baud(wanted) || !Dialogue(port, cancel).go_to_config(kAfterReset)) {
    throw plugin::DeviceError(
        IMUNOISE_BAD_DEVICE,
        fmt::format("{}: silent after it was set to {} baud; try without the option baud",
                    port.path(), wanted));
  }
}

}  // namespace

FoundDevice find_device(const std::string& path, std::optional<std::uint32_t> wanted,
                        const plugin::CancelSignal& cancel, const plugin::WireTap& tap) {
  auto port = transport::tapped(transport::SerialPort::open(path), tap);
  std::uint32_t baud = Search(*port, cancel).find(in_order(wanted));
  if (wanted && baud != *wanted) {
    change_baud(*port, *wanted, cancel);
    baud = *wanted;
  }
  return {std::move(port), baud};
}

}  // namespace imunoise::xsens
