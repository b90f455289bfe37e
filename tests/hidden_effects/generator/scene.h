#pragma once

// What effects act upon: replicates of base noise and the surroundings that they were recorded in.

#include <string>
#include <vector>

#include "core/support/random.h"
#include "tests/hidden_effects/generator/base_noise.h"
#include "tests/hidden_effects/generator/recording.h"

namespace imunoise::hidden {

/// What went on around the sensor in one replicate, as it was; witnesses measure it with some
/// noise.
struct Surroundings {
  Series temperature;   ///< K
  Series supply;        ///< V
  Series field;         ///< T
  Series acceleration;  ///< m/s²
};

/// How much goes on.
enum class Weather {
  kCalm,    ///< Temperature and supply stay put to within their sensors' noise.
  kLively,  ///< Swings of several kelvins, a wandering supply, things of iron that pass.
  kSlow,    ///< All of these wander slowly and far: each moves a few times in a recording.
};

/// Replicates under one law.
struct Scene {
  double rate_hz = 100.0;
  BaseNoise base;
  BaseNoise neighbour;  ///< The law of gyro_y.
  Series spectrum;      ///< Of gyro_x without effects, as BaseNoise::spectrum; unit².
  std::vector<Recording> recordings;
  std::vector<Surroundings> surroundings;  ///< One a replicate.
  RandomStream random{0};

  std::size_t replicates() const { return recordings.size(); }
  std::size_t samples() const { return spectrum.size() + 1; }
  double seconds() const { return static_cast<double>(samples()) / rate_hz; }

  /// Standard deviation of what is new in each sample: the level at the highest frequency.
  double floor() const;
};

/// Replicates with gyro_x, temperature, supply, mag_x, acc_x and gyro_y (rad/s, K, V, T, m/s²), all
/// independent of each other. Each gyro has its own constant bias in each replicate.
Scene draw_scene(Base base, Weather weather, std::size_t replicates, std::size_t samples,
                 double rate_hz, RandomStream random);

/// What happens around one replicate.
Surroundings draw_surroundings(Weather weather, std::size_t samples, double rate_hz,
                               RandomStream& random);

/// Adds the channels that witness `surroundings` to a recording.
void add_witnesses(const Surroundings& surroundings, RandomStream& random, Recording& to);

}  // namespace imunoise::hidden
