// Effects that no entry of the catalogue describes. The right answer is that something is missing.

#include <cmath>
#include <numbers>

#include "tests/hidden_effects/generator/apply.h"
#include "tests/hidden_effects/generator/draw.h"

namespace imunoise::hidden {
namespace {

// A fan runs up through a quarter of the band and down again, anew in each replicate.
Injection hide_chirp(Scene& scene, double delta) {
  const double centre = uniform(scene.random, 0.15, 0.35);  // cycles per sample
  std::vector<Series> shapes;
  for (std::size_t r = 0; r < scene.replicates(); ++r) {
    double phase = uniform(scene.random, 0.0, 2.0 * std::numbers::pi);
    Series shape(scene.samples());
    for (std::size_t t = 0; t < shape.size(); ++t) {
      const double course = static_cast<double>(t) / static_cast<double>(shape.size());
      const double frequency = centre + 0.12 * std::sin(2.0 * std::numbers::pi * course);
      phase += 2.0 * std::numbers::pi * frequency;
      shape[t] = std::sin(phase);
    }
    shapes.push_back(std::move(shape));
  }
  add_shapes(scene, shapes, delta);
  return of_mean(delta, {});
}

// Three levels, visited at random.
Injection hide_three_levels(Scene& scene, double delta) {
  const double dwell = static_cast<double>(scene.samples()) / uniform(scene.random, 10.0, 20.0);
  std::vector<Series> shapes;
  for (std::size_t r = 0; r < scene.replicates(); ++r) {
    Series shape(scene.samples());
    double level = 0.0;
    for (double& x : shape) {
      if (uniform(scene.random, 0.0, 1.0) < 1.0 / dwell) {
        level = static_cast<double>(below(scene.random, 3)) - 1.0;
      }
      x = level;
    }
    shapes.push_back(std::move(shape));
  }
  add_shapes(scene, shapes, delta);
  return of_mean(delta, {});
}

// Coloured noise that fades in over each replicate; δ of an observer who knows its course.
Injection hide_growing_noise(Scene& scene, double delta) {
  std::vector<Series> shapes;
  for (std::size_t r = 0; r < scene.replicates(); ++r) {
    Series shape = simulate(Markov{1.0, 100.0}, scene.random, scene.samples());
    for (std::size_t t = 0; t < shape.size(); ++t) {
      shape[t] *= std::pow(static_cast<double>(t) / static_cast<double>(shape.size()), 2.0);
    }
    shapes.push_back(std::move(shape));
  }
  add_shapes(scene, shapes, delta);
  return of_mean(delta, {});
}

// x_t + a·x_{t-d}: the spectrum gets the teeth of a comb.
Injection hide_echo(Scene& scene, double delta) {
  const std::size_t delay = 20 + below(scene.random, 40);  // samples
  const auto after = [&](double gain) {
    Series out = scene.spectrum;
    for (std::size_t k = 0; k < out.size(); ++k) {
      const double omega =
          std::numbers::pi * static_cast<double>(k + 1) / static_cast<double>(scene.samples());
      out[k] *= 1.0 + gain * gain + 2.0 * gain * std::cos(omega * static_cast<double>(delay));
    }
    return out;
  };
  const double gain = solve_size(scene, delta, 1e-6, 0.9, after);
  for (Recording& recording : scene.recordings) {
    Series& gyro = recording[kSubject];
    for (std::size_t t = gyro.size(); t-- > delay;) gyro[t] += gain * gyro[t - delay];
    for (std::size_t t = 0; t < delay; ++t) gyro[t] *= 1.0 + gain;  // the bias has no echo's edge
  }
  return of_spectrum(scene, after(gain));
}

// Bumps that decay, as after a knock, at random moments.
Injection hide_knocks(Scene& scene, double delta) {
  const double decay = log_uniform(scene.random, 20.0, 100.0);  // samples
  std::vector<Series> shapes;
  for (std::size_t r = 0; r < scene.replicates(); ++r) {
    Series shape(scene.samples());
    double state = 0.0;
    for (double& x : shape) {
      if (uniform(scene.random, 0.0, 1.0) < 8.0 / static_cast<double>(scene.samples())) {
        state += scene.random.normal();
      }
      x = state;
      state *= 1.0 - 1.0 / decay;
    }
    shapes.push_back(std::move(shape));
  }
  add_shapes(scene, shapes, delta);
  return of_mean(delta, {});
}

}  // namespace

std::vector<HiddenEffect> outside_effects() {
  const auto effect = [](const char* id, auto hide) {
    HiddenEffect out;
    out.id = id;
    out.kind = Kind::kOutside;
    out.hide = hide;
    return out;
  };
  return {
      effect("chirp", hide_chirp),
      effect("three_levels", hide_three_levels),
      effect("growing_noise", hide_growing_noise),
      effect("echo", hide_echo),
      effect("knocks", hide_knocks),
  };
}

}  // namespace imunoise::hidden
