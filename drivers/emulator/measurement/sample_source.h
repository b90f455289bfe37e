#pragma once

// What an emulated sensor measures.

#include <array>

namespace imunoise::emulator {

using Vector = std::array<double, 3>;  // x, y, z

/// What a sensor would say if it had no quantisation: true motion, noise and effects together. SI.
struct Measurement {
  Vector rate{};             ///< Angular rate, rad/s.
  Vector specific_force{};   ///< m/s².
  Vector field{};            ///< Magnetic flux density, T.
  double temperature = 0.0;  ///< K.
  double supply = 0.0;       ///< V.
  double auxiliary = 0.0;    ///< V.
};

/// Any noise model, any effect: whatever stands here is quantised and sent by an emulated device.
class SampleSource {
 public:
  SampleSource() = default;
  SampleSource(const SampleSource&) = delete;
  SampleSource& operator=(const SampleSource&) = delete;
  virtual ~SampleSource() = default;

  /// The measurement at `time`, s since the device was switched on. Called once a sample; time
  /// begins anew where power failed, else it grows.
  virtual Measurement measure(double time) = 0;
};

}  // namespace imunoise::emulator
