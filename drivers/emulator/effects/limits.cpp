#include "drivers/emulator/effects/limits.h"

#include <algorithm>

namespace imunoise::emulator {

void Saturation::apply(const Moment& /*moment*/, Measurement& measurement) {
  double& value = at(measurement, quantity_);
  value = std::clamp(value, -limit_, limit_);
}

void Stuck::apply(const Moment& moment, Measurement& measurement) {
  double& value = at(measurement, quantity_);
  const double since = moment.elapsed - from_;
  if (since >= 0.0 && since < duration_) {
    value = held_;
  } else {
    held_ = value;
  }
}

}  // namespace imunoise::emulator
