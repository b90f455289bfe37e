// The driver "xsens": MTi-G and MTi-G-710 on a serial port.

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "drivers/plugin.h"
#include "drivers/xsens/device.h"

namespace imunoise::xsens {
namespace {

template <class Value, std::size_t kCount>
using Choices = std::array<std::pair<const char*, Value>, kCount>;

constexpr Choices<Protocol, 3> kProtocols = {
    {{"auto", Protocol::kAuto}, {"mtdata2", Protocol::kMtData2}, {"legacy", Protocol::kLegacy}}};
constexpr Choices<drivers::XsensFormat, 4> kFormats = {
    {{"float32", drivers::XsensFormat::kFloat32},
     {"fixed12_20", drivers::XsensFormat::kFixed12_20},
     {"fixed16_32", drivers::XsensFormat::kFixed16_32},
     {"float64", drivers::XsensFormat::kFloat64}}};
constexpr Choices<bool drivers::LegacyCalibrated::*, 4> kOutputs = {
    {{"acc", &drivers::LegacyCalibrated::acceleration},
     {"gyro", &drivers::LegacyCalibrated::rate},
     {"mag", &drivers::LegacyCalibrated::field},
     {"temperature", &drivers::LegacyCalibrated::temperature}}};

template <class Value, std::size_t kCount>
std::vector<std::string> names_of(const Choices<Value, kCount>& choices) {
  std::vector<std::string> out;
  for (const auto& choice : choices) out.emplace_back(choice.first);
  return out;
}

// Precondition: one of the names, which the host has seen to.
template <class Value, std::size_t kCount>
Value chosen(const Choices<Value, kCount>& choices, const std::string& name) {
  return std::find_if(choices.begin(), choices.end(),
                      [&](const auto& choice) { return choice.first == name; })
      ->second;
}

drivers::DriverInfo describe_driver() {
  using enum drivers::OptionType;
  return {
      "xsens",
      "Xsens MTi-G and MTi-G-710 on a serial port or USB: MTData2 and legacy MTData",
      IMUNOISE_VERSION,
      {
          {.name = "port",
           .type = kText,
           .description = "Serial port, preferably by its name in /dev/serial/by-id",
           .required = true},
          {.name = "rate",
           .type = kInteger,
           .description = "Sampling rate",
           .unit = "Hz",
           .by_default = "100",
           .minimum = 2,
           .maximum = 2000},
          {.name = "output",
           .type = kText,
           .description = "Output to record (default: acc, gyro, mag and temperature)",
           .repeated = true,
           .choices = names_of(kOutputs)},
          {.name = "format",
           .type = kText,
           .description = "Number format of the device",
           .by_default = "float32",
           .choices = names_of(kFormats)},
          {.name = "baud",
           .type = kInteger,
           .description = "Baud rate to set (default: the rate that the device has)",
           .minimum = 4800,
           .maximum = 4000000},
          {.name = "protocol",
           .type = kText,
           .description = "Protocol of the data; auto is MTData2 if the device supports it",
           .by_default = "auto",
           .choices = names_of(kProtocols)},
      },
  };
}

std::unique_ptr<plugin::Device> open_device(const plugin::Options& options,
                                            const plugin::Host& host) {
  Settings settings;
  settings.port = options.text("port");
  settings.rate_hz = static_cast<std::uint16_t>(options.integer("rate"));
  settings.format = chosen(kFormats, options.text("format"));
  settings.protocol = chosen(kProtocols, options.text("protocol"));
  if (options.has("baud")) settings.baud = static_cast<std::uint32_t>(options.integer("baud"));
  if (options.has("output")) {
    settings.outputs = {false, false, false, false};
    for (const std::string& name : options.texts("output")) {
      settings.outputs.*chosen(kOutputs, name) = true;
    }
  }
  return std::make_unique<XsensDevice>(std::move(settings), host);
}

}  // namespace
}  // namespace imunoise::xsens

IMUNOISE_DRIVER(imunoise::xsens::describe_driver, imunoise::xsens::open_device)
