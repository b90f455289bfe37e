#pragma once

// What adds to one quantity: hums, steps, telegraph noise, outliers, warming up.

#include <utility>

#include "core/support/random.h"
#include "drivers/emulator/effects/effect.h"
#include "drivers/emulator/measurement/quantity.h"

namespace imunoise::emulator {

/// A rotor or the mains: Σ_k amplitude / k · sin(2πk·frequency·t + k·phase), k = 1 .. harmonics.
/// Sampling folds what lies above half the rate, as it does in life.
class Hum final : public Effect {
 public:
  struct Shape {
    double frequency = 1.0;  ///< Hz
    double amplitude = 0.0;
    int harmonics = 1;
    double phase = 0.0;  ///< rad
  };
  Hum(QuantityIndex quantity, const Shape& shape) : quantity_(quantity), shape_(shape) {}
  void apply(const Moment& moment, Measurement& measurement) override;

 private:
  QuantityIndex quantity_;
  Shape shape_;
};

/// Stress that is released: from a moment on another bias.
class Step final : public Effect {
 public:
  Step(QuantityIndex quantity, double time, double height)
      : quantity_(quantity), time_(time), height_(height) {}
  void apply(const Moment& moment, Measurement& measurement) override;

 private:
  QuantityIndex quantity_;
  double time_;  // s
  double height_;
};

/// A charge trap: two levels, `height` apart, each held for exponential times of mean `dwell`.
/// Variance height²/4, autocorrelation exp(-2|t| / dwell).
class Telegraph final : public Effect {
 public:
  Telegraph(QuantityIndex quantity, double height, double dwell, RandomStream random);
  void apply(const Moment& moment, Measurement& measurement) override;

 private:
  QuantityIndex quantity_;
  double dwell_;  // s
  RandomStream random_;
  double level_;
};

/// Interference: a share of the samples carries another N(0, deviation²).
class Outliers final : public Effect {
 public:
  Outliers(QuantityIndex quantity, double share, double deviation, RandomStream random)
      : quantity_(quantity), share_(share), deviation_(deviation), random_(std::move(random)) {}
  void apply(const Moment& moment, Measurement& measurement) override;

 private:
  QuantityIndex quantity_;
  double share_;
  double deviation_;
  RandomStream random_;
};

/// Self-heating: size · exp(-t / time) since power came on, every time.
class WarmUp final : public Effect {
 public:
  WarmUp(QuantityIndex quantity, double size, double time)
      : quantity_(quantity), size_(size), time_(time) {}
  void apply(const Moment& moment, Measurement& measurement) override;

 private:
  QuantityIndex quantity_;
  double size_;
  double time_;  // s
};

}  // namespace imunoise::emulator
