#include "drivers/codec/si_unit.h"

#include <cmath>

#include "core/support/units.h"

namespace imunoise::drivers {

SiUnit si_unit(std::string_view unit) {
  const Result<Unit> known = parse_unit(unit);
  if (!known || known->quantity == Quantity::kUnknown) return {std::string(unit)};
  return {std::string(si_symbol(known->quantity)), known->to_si, known->si_offset};
}

void append_value(DecodedSample& sample, std::string_view channel, const SiUnit& unit,
                  double number, Refusals& refused) {
  const double value = number * unit.scale + unit.offset;
  if (std::isfinite(value)) {
    sample.values.push_back({channel, unit.symbol, value});
  } else {
    refused.add(Refusal::kNotFinite);
  }
}

}  // namespace imunoise::drivers
