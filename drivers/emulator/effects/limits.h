#pragma once

// What an output does to a quantity, last of all: it saturates, or is stuck.

#include "drivers/emulator/effects/effect.h"
#include "drivers/emulator/measurement/quantity.h"

namespace imunoise::emulator {

/// Nothing beyond ± limit.
class Saturation final : public Effect {
 public:
  Saturation(QuantityIndex quantity, double limit) : quantity_(quantity), limit_(limit) {}
  void apply(const Moment& moment, Measurement& measurement) override;

 private:
  QuantityIndex quantity_;
  double limit_;
};

/// From `from` on, for `duration`, the value of the sample before it again and again.
class Stuck final : public Effect {
 public:
  Stuck(QuantityIndex quantity, double from, double duration)
      : quantity_(quantity), from_(from), duration_(duration) {}
  void apply(const Moment& moment, Measurement& measurement) override;

 private:
  QuantityIndex quantity_;
  double from_;      // s
  double duration_;  // s
  double held_ = 0.0;
};

}  // namespace imunoise::emulator
