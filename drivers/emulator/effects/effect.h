#pragma once

// What disturbs a sensor besides its noise.

#include "drivers/emulator/measurement/sample_source.h"

namespace imunoise::emulator {

/// When a sample is taken, s.
struct Moment {
  double since_power = 0.0;  ///< Begins anew where power fails.
  double elapsed = 0.0;      ///< Since the beginning: the surroundings do not know of power.
  double step = 0.0;         ///< Since the sample before; 0 for the first.
};

/// Called once a sample, in order. Bounded memory, however many samples.
class Effect {
 public:
  Effect() = default;
  Effect(const Effect&) = delete;
  Effect& operator=(const Effect&) = delete;
  virtual ~Effect() = default;

  virtual void apply(const Moment& moment, Measurement& measurement) = 0;
};

}  // namespace imunoise::emulator
