#include "drivers/emulator/channel_value.h"

#include <cstddef>

#include "drivers/codec/si_unit.h"

namespace imunoise::emulator {

std::optional<double> value_of(const Measurement& measurement, std::string_view channel) {
  if (channel == "temperature") return measurement.temperature;
  const std::size_t dash = channel.rfind('_');
  if (dash == std::string_view::npos || channel.size() != dash + 2) return std::nullopt;
  const std::size_t axis = std::string_view("xyz").find(channel.back());
  if (axis == std::string_view::npos) return std::nullopt;
  const std::string_view quantity = channel.substr(0, dash);
  if (quantity == "gyro") return measurement.rate[axis];
  if (quantity == "acc") return measurement.specific_force[axis];
  if (quantity == "mag") return measurement.field[axis];
  return std::nullopt;
}

double value_in_unit(const Measurement& measurement, std::string_view channel,
                     std::string_view unit) {
  const auto value = value_of(measurement, channel);
  if (!value) return 0.0;
  const drivers::SiUnit si = drivers::si_unit(unit);
  return (*value - si.offset) / si.scale;
}

}  // namespace imunoise::emulator
