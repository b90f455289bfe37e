#pragma once

#include <cmath>

#include "drivers/emulator/measurement/sample_source.h"

namespace imunoise::testing {

/// A different value in every channel and sample.
class LivelySource final : public emulator::SampleSource {
 public:
  emulator::Measurement measure(double time) override {
    emulator::Measurement out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double phase = 7.0 * time + static_cast<double>(axis);
      out.rate[axis] = 0.3 * std::sin(phase);
      out.specific_force[axis] = 9.8 * std::cos(phase / 3.0);
      out.field[axis] = std::sin(phase / 5.0) / 3.0;
    }
    out.temperature = 300.0 + std::sin(time);
    return out;
  }
};

}  // namespace imunoise::testing
