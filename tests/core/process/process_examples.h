#pragma once

#include <vector>

#include "core/process/process.h"

namespace imunoise {

/// Every noise process, with several parameter values each: what the laws are tried on.
inline std::vector<Process> process_examples() {
  return {WhiteNoise{2.0},
          QuantisationNoise{0.3},
          RandomWalk{0.01},
          RateRamp{1e-4},
          Ar1{1.0, 0.2},
          Ar1{1.0, 0.9},
          Ar1{0.5, 0.999},
          Ar1{1.0, -0.7},
          Ar1{1.0, -0.99},
          Ar2{1.0, 0.9, 0.5},
          Ar2{1.0, 0.995, -0.9},
          Ar2{1.0, 0.9, -0.39286},
          Ar2{0.5, 0.4, -0.9},
          Ar2{1.0, -0.6, 0.2},
          GaussMarkov{2.0, 0.5, Hertz{100}},
          GaussMarkov{2.0, 0.01, Hertz{100}},
          Resonance{1.0, 0.9, 1.2},
          Resonance{1.0, 0.99, 0.05},
          Resonance{1.0, 0.5, 3.0},
          MovingAverage{1.0, {0.5}},
          MovingAverage{2.0, {0.7, -0.2, 0.1}},
          MovingAverageFilter{1.0, 5},
          BartlettFilter{1.0, 4},
          AnalogFilter{1.0, 0.6, 2},
          AnalogFilter{2.0, 0.05, 3},
          AnalogFilter{1.0, 2.9, 5},
          AnalogFilter{0.5, 1.2, 8},
          DigitalFilter{1.0, 1.0, 1},
          DigitalFilter{2.0, 0.2, 2},
          DigitalFilter{1.0, 2.5, 3},
          DigitalFilter{0.5, 0.9, 4},
          DigitalFilter{1.0, 1.6, 7},
          Flicker{0.8},
          PowerLaw{0.7, 0.5},
          PowerLaw{0.2, 1.4},
          Voigt{1.0, 0.97, 1.2, 0.05},
          Voigt{0.5, 0.9, 3.0, 0.1},
          Voigt{2.0, 0.95, 0.2, 0.08}};
}

}  // namespace imunoise
