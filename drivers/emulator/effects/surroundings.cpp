#include "drivers/emulator/effects/surroundings.h"

#include <cmath>
#include <numbers>

namespace imunoise::emulator {

void Movement::apply(const Moment& moment, Measurement& measurement) {
  const double turns = moment.elapsed / shape_.period;
  at(measurement, witness_) +=
      shape_.swing * std::sin(2.0 * std::numbers::pi * turns) + shape_.drift * moment.elapsed;
}

void Coupling::apply(const Moment& moment, Measurement& measurement) {
  const double deviation = at(measurement, witness_) - at_rest_;
  const bool at_once = !began_ || strength_.lag == 0.0;
  felt_ += (deviation - felt_) * (at_once ? 1.0 : -std::expm1(-moment.step / strength_.lag));
  began_ = true;
  at(measurement, quantity_) += felt_ * (strength_.coefficient + strength_.quadratic * felt_);
}

}  // namespace imunoise::emulator
