#include "drivers/emulator/sample_source.h"

#include <cstddef>

namespace imunoise::emulator {

std::optional<double> value_of(const ImuSample& sample, std::string_view channel) {
  if (channel == "temperature") return sample.temperature;
  const std::size_t dash = channel.rfind('_');
  if (dash == std::string_view::npos || channel.size() != dash + 2) return std::nullopt;
  const std::size_t axis = std::string_view("xyz").find(channel.back());
  if (axis == std::string_view::npos) return std::nullopt;
  const std::string_view quantity = channel.substr(0, dash);
  if (quantity == "gyro") return sample.angular_rate[axis];
  if (quantity == "acc") return sample.acceleration[axis];
  if (quantity == "mag") return sample.magnetic_field[axis];
  return std::nullopt;
}

}  // namespace imunoise::emulator
