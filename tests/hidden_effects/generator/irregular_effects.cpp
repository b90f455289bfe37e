// What the second order does not see: jumps, outliers, variances that move.

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/hidden_effects/generator/apply.h"
#include "tests/hidden_effects/generator/cosine.h"
#include "tests/hidden_effects/generator/draw.h"
#include "tests/hidden_effects/generator/oracle.h"
#include "tests/hidden_effects/generator/white_walk.h"

namespace imunoise::hidden {
namespace {

// Stress lets go once, in one replicate.
Injection hide_step(Scene& scene, double delta) {
  const std::size_t where = below(scene.random, scene.replicates());
  const double n = static_cast<double>(scene.samples());
  const auto when = static_cast<std::size_t>(n * uniform(scene.random, 0.15, 0.85));
  std::vector<Series> shapes(scene.replicates(), Series(scene.samples(), 0.0));
  std::fill(shapes[where].begin() + static_cast<std::ptrdiff_t>(when), shapes[where].end(), 1.0);
  const double height = add_shapes(scene, shapes, sign(scene.random) * delta);
  return of_mean(delta, {{"time_s", static_cast<double>(when) / scene.rate_hz, "s"},
                         {"amplitude", height, "rad/s"}});
}

// A charge trap fills and empties: two levels, a handful of jumps in a recording. An oracle told
// when would see √(hᵀΣ⁻¹h) ("informed"). One who is not finds each jump within about
// (noise/height)² samples of its dwell, and pays the logarithm of their ratio: half the square of δ
// is the informed one's less ln(signal to noise of a dwell)² for each jump (Laplace's
// approximation).
Injection hide_telegraph(Scene& scene, double delta) {
  const double dwell = static_cast<double>(scene.samples()) / uniform(scene.random, 4.0, 8.0);
  std::vector<Series> shapes;
  double jumps = 0.0;
  for (std::size_t r = 0; r < scene.replicates(); ++r) {
    Series shape(scene.samples());
    double level = 0.5 * sign(scene.random);
    for (double& x : shape) {
      if (uniform(scene.random, 0.0, 1.0) < 1.0 / dwell) {
        level = -level;
        jumps += 1.0;
      }
      x = level;
    }
    shapes.push_back(std::move(shape));
  }
  const double dwells = jumps + static_cast<double>(scene.replicates());
  const double informed = solve_strength(delta, delta, 100.0 * delta, [&](double told) {
    const double price = jumps * std::log(std::max(1.0, told * told / dwells));
    return std::sqrt(std::max(0.0, told * told - 2.0 * price));
  });
  const double amplitude = add_shapes(scene, shapes, informed);
  return {delta,
          informed,
          {{"amplitude", amplitude, "rad/s"}, {"dwell_s", dwell / scene.rate_hz, "s"}}};
}

// Nats by which these samples are likelier as a mixture of normal numbers, a share of them with
// `factor` times the white noise added, than as normal ones of one width.
double gained_by_mixture(const Scene& scene, double share, double factor) {
  const double wide = 1.0 + factor * factor;  // variance
  Series squares;
  for (const Recording& recording : scene.recordings) {
    for (const double z : innovations(recording[kSubject], {scene.base.white, scene.base.walk}))
      squares.push_back(z * z);
  }
  const double n = static_cast<double>(squares.size());
  const double variance = std::accumulate(squares.begin(), squares.end(), 0.0) / n;
  double out = 0.5 * n * (1.0 + std::log(variance));
  for (const double square : squares) {
    out += std::log((1.0 - share) * std::exp(-0.5 * square) +
                    share / std::sqrt(wide) * std::exp(-0.5 * square / wide));
  }
  return out;
}

// Normal, 3 to 6 times as wide as a sample's own noise, here and there. δ beside the white floor.
Injection hide_outliers(Scene& scene, double delta) {
  const double factor = uniform(scene.random, 3.0, 6.0);
  const double n = static_cast<double>(scene.samples() * scene.replicates());
  const double share = solve_strength(
      delta, 0.1 / n, 0.2, [&](double p) { return strength(outlier_divergence(p, factor), n); });
  const auto count = static_cast<std::size_t>(std::ceil(share * n));
  for (std::size_t i = 0; i < count; ++i) {
    Series& gyro = scene.recordings[below(scene.random, scene.replicates())][kSubject];
    gyro[below(scene.random, gyro.size())] += factor * scene.floor() * scene.random.normal();
  }
  const double put = static_cast<double>(count) / n;
  const double delta_put = strength(outlier_divergence(put, factor), n);
  return {delta_put, delta_put, {{"share", put, "1"}}, gained_by_mixture(scene, put, factor)};
}

// White noise grows with temperature, from none at the coldest moment. δ beside the white floor.
Injection hide_modulation(Scene& scene, double delta) {
  double coldest = scene.surroundings.front().temperature.front();
  double warmest = coldest;
  for (const Surroundings& around : scene.surroundings) {
    const auto [low, high] =
        std::minmax_element(around.temperature.begin(), around.temperature.end());
    coldest = std::min(coldest, *low);
    warmest = std::max(warmest, *high);
  }
  std::vector<Series> courses;
  for (const Surroundings& around : scene.surroundings) {
    Series course = around.temperature;
    for (double& kelvin : course) kelvin = (kelvin - coldest) / (warmest - coldest);
    courses.push_back(std::move(course));
  }
  return add_power(scene, courses, delta);
}

// A machine runs beside one replicate for a while: white noise comes to its own. δ beside the white
// floor, of one who is told when.
Injection hide_power_change(Scene& scene, double delta) {
  const double n = static_cast<double>(scene.samples());
  const double length = n * uniform(scene.random, 0.1, 0.6);
  const double begin = uniform(scene.random, 0.0, n - length);
  std::vector<Series> courses(scene.replicates(), Series(scene.samples(), 0.0));
  Series& one = courses[below(scene.random, courses.size())];
  std::fill(one.begin() + static_cast<std::ptrdiff_t>(begin),
            one.begin() + static_cast<std::ptrdiff_t>(begin + length), 1.0);
  Injection out = add_power(scene, courses, delta);
  out.parameters.push_back({"from_s", begin / scene.rate_hz, "s"});
  out.parameters.push_back({"to_s", (begin + length) / scene.rate_hz, "s"});
  return out;
}

Series scaled(Series of, double factor) {
  for (double& x : of) x *= factor;
  return of;
}

// Every other replicate is noisier than its fellows: all of its noise by one factor. δ of an
// observer who must fit the common level.
Injection hide_replicate_change(Scene& scene, double delta) {
  const auto after = [&](double growth) {
    Series out;
    for (std::size_t r = 0; r < scene.replicates(); ++r) {
      out.insert(out.end(), scene.samples() - 1, r % 2 == 0 ? 1.0 : 1.0 + growth);
    }
    return out;
  };
  const double growth =
      solve_strength(delta, 1e-6, 1e3, [&](double g) { return swing_strength(after(g)); });
  for (std::size_t r = 1; r < scene.replicates(); r += 2) {
    for (double& x : scene.recordings[r][kSubject]) x *= std::sqrt(1.0 + growth);
  }
  Injection out = of_mean(delta, {});
  out.gained = 0.0;
  const auto noisier = static_cast<double>(scene.replicates() / 2);
  const double mean = 1.0 + growth * noisier / static_cast<double>(scene.replicates());
  for (std::size_t r = 0; r < scene.replicates(); ++r) {
    const double own = r % 2 == 0 ? 1.0 : 1.0 + growth;
    *out.gained += likelihood_ratio(cosine_coefficients(scene.recordings[r][kSubject]),
                                    scaled(scene.spectrum, mean), scaled(scene.spectrum, own));
  }
  return out;
}

}  // namespace

std::vector<HiddenEffect> irregular_effects() {
  const auto effect = [](const char* id, Family family, auto hide) {
    HiddenEffect out;
    out.id = id;
    out.family = family;
    out.hide = hide;
    return out;
  };
  std::vector<HiddenEffect> out = {
      effect("step", Family::kLocal, hide_step),
      effect("telegraph", Family::kLocal, hide_telegraph),
      effect("outliers", Family::kLocal, hide_outliers),
      effect("replicate_change", Family::kShort, hide_replicate_change),
      effect("power_change", Family::kShort, hide_power_change),
      effect("modulated_variance", Family::kWitness, hide_modulation),
  };
  out.back().witness = "temperature";
  return out;
}

}  // namespace imunoise::hidden
