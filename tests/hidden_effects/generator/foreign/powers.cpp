// Foreign families of the variance and the tails.

#include <cmath>

#include "tests/hidden_effects/generator/apply.h"
#include "tests/hidden_effects/generator/draw.h"
#include "tests/hidden_effects/generator/oracle.h"

namespace imunoise::hidden {
namespace {

// White noise whose power is the exponential of a Markov noise of its own in each replicate.
Injection hide_wandering_power(Scene& scene, double delta, double tau) {
  std::vector<Series> courses;
  for (std::size_t r = 0; r < scene.replicates(); ++r) {
    Series course = simulate(Markov{1.0, tau}, scene.random, scene.samples());
    for (double& x : course) x = std::exp(x);
    courses.push_back(std::move(course));
  }
  return add_power(scene, courses, delta);
}

Injection hide_fast_wander(Scene& scene, double delta) {
  const double part = log_uniform(scene.random, 0.005, 0.02);
  return hide_wandering_power(scene, delta, part * static_cast<double>(scene.samples()));
}

Injection hide_slow_wander(Scene& scene, double delta) {
  const double part = uniform(scene.random, 0.2, 0.6);
  return hide_wandering_power(scene, delta, part * static_cast<double>(scene.samples()));
}

// Stretches of more noise, eight in each of the replicates that have any.
Injection hide_bursts(Scene& scene, double delta, bool everywhere) {
  constexpr int kBursts = 8;
  const std::size_t where = below(scene.random, scene.replicates());
  std::vector<Series> courses(scene.replicates(), Series(scene.samples(), 0.0));
  for (std::size_t r = 0; r < scene.replicates(); ++r) {
    for (int i = 0; i < kBursts && (everywhere || r == where); ++i) {
      const double part = uniform(scene.random, 0.004, 0.02);
      const auto length = static_cast<std::size_t>(part * static_cast<double>(scene.samples()));
      const std::size_t begin = below(scene.random, scene.samples() - length);
      for (std::size_t t = begin; t < begin + length; ++t) courses[r][t] = 1.0;
    }
  }
  return add_power(scene, courses, delta);
}

// A normal number over the root of a χ² of `freedom` degrees, of unit variance, is Student's t: a
// mixture of normal ones. The nodes lie evenly in ln χ².
struct MixtureOfScales {
  Series weights;
  Series variances;
};

MixtureOfScales student(int freedom) {
  constexpr int kNodes = 80;
  const double low = std::log(0.005 * freedom);
  const double step = (std::log(6.0 * freedom) - low) / kNodes;
  MixtureOfScales out;
  double sum = 0.0;
  for (int j = 0; j < kNodes; ++j) {
    const double chi2 = std::exp(low + (j + 0.5) * step);
    out.weights.push_back(std::pow(chi2, 0.5 * freedom) * std::exp(-0.5 * chi2));
    out.variances.push_back((freedom - 2.0) / chi2);
    sum += out.weights.back();
  }
  for (double& weight : out.weights) weight /= sum;
  return out;
}

// Noise of Student's t beside the white floor; δ beside the white floor, as strong as it can be
// where that hides its tails no more.
Injection hide_student(Scene& scene, double delta, int freedom) {
  const MixtureOfScales unit = student(freedom);
  const double n = static_cast<double>(scene.samples() * scene.replicates());
  const auto seen = [&](double size) {
    Series variances = unit.variances;
    for (double& v : variances) v = 1.0 + size * size * v;
    return strength(mixture_divergence(unit.weights, variances), n);
  };
  const double size = solve_strength(delta, 1e-2, 1e2, seen);
  for (Recording& recording : scene.recordings) {
    for (double& x : recording[kSubject]) {
      double chi2 = 0.0;
      for (int i = 0; i < freedom; ++i) chi2 += std::pow(scene.random.normal(), 2);
      x += size * scene.floor() * std::sqrt((freedom - 2.0) / chi2) * scene.random.normal();
    }
  }
  const double put = seen(size);
  return {put, put, {}};
}

}  // namespace

std::vector<HiddenEffect> foreign_powers() {
  return {
      foreign("variance_wander", "fast", hide_fast_wander),
      foreign("variance_wander", "slow", hide_slow_wander),
      foreign("heavy_tails", "t4",
              [](Scene& scene, double delta) { return hide_student(scene, delta, 4); }),
      foreign("heavy_tails", "t8",
              [](Scene& scene, double delta) { return hide_student(scene, delta, 8); }),
      foreign("bursts", "one_replicate",
              [](Scene& scene, double delta) { return hide_bursts(scene, delta, false); }),
      foreign("bursts", "all",
              [](Scene& scene, double delta) { return hide_bursts(scene, delta, true); }),
  };
}

}  // namespace imunoise::hidden
