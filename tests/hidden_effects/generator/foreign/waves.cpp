// Foreign families of vibrations: not steady in time, amplitude or frequency. δ is that of an
// observer who knows their course.

#include <cmath>
#include <functional>
#include <numbers>

#include "tests/hidden_effects/generator/apply.h"
#include "tests/hidden_effects/generator/draw.h"

namespace imunoise::hidden {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

// Cycles per sample, away from what the mains fold to at 100 Hz.
double draw_frequency_below_mains(Scene& scene) { return uniform(scene.random, 0.05, 0.18); }

// A wave of one frequency and random phase, its amplitude as the course of each replicate says.
Injection hide_wave(Scene& scene, double delta, const std::function<Series()>& amplitude) {
  const double omega = kTurn * draw_frequency_below_mains(scene);
  std::vector<Series> shapes;
  for (std::size_t r = 0; r < scene.replicates(); ++r) {
    const double phase = uniform(scene.random, 0.0, kTurn);
    Series shape = amplitude();
    for (std::size_t t = 0; t < shape.size(); ++t) {
      shape[t] *= std::sin(omega * static_cast<double>(t) + phase);
    }
    shapes.push_back(std::move(shape));
  }
  const double size = add_shapes(scene, shapes, delta);
  return of_mean(
      delta, {{"frequency_hz", omega * scene.rate_hz / kTurn, "Hz"}, {"amplitude", size, "rad/s"}});
}

// A machine starts and stops some ten times in a replicate.
Injection hide_switched_wave(Scene& scene, double delta) {
  const double dwell = static_cast<double>(scene.samples()) / uniform(scene.random, 6.0, 12.0);
  return hide_wave(scene, delta, [&] {
    Series gate(scene.samples());
    double on = below(scene.random, 2) == 0 ? 0.0 : 1.0;
    for (double& x : gate) {
      if (uniform(scene.random, 0.0, 1.0) < 1.0 / dwell) on = 1.0 - on;
      x = on;
    }
    return gate;
  });
}

// Two machines beat: the amplitude swings between nothing and twice its mean.
Injection hide_beating_wave(Scene& scene, double delta) {
  const double beats = uniform(scene.random, 5.0, 40.0);  // in a replicate
  return hide_wave(scene, delta, [&] {
    const double phase = uniform(scene.random, 0.0, kTurn);
    Series out(scene.samples());
    for (std::size_t t = 0; t < out.size(); ++t) {
      const double part = static_cast<double>(t) / static_cast<double>(out.size());
      out[t] = 1.0 + std::sin(kTurn * beats * part + phase);
    }
    return out;
  });
}

// A motor under a changing load: its frequency wanders by about 1 % around one of its own in each
// replicate.
Injection hide_drifting_wave(Scene& scene, double delta) {
  const double middle = draw_frequency_below_mains(scene);
  const double tau = 0.1 * static_cast<double>(scene.samples());
  std::vector<Series> shapes;
  for (std::size_t r = 0; r < scene.replicates(); ++r) {
    const double own = middle * (1.0 + 0.01 * scene.random.normal());
    Series shape = simulate(Markov{0.01, tau}, scene.random, scene.samples());
    double phase = uniform(scene.random, 0.0, kTurn);
    for (double& x : shape) {
      phase += kTurn * own * (1.0 + x);
      x = std::sin(phase);
    }
    shapes.push_back(std::move(shape));
  }
  add_shapes(scene, shapes, delta);
  return of_mean(delta, {});
}

// The drive of a sensor, above half the sampling rate, read by a clock that is never quite even:
// what it folds to differs between replicates by 3 % and moves by 5 to 15 % within some 50 samples.
Injection hide_folded_drive(Scene& scene, double delta) {
  const double middle = draw_frequency_below_mains(scene);
  const double uneven = uniform(scene.random, 0.05, 0.15);
  const double tau = uniform(scene.random, 20.0, 100.0);
  std::vector<Series> shapes;
  for (std::size_t r = 0; r < scene.replicates(); ++r) {
    const double own = middle * (1.0 + 0.03 * scene.random.normal());
    Series shape = simulate(Markov{uneven, tau}, scene.random, scene.samples());
    double phase = uniform(scene.random, 0.0, kTurn);
    for (double& x : shape) {
      phase += kTurn * (own + middle * x);
      x = std::sin(phase);
    }
    shapes.push_back(std::move(shape));
  }
  const double size = add_shapes(scene, shapes, delta);
  return of_mean(delta, {{"amplitude", size, "rad/s"}});
}

}  // namespace

std::vector<HiddenEffect> foreign_waves() {
  return {
      foreign("switched_line", "", hide_switched_wave),
      foreign("line", "beating", hide_beating_wave),
      foreign("wandering_line", "drifting", hide_drifting_wave),
      foreign("oscillation", "folded", hide_folded_drive),
  };
}

}  // namespace imunoise::hidden
