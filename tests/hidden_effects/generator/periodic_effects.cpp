// Lines: sines of one amplitude in all replicates, with a phase of their own in each.

#include <cmath>
#include <numbers>

#include "tests/hidden_effects/generator/apply.h"
#include "tests/hidden_effects/generator/draw.h"
#include "tests/hidden_effects/generator/oracle.h"

namespace imunoise::hidden {
namespace {

// Where a frequency appears after sampling, Hz.
double folded(double frequency, double rate_hz) {
  return std::abs(frequency - rate_hz * std::round(frequency / rate_hz));
}

// Nearer than this to the mains or its overtones a fan could not be told from them.
bool near_mains(double frequency, double rate_hz) {
  for (const double mains : {50.0, 60.0}) {
    for (int order = 1; order <= 6; ++order) {
      if (std::abs(folded(order * mains, rate_hz) - frequency) < 0.3) return true;
    }
  }
  return false;
}

double draw_frequency(Scene& scene, double low, double high) {
  double out = 0.0;
  do {
    out = uniform(scene.random, low, high);
  } while (near_mains(out, scene.rate_hz));
  return out;
}

// Amplitudes of 1, 2, … times the frequency (Hz, folded by the sampling), relative to the first.
Injection hide_lines(Scene& scene, double delta, double frequency,
                     const std::vector<double>& amplitudes) {
  std::vector<Series> shapes;
  std::vector<double> strengths;  // of each wave
  for (std::size_t r = 0; r < scene.replicates(); ++r) {
    Series shape(scene.samples(), 0.0);
    for (std::size_t order = 1; order <= amplitudes.size(); ++order) {
      const double phase = uniform(scene.random, 0.0, 2.0 * std::numbers::pi);
      const double omega =
          2.0 * std::numbers::pi * frequency * static_cast<double>(order) / scene.rate_hz;
      Series wave(scene.samples());
      for (std::size_t t = 0; t < wave.size(); ++t) {
        wave[t] = amplitudes[order - 1] * std::sin(omega * static_cast<double>(t) + phase);
        shape[t] += wave[t];
      }
      strengths.push_back(mean_strength({wave}, scene.spectrum));
    }
    shapes.push_back(std::move(shape));
  }
  const double amplitude = add_shapes(scene, shapes, delta);
  Injection out = of_mean(delta, {{"frequency_hz", folded(frequency, scene.rate_hz), "Hz"},
                                  {"amplitude", amplitude, "rad/s"}});
  for (const double one : strengths) out.untold += phase_price(amplitude * one);
  return out;
}

Injection hide_line(Scene& scene, double delta) {
  return hide_lines(scene, delta, draw_frequency(scene, 0.5, 0.49 * scene.rate_hz), {1.0});
}

// A few dozen periods in a recording: the AR1 is its double.
Injection hide_slow_line(Scene& scene, double delta) {
  return hide_lines(scene, delta, uniform(scene.random, 20.0, 60.0) / scene.seconds(), {1.0});
}

// A thermostat's cycle: a walk is its double.
Injection hide_slow_cycle(Scene& scene, double delta) {
  return hide_lines(scene, delta, uniform(scene.random, 3.3, 8.0) / scene.seconds(), {1.0});
}

Injection hide_harmonics(Scene& scene, double delta) {
  return hide_lines(scene, delta, draw_frequency(scene, 1.0, 0.16 * scene.rate_hz),
                    {1.0, 0.7, 0.5});
}

Injection hide_mains(Scene& scene, double delta) {
  const double mains = uniform(scene.random, 0.0, 1.0) < 0.5 ? 50.0 : 60.0;
  return hide_lines(scene, delta, mains + uniform(scene.random, -0.02, 0.02), {1.0});
}

}  // namespace

std::vector<HiddenEffect> periodic_effects() {
  const auto effect = [](const char* id, const char* variant, double rate_hz, auto hide) {
    HiddenEffect out;
    out.id = id;
    out.variant = variant;
    out.family = Family::kLine;
    out.rate_hz = rate_hz;
    out.hide = hide;
    return out;
  };
  return {
      effect("line", "", 100.0, hide_line),
      effect("line", "slow", 100.0, hide_slow_line),
      effect("line", "few_periods", 100.0, hide_slow_cycle),
      effect("harmonics", "", 100.0, hide_harmonics),
      effect("mains_alias", "", 80.0, hide_mains),  // 50 Hz shows at 30 Hz, 60 Hz at 20 Hz
  };
}

}  // namespace imunoise::hidden
