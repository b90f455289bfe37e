#pragma once

#include <string>
#include <string_view>

#include "drivers/codec/refusal.h"
#include "drivers/codec/sample.h"

namespace imunoise::drivers {

/// How a device's numbers become a sample's: value = number · scale + offset, in `symbol`.
struct SiUnit {
  std::string symbol;
  double scale = 1.0;
  double offset = 0.0;
};

/// The SI unit of a quantity that core/support/units knows; any other unit stays as it is.
SiUnit si_unit(std::string_view unit);

/// Appends one value of `sample`, or refuses it if it is not finite. `channel` and `unit` must
/// outlive the sample.
void append_value(DecodedSample& sample, std::string_view channel, const SiUnit& unit,
                  double number, Refusals& refused);

}  // namespace imunoise::drivers
