#pragma once

#include <cmath>
#include <numbers>

#include "core/support/random.h"

namespace imunoise {

/// A number from 0 to 1, all alike likely, from a normal one: the same on every platform.
inline double uniform_number(RandomStream& random) {
  return 0.5 * std::erfc(random.normal() / std::numbers::sqrt2);
}

}  // namespace imunoise
