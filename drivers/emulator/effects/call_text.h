#pragma once

// "fan(frequency=23, amplitude=1e-3, channel=gyro_x)": how effects and faults are written.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/support/result.h"

namespace imunoise::emulator {

/// A name and what stands in its brackets, unjudged.
struct CallText {
  std::string name;
  std::vector<std::pair<std::string, std::string>> arguments;
};

/// NAME, or NAME(KEY=VALUE, ...); blanks do not matter. Error: what is wrong, with the text.
Result<CallText> parse_call(std::string_view text);

/// A number that a call may carry.
struct NumberParameter {
  std::string_view name;
  std::string_view unit;                  ///< "s", "Hz", ...; "" where it is that of the quantity.
  std::optional<double> by_default = {};  ///< Unset: it must be given.
  double minimum = 0.0;                   ///< Included.
  double maximum = 1e18;                  ///< Included.
};

/// The numbers of a call in the order of the parameters. Error: a name that is not among them or
/// stands twice, one that is missing, what is no number or out of bounds.
Result<std::vector<double>> numbers_of(const CallText& call,
                                       std::span<const NumberParameter> parameters);

/// "fan(frequency, amplitude, harmonics=3)": how a person is told of it.
std::string usage(std::string_view name, std::span<const NumberParameter> parameters);

}  // namespace imunoise::emulator
