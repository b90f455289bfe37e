// What gyro_x shares with the other sensors of its board.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/hidden_effects/generator/apply.h"
#include "tests/hidden_effects/generator/cosine.h"
#include "tests/hidden_effects/generator/draw.h"
#include "tests/hidden_effects/generator/oracle.h"

namespace imunoise::hidden {
namespace {

constexpr double kGravity = 9.80665;  // m/s²

void add_scaled(Series& to, const Series& part, double factor) {
  for (std::size_t t = 0; t < to.size(); ++t) to[t] += factor * part[t];
}

// Nats by which gyro_x, given what a neighbour measures of the same motion, is likelier under what
// both share than gyro_x alone under the nearest of the base's noises. `measured`: the neighbour's
// series, one a replicate; `neighbour`: the spectrum of what it does not share; `common`: of what
// it does.
double gained_beside(const Scene& scene, const std::vector<Series>& measured,
                     const Series& neighbour, const Series& common) {
  Series after = scene.spectrum;
  for (std::size_t k = 0; k < after.size(); ++k) after[k] += common[k];
  const Series nearest = nearest_sum(after, scene.base.parts(scene.samples()));
  double out = 0.0;
  for (std::size_t r = 0; r < scene.replicates(); ++r) {
    const Series x = cosine_coefficients(scene.recordings[r][kSubject]);
    const Series y = cosine_coefficients(measured[r]);
    for (std::size_t k = 0; k < after.size(); ++k) {
      const double transfer = common[k] / (neighbour[k] + common[k]);
      const double variance = after[k] - transfer * common[k];
      const double left = x[k + 1] - transfer * y[k + 1];
      out += 0.5 * (std::log(nearest[k] / variance) + x[k + 1] * x[k + 1] / nearest[k] -
                    left * left / variance);
    }
  }
  return out;
}

// What an accelerometer says of the rate at which its axis turns against gravity.
Series turning(const Series& acceleration, double rate_hz) {
  Series out(acceleration.size());
  for (std::size_t t = 0; t + 1 < out.size(); ++t)
    out[t] = (acceleration[t + 1] - acceleration[t]) * rate_hz / kGravity;
  return out;
}

// The power of series by frequency: mean over them and over neighbouring coefficients, entry k-1
// for k ≥ 1.
Series power_of(const std::vector<Series>& all) {
  constexpr std::size_t kReach = 32;
  Series sums(all.front().size(), 0.0);  // of the coefficients before each
  for (const Series& one : all) {
    const Series c = cosine_coefficients(one);
    for (std::size_t k = 1; k < c.size(); ++k)
      sums[k] += c[k] * c[k] / static_cast<double>(all.size());
  }
  for (std::size_t k = 1; k < sums.size(); ++k) sums[k] += sums[k - 1];
  Series out(sums.size() - 1);
  for (std::size_t k = 1; k < sums.size(); ++k) {
    const std::size_t first = k > kReach ? k - kReach - 1 : 0;
    const std::size_t last = std::min(k + kReach, sums.size() - 1);
    out[k - 1] = (sums[last] - sums[first]) / static_cast<double>(last - first);
  }
  return out;
}

// The bench rocks slowly by an angle θ: the gyro feels dθ/dt, the accelerometer g·θ. δ is that of
// an observer of both.
Injection hide_tilt(Scene& scene, double delta) {
  const double frequency = uniform(scene.random, 0.02, 0.05);  // Hz
  const Ringing rocking{1.0, std::exp(-0.2 * 2.0 * std::numbers::pi * frequency / scene.rate_hz),
                        2.0 * std::numbers::pi * frequency / scene.rate_hz};
  std::vector<Series> angles;
  std::vector<Series> rates;
  for (std::size_t r = 0; r < scene.replicates(); ++r) {
    angles.push_back(simulate(rocking, scene.random, scene.samples() + 1));
    Series rate(scene.samples());
    for (std::size_t t = 0; t < rate.size(); ++t) {
      rate[t] = (angles.back()[t + 1] - angles.back()[t]) * scene.rate_hz;
    }
    angles.back().pop_back();
    rates.push_back(std::move(rate));
  }
  std::vector<Series> before;
  for (const Recording& recording : scene.recordings)
    before.push_back(turning(recording["acc_x"], scene.rate_hz));
  // The rate's own spectrum: that of the angle times 4 sin²(πf) f_s².
  Series common = spectrum(rocking, scene.samples());
  for (std::size_t k = 0; k < common.size(); ++k) {
    const double half =
        0.5 * std::numbers::pi * static_cast<double>(k + 1) / static_cast<double>(scene.samples());
    const double turn = 2.0 * std::sin(half) * scene.rate_hz;
    common[k] *= turn * turn;
  }
  const Series neighbour = power_of(before);
  const double replicates = static_cast<double>(scene.replicates());
  const auto times = [&](double factor) {
    Series out = common;
    for (double& power : out) power *= factor * factor;
    return out;
  };
  const auto seen = [&](double factor) {
    return strength(shared_divergence(scene.spectrum, neighbour, times(factor)), replicates);
  };
  const double unit = scene.floor() / scene.rate_hz;  // rad
  const double factor = solve_strength(delta, 1e-6 * unit, 1e6 * unit, seen);
  std::vector<Series> measured;
  for (std::size_t r = 0; r < scene.replicates(); ++r) {
    add_scaled(scene.recordings[r][kSubject], rates[r], factor);
    add_scaled(scene.recordings[r]["acc_x"], angles[r], factor * kGravity);
    measured.push_back(turning(scene.recordings[r]["acc_x"], scene.rate_hz));
  }
  Injection out = of_mean(delta, {});
  out.gained = gained_beside(scene, measured, neighbour, times(factor));
  return out;
}

// The structure shakes both gyros alike, with frequencies up to a few hertz. δ is that of an
// observer of both gyros.
Injection hide_vibration(Scene& scene, double delta) {
  const double tau = log_uniform(scene.random, 3.0, 10.0);  // samples
  const Series neighbour = scene.neighbour.spectrum(scene.samples());
  const double replicates = static_cast<double>(scene.replicates());
  const auto seen = [&](double deviation) {
    const Series common = spectrum(Markov{deviation, tau}, scene.samples());
    return strength(shared_divergence(scene.spectrum, neighbour, common), replicates);
  };
  const double deviation = solve_strength(delta, 1e-6 * scene.floor(), 1e3 * scene.floor(), seen);
  for (Recording& recording : scene.recordings) {
    const Series shaking = simulate(Markov{deviation, tau}, scene.random, scene.samples());
    add_scaled(recording[kSubject], shaking, 1.0);
    add_scaled(recording["gyro_y"], shaking, 1.0);
  }
  Injection out = of_mean(delta, {});
  std::vector<Series> measured;
  for (const Recording& recording : scene.recordings) measured.push_back(recording["gyro_y"]);
  out.gained =
      gained_beside(scene, measured, neighbour, spectrum(Markov{deviation, tau}, scene.samples()));
  return out;
}

// A part of what gyro_y gives out shows in gyro_x.
Injection hide_cross_axis(Scene& scene, double delta) {
  std::vector<Series> shapes;
  for (const Recording& recording : scene.recordings) shapes.push_back(recording["gyro_y"]);
  const double coefficient = add_shapes(scene, shapes, sign(scene.random) * delta);
  return of_mean(delta, {{"coefficient", coefficient, "1"}});
}

}  // namespace

std::vector<HiddenEffect> neighbour_effects() {
  const auto effect = [](const char* id, const char* witness, auto hide) {
    HiddenEffect out;
    out.id = id;
    out.family = Family::kWitness;
    out.witness = witness;
    out.hide = hide;
    return out;
  };
  return {
      effect("tilt", "acc_x", hide_tilt),
      effect("common_vibration", "gyro_y", hide_vibration),
      effect("cross_axis", "gyro_y", hide_cross_axis),
  };
}

}  // namespace imunoise::hidden
