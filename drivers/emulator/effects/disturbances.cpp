#include "drivers/emulator/effects/disturbances.h"

#include <cmath>
#include <numbers>
#include <random>
#include <utility>

namespace imunoise::emulator {

void Hum::apply(const Moment& moment, Measurement& measurement) {
  const double phase = 2.0 * std::numbers::pi * shape_.frequency * moment.elapsed + shape_.phase;
  for (int k = 1; k <= shape_.harmonics; ++k) {
    at(measurement, quantity_) += shape_.amplitude / k * std::sin(k * phase);
  }
}

void Step::apply(const Moment& moment, Measurement& measurement) {
  if (moment.elapsed >= time_) at(measurement, quantity_) += height_;
}

Telegraph::Telegraph(QuantityIndex quantity, double height, double dwell, RandomStream random)
    : quantity_(quantity), dwell_(dwell), random_(std::move(random)), level_(height / 2.0) {
  if (std::bernoulli_distribution(0.5)(random_.engine())) level_ = -level_;
}

void Telegraph::apply(const Moment& moment, Measurement& measurement) {
  // Of an odd number of jumps since the last sample.
  const double turned = -0.5 * std::expm1(-2.0 * moment.step / dwell_);
  if (std::bernoulli_distribution(turned)(random_.engine())) level_ = -level_;
  at(measurement, quantity_) += level_;
}

void Outliers::apply(const Moment& /*moment*/, Measurement& measurement) {
  if (!std::bernoulli_distribution(share_)(random_.engine())) return;
  at(measurement, quantity_) += deviation_ * random_.normal();
}

void WarmUp::apply(const Moment& moment, Measurement& measurement) {
  at(measurement, quantity_) += size_ * std::exp(-moment.since_power / time_);
}

}  // namespace imunoise::emulator
