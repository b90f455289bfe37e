#include "drivers/emulator/measurement/quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace imunoise::emulator {

double& at(Measurement& measurement, QuantityIndex quantity) {
  assert(quantity < kQuantities.size());
  if (quantity < 3) return measurement.rate[quantity];
  if (quantity < 6) return measurement.specific_force[quantity - 3];
  if (quantity < 9) return measurement.field[quantity - 6];
  if (quantity == kTemperature) return measurement.temperature;
  return quantity == kSupply ? measurement.supply : measurement.auxiliary;
}

double at(const Measurement& measurement, QuantityIndex quantity) {
  Measurement copy = measurement;
  return at(copy, quantity);
}

std::optional<QuantityIndex> find_quantity(std::string_view name) {
  const auto* const found = std::find(kQuantities.begin(), kQuantities.end(), name);
  if (found == kQuantities.end()) return std::nullopt;
  return static_cast<QuantityIndex>(found - kQuantities.begin());
}

Result<std::vector<QuantityIndex>> quantities_of(std::string_view name) {
  std::vector<QuantityIndex> out;
  for (QuantityIndex i = 0; i < kQuantities.size(); ++i) {
    const std::string_view one = kQuantities[i];
    const bool axis =
        one.size() == name.size() + 2 && one.starts_with(name) && one[name.size()] == '_';
    if (one == name || axis) out.push_back(i);
  }
  if (!out.empty()) return out;
  return fail(
      fmt::format("no quantity '{}'; there are gyro, acc, mag (or one axis: gyro_x), "
                  "temperature, supply, auxiliary",
                  name));
}

}  // namespace imunoise::emulator
