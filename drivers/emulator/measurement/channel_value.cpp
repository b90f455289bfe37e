#include "drivers/emulator/measurement/channel_value.h"

#include "drivers/codec/si_unit.h"
#include "drivers/emulator/measurement/quantity.h"

namespace imunoise::emulator {

std::optional<double> value_of(const Measurement& measurement, std::string_view channel) {
  const auto quantity = find_quantity(channel);
  if (!quantity) return std::nullopt;
  return at(measurement, *quantity);
}

double value_in_unit(const Measurement& measurement, std::string_view channel,
                     std::string_view unit) {
  const auto value = value_of(measurement, channel);
  if (!value) return 0.0;
  const drivers::SiUnit si = drivers::si_unit(unit);
  return (*value - si.offset) / si.scale;
}

}  // namespace imunoise::emulator
