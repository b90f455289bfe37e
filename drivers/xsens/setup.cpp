#include "drivers/xsens/setup.h"

#include <fmt/format.h>

#include <algorithm>

#include "drivers/plugin/device.h"
#include "drivers/xsens/codec/items.h"

namespace imunoise::xsens {
namespace {

using drivers::LegacyLayout;
using drivers::XsensConfiguration;
using drivers::XsensFormat;
using drivers::XsensItem;
using drivers::XsensMessage;
using drivers::XsensOutput;

constexpr std::uint16_t kEveryMessage = 0xffff;

[[noreturn]] void fail(const Dialogue& dialogue, std::int32_t code, const std::string& what) {
  throw plugin::DeviceError(code, fmt::format("{}: {}", dialogue.path(), what));
}

template <class T>
T or_fail(const Dialogue& dialogue, Result<T> result) {
  if (!result) fail(dialogue, IMUNOISE_BAD_DEVICE, result.error().message);
  return std::move(*result);
}

// The printable text of a payload, without what pads it.
std::string text_of(drivers::Bytes payload) {
  const auto end = std::find_if(payload.begin(), payload.end(),
                                [](std::uint8_t byte) { return byte < 0x20 || byte > 0x7e; });
  std::string out(payload.begin(), end);
  out.erase(out.find_last_not_of(' ') + 1);
  return out;
}

void identify(Dialogue& dialogue, Setup& setup) {
  const auto take = [&](XsensMessage request, drivers::Bytes payload) {
    identify_by({drivers::acknowledged_by(request), payload}, setup);
  };
  take(XsensMessage::kRequestDeviceId, dialogue.require(XsensMessage::kRequestDeviceId));
  for (const XsensMessage request :
       {XsensMessage::kRequestProductCode, XsensMessage::kRequestFirmwareRevision}) {
    if (const auto payload = dialogue.ask(request).payload) take(request, *payload);
  }
}

std::vector<XsensOutput> wanted_outputs(const Settings& settings) {
  std::vector<XsensOutput> out = {
      {static_cast<std::uint16_t>(XsensItem::kPacketCounter), kEveryMessage},
      {static_cast<std::uint16_t>(XsensItem::kSampleTimeFine), kEveryMessage}};
  const auto add = [&](bool wanted, XsensItem item) {
    if (wanted) out.push_back({drivers::id_of(item, settings.format), settings.rate_hz});
  };
  add(settings.outputs.temperature, XsensItem::kTemperature);
  add(settings.outputs.acceleration, XsensItem::kAcceleration);
  add(settings.outputs.rate, XsensItem::kRateOfTurn);
  add(settings.outputs.field, XsensItem::kMagneticField);
  out.push_back({static_cast<std::uint16_t>(XsensItem::kStatusWord), kEveryMessage});
  return out;
}

std::vector<XsensOutput> set_outputs(Dialogue& dialogue, const Settings& settings,
                                     const std::vector<XsensOutput>& present) {
  const std::vector<XsensOutput> wanted = wanted_outputs(settings);
  if (present == wanted) return present;
  dialogue.require(XsensMessage::kSetOutputConfiguration, drivers::payload_of(wanted));
  auto out = or_fail(dialogue, drivers::decode_output_configuration(
                                   dialogue.require(XsensMessage::kSetOutputConfiguration)));
  const auto is_sent = [&](const XsensOutput& output) {
    return std::any_of(out.begin(), out.end(), [&](const XsensOutput& sent) {
      return sent.data_id == output.data_id && sent.rate_hz > 0;
    });
  };
  if (!std::all_of(wanted.begin(), wanted.end(), is_sent)) {
    fail(dialogue, IMUNOISE_BAD_OPTION,
         "the device does not send all of these outputs in this number format; ask for fewer "
         "(output=) or another format");
  }
  return out;
}

XsensConfiguration present_configuration(Dialogue& dialogue) {
  return or_fail(dialogue, drivers::decode_configuration(
                               dialogue.require(XsensMessage::kRequestConfiguration)));
}

XsensConfiguration set_legacy(Dialogue& dialogue, const Settings& settings) {
  if (settings.format == XsensFormat::kFloat64) {
    fail(dialogue, IMUNOISE_BAD_OPTION,
         "legacy MTData has no format float64; choose float32, fixed12_20 or fixed16_32");
  }
  const LegacyLayout layout = drivers::calibrated_layout(settings.outputs, settings.format);
  const std::uint16_t period = drivers::legacy_period(settings.rate_hz);
  const auto fits = [&](const XsensConfiguration& configuration) {
    return configuration.layout == layout && configuration.period == period &&
           configuration.skip_factor == 0;
  };
  XsensConfiguration present = present_configuration(dialogue);
  if (fits(present)) return present;
  const auto set = [&](XsensMessage message, auto number) {
    dialogue.require(message, drivers::payload_of(number));
  };
  set(XsensMessage::kSetPeriod, period);
  set(XsensMessage::kSetOutputSkipFactor, std::uint16_t{0});
  set(XsensMessage::kSetOutputMode, layout.mode);
  set(XsensMessage::kSetOutputSettings, layout.settings);
  present = present_configuration(dialogue);
  if (!fits(present)) {
    fail(dialogue, IMUNOISE_BAD_OPTION,
         fmt::format("the device does not send these outputs at {} Hz; ask for a lower rate or "
                     "fewer outputs",
                     settings.rate_hz));
  }
  return present;
}

}  // namespace

void identify_by(const drivers::XbusFrame& answer, Setup& setup) {
  const drivers::Bytes payload = answer.payload;
  switch (static_cast<XsensMessage>(answer.message_id)) {
    case XsensMessage::kDeviceId:
      setup.serial.clear();
      for (const std::uint8_t byte : payload) setup.serial += fmt::format("{:02X}", byte);
      break;
    case XsensMessage::kProductCode:
      setup.product = text_of(payload);
      break;
    case XsensMessage::kFirmwareRevision:
      if (payload.size() < 3) break;
      setup.firmware = fmt::format("{}.{}.{}", payload[0], payload[1], payload[2]);
      break;
    default:
      break;
  }
}

Setup configure(Dialogue& dialogue, const Settings& settings) {
  Setup out;
  identify(dialogue, out);
  // Only the fourth generation knows this message; without payload it asks.
  const auto answer = dialogue.ask(XsensMessage::kSetOutputConfiguration).payload;
  if (settings.protocol == Protocol::kMtData2 && !answer) {
    fail(dialogue, IMUNOISE_BAD_OPTION,
         fmt::format("{} does not know MTData2; try protocol=legacy", out.product));
  }
  if (answer && settings.protocol != Protocol::kLegacy) {
    out.sends = set_outputs(dialogue, settings,
                            or_fail(dialogue, drivers::decode_output_configuration(*answer)));
  } else {
    if (answer && !answer->empty()) {  // the fourth generation can be sent back to legacy MTData
      dialogue.require(XsensMessage::kSetOutputConfiguration,
                       drivers::payload_of(std::vector<XsensOutput>{{0, 0}}));
    }
    out.sends = set_legacy(dialogue, settings);
  }
  dialogue.require(XsensMessage::kGoToMeasurement);
  return out;
}

}  // namespace imunoise::xsens
