#include "tests/hidden_effects/generator/scene.h"

#include <cmath>
#include <numbers>

#include "tests/hidden_effects/generator/draw.h"

namespace imunoise::hidden {
namespace {

// White noise of the witnesses' own sensors.
constexpr double kThermometerNoise = 0.01;    // K
constexpr double kVoltmeterNoise = 1e-3;      // V
constexpr double kMagnetometerNoise = 5e-8;   // T
constexpr double kAccelerometerNoise = 1e-3;  // m/s²

constexpr double kGyroBias = 1e-2;  // rad/s, standard deviation over replicates

Series measured(const Series& truth, double noise, RandomStream& random) {
  Series out = truth;
  for (double& x : out) x += noise * random.normal();
  return out;
}

// A part of a long swing, a slow wander and the draught of the room.
Series draw_temperature(Weather weather, std::size_t samples, double rate_hz,
                        RandomStream& random) {
  const bool lively = weather != Weather::kCalm;
  const double n = static_cast<double>(samples);
  Series out(samples, 298.15);
  const double swing = lively ? uniform(random, 1.5, 5.0) : 0.0;
  const double period = n * uniform(random, 0.7, 2.0);
  const double phase = uniform(random, 0.0, 2.0 * std::numbers::pi);
  for (std::size_t t = 0; t < samples; ++t) {
    out[t] += swing * std::sin(2.0 * std::numbers::pi * static_cast<double>(t) / period + phase);
  }
  add(out, simulate(Markov{lively ? 0.3 : 0.01, 20.0 * rate_hz}, random, samples));
  BaseNoise wander;
  wander.walk = (lively ? 0.5 : 0.01) / std::sqrt(n);
  add(out, wander.simulate(random, samples));
  return out;
}

Series gyro(const BaseNoise& law, std::size_t samples, RandomStream& random) {
  const double bias = kGyroBias * random.normal();
  Series out = law.simulate(random, samples);
  for (double& x : out) x += bias;
  return out;
}

}  // namespace

double Scene::floor() const { return std::sqrt(spectrum.back()); }

Surroundings draw_surroundings(Weather weather, std::size_t samples, double rate_hz,
                               RandomStream& random) {
  const double much = weather == Weather::kCalm ? 0.05 : 1.0;
  Surroundings out;
  out.temperature = draw_temperature(weather, samples, rate_hz, random);
  out.supply = Series(samples, 5.0);
  add(out.supply, simulate(Markov{0.02 * much, 0.5 * rate_hz}, random, samples));
  add(out.supply, simulate(Markov{0.03 * much, 60.0 * rate_hz}, random, samples));
  out.field = Series(samples, 2e-5);
  add(out.field, simulate(Markov{1e-6 * much, 10.0 * rate_hz}, random, samples));
  out.acceleration = Series(samples, 0.02);
  add(out.acceleration, simulate(Markov{0.01, 0.05 * rate_hz}, random, samples));
  if (weather == Weather::kSlow) {
    const double tau = uniform(random, 0.1, 0.5) * static_cast<double>(samples);
    add(out.supply, simulate(Markov{0.1, tau}, random, samples));
    add(out.field, simulate(Markov{5e-6, 0.7 * tau}, random, samples));
    add(out.acceleration, simulate(Markov{0.05, 1.4 * tau}, random, samples));
  }
  return out;
}

void add_witnesses(const Surroundings& surroundings, RandomStream& random, Recording& to) {
  to.traces.push_back(
      {"temperature", "K", measured(surroundings.temperature, kThermometerNoise, random)});
  to.traces.push_back({"supply", "V", measured(surroundings.supply, kVoltmeterNoise, random)});
  to.traces.push_back({"mag_x", "T", measured(surroundings.field, kMagnetometerNoise, random)});
  to.traces.push_back(
      {"acc_x", "m/s^2", measured(surroundings.acceleration, kAccelerometerNoise, random)});
}

Scene draw_scene(Base base, Weather weather, std::size_t replicates, std::size_t samples,
                 double rate_hz, RandomStream random) {
  Scene out;
  out.rate_hz = rate_hz;
  out.base = draw_base(base, samples, random);
  out.neighbour = draw_base(Base::kWhiteWalk, samples, random);
  out.spectrum = out.base.spectrum(samples);
  for (std::size_t r = 0; r < replicates; ++r) {
    Recording recording;
    recording.traces.push_back({std::string(kSubject), "rad/s", gyro(out.base, samples, random)});
    out.surroundings.push_back(draw_surroundings(weather, samples, rate_hz, random));
    add_witnesses(out.surroundings.back(), random, recording);
    recording.traces.push_back({"gyro_y", "rad/s", gyro(out.neighbour, samples, random)});
    out.recordings.push_back(std::move(recording));
  }
  out.random = random;
  return out;
}

}  // namespace imunoise::hidden
