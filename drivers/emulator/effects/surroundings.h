#pragma once

// Temperature and supply: how they move, and what a sensor makes of it.

#include "drivers/emulator/effects/effect.h"
#include "drivers/emulator/measurement/quantity.h"

namespace imunoise::emulator {

/// A witness moves: swing · sin(2πt / period) + drift · t.
class Movement final : public Effect {
 public:
  struct Shape {
    double swing = 0.0;   ///< K or V.
    double period = 1.0;  ///< s
    double drift = 0.0;   ///< K/s or V/s.
  };
  Movement(QuantityIndex witness, const Shape& shape) : witness_(witness), shape_(shape) {}
  void apply(const Moment& moment, Measurement& measurement) override;

 private:
  QuantityIndex witness_;
  Shape shape_;
};

/// A quantity follows a witness: coefficient · d + quadratic · d², d the witness less its value at
/// rest, through a first-order lag that begins in equilibrium.
class Coupling final : public Effect {
 public:
  struct Strength {
    double coefficient = 0.0;  ///< Units per K or V.
    double quadratic = 0.0;    ///< Units per K² or V².
    double lag = 0.0;          ///< Time constant, s; 0: at once.
  };
  Coupling(QuantityIndex quantity, QuantityIndex witness, double at_rest, const Strength& strength)
      : quantity_(quantity), witness_(witness), at_rest_(at_rest), strength_(strength) {}
  void apply(const Moment& moment, Measurement& measurement) override;

 private:
  QuantityIndex quantity_;
  QuantityIndex witness_;
  double at_rest_;
  Strength strength_;
  double felt_ = 0.0;
  bool began_ = false;
};

}  // namespace imunoise::emulator
