// Foreign families of the spectrum.

#include <cmath>
#include <numbers>

#include "tests/hidden_effects/generator/apply.h"
#include "tests/hidden_effects/generator/draw.h"

namespace imunoise::hidden {
namespace {

// Two-sided spectrum of f^slope.
Injection hide_power_law(Scene& scene, double delta, double slope) {
  double level = 0.0;
  return add_noise(
      scene, delta,
      [&](double size) {
        BaseNoise noise;
        noise.markov = octaves_of_power_law(slope, size, scene.samples());
        return noise;
      },
      level);
}

// A mount rings, and the sensor's own low-pass filter, which makes the white noise of the base a
// Markov noise, passes what it lets through.
Injection hide_filtered_resonance(Scene& scene, double delta) {
  const double pole = std::exp(-1.0 / scene.base.markov.front().tau);
  const Ringing ringing{1.0, uniform(scene.random, 0.90, 0.98), uniform(scene.random, 0.3, 1.5)};
  Series filtered = spectrum(ringing, scene.samples());
  for (std::size_t k = 0; k < filtered.size(); ++k) {
    const double omega =
        std::numbers::pi * static_cast<double>(k + 1) / static_cast<double>(scene.samples());
    filtered[k] *= (1.0 - pole) * (1.0 - pole) / (1.0 - 2.0 * pole * std::cos(omega) + pole * pole);
  }
  const auto after = [&](double size) {
    Series out = scene.spectrum;
    for (std::size_t k = 0; k < out.size(); ++k) out[k] += size * size * filtered[k];
    return out;
  };
  const double size = solve_size(scene, delta, 1e-6 * scene.floor(), 1e4 * scene.floor(), after);
  for (Recording& recording : scene.recordings) {
    const Series rung = simulate(ringing, scene.random, scene.samples());
    Series& gyro = recording[kSubject];
    double state = 0.0;
    for (std::size_t t = 0; t < gyro.size(); ++t) {
      state += (1.0 - pole) * (rung[t] - state);
      gyro[t] += size * state;
    }
  }
  Injection out = of_spectrum(scene, after(size));
  out.parameters = {
      {"frequency_hz", ringing.omega * scene.rate_hz / (2.0 * std::numbers::pi), "Hz"}};
  return out;
}

// The gyro has slow noise, and so have its neighbours, each its own: any two slow noises look
// alike for as long as a recording lasts.
Injection hide_noise_beside_slow_neighbours(Scene& scene, double delta) {
  const double n = static_cast<double>(scene.samples());
  const double tau = n * log_uniform(scene.random, 0.01, 0.03);
  double deviation = 0.0;
  Injection out = add_noise(
      scene, delta,
      [&](double size) {
        BaseNoise noise;
        noise.markov = {{size, tau}};
        return noise;
      },
      deviation);
  for (Recording& recording : scene.recordings) {
    for (const char* neighbour : {"gyro_y", "acc_x", "supply"}) {
      Series& channel = recording[neighbour];
      const double spread = std::abs(channel[1] - channel[0]) + std::abs(channel[3] - channel[2]);
      const double own = n * log_uniform(scene.random, 0.02, 0.1);
      add(channel, simulate(Markov{2.0 * spread, own}, scene.random, scene.samples()));
    }
  }
  out.parameters = {{"tau_s", tau / scene.rate_hz, "s"}};
  return out;
}

}  // namespace

std::vector<HiddenEffect> foreign_spectra() {
  HiddenEffect filtered = foreign("resonance", "filtered", hide_filtered_resonance);
  filtered.base = Base::kMarkovWalk;
  return {
      foreign("power_law", "shallow",
              [](Scene& scene, double delta) { return hide_power_law(scene, delta, -0.5); }),
      foreign("power_law", "steep",
              [](Scene& scene, double delta) { return hide_power_law(scene, delta, -1.5); }),
      filtered,
      foreign("gauss_markov", "slow_neighbours", hide_noise_beside_slow_neighbours),
  };
}

}  // namespace imunoise::hidden
