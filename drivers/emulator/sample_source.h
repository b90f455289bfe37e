#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string_view>

namespace imunoise::emulator {

/// What an inertial sensor feels at one moment, in its own axes.
struct ImuSample {
  std::array<double, 3> angular_rate{};    ///< rad/s
  std::array<double, 3> acceleration{};    ///< m/s²
  std::array<double, 3> magnetic_field{};  ///< In the device's unit.
  double temperature = 293.15;             ///< K
};

/// The sample at a time in s since the device's power came on. Called from the emulator's thread.
using SampleSource = std::function<ImuSample(double seconds)>;

/// What a channel of drivers is called: "gyro_x", "acc_y", "mag_z", "temperature". Nothing for
/// other names.
std::optional<double> value_of(const ImuSample& sample, std::string_view channel);

}  // namespace imunoise::emulator
