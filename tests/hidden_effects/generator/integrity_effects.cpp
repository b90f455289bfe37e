// Defects of the samples themselves. Noise of continuous values never repeats itself, so whoever
// looks is certain; `delta` counts here and is told for each.

#include <algorithm>
#include <cmath>

#include "tests/hidden_effects/generator/apply.h"
#include "tests/hidden_effects/generator/draw.h"

namespace imunoise::hidden {
namespace {

Injection of_count(double delta, double count) { return {delta, delta, {{"count", count, "1"}}}; }

// `delta` times a sample is given out twice in place of the one after it.
Injection hide_duplicates(Scene& scene, double delta) {
  const auto count = static_cast<std::size_t>(std::lround(delta));
  for (std::size_t i = 0; i < count; ++i) {
    Series& gyro = scene.recordings[below(scene.random, scene.replicates())][kSubject];
    const std::size_t at = 1 + below(scene.random, gyro.size() - 1);
    gyro[at] = gyro[at - 1];
  }
  return of_count(delta, static_cast<double>(count));
}

// The output holds still for 4 times `delta` samples, in one replicate.
Injection hide_stuck(Scene& scene, double delta) {
  const auto count = static_cast<std::size_t>(std::lround(4.0 * delta));
  Series& gyro = scene.recordings[below(scene.random, scene.replicates())][kSubject];
  const std::size_t at = below(scene.random, gyro.size() - count);
  std::fill_n(gyro.begin() + static_cast<std::ptrdiff_t>(at), count, gyro[at]);
  return of_count(delta, static_cast<double>(count));
}

// The range ends so low that about 4 times `delta` samples of all are cut to it.
Injection hide_saturation(Scene& scene, double delta) {
  const auto count = static_cast<std::size_t>(std::lround(4.0 * delta));
  Series all;
  for (const Recording& recording : scene.recordings) {
    const Series& gyro = recording[kSubject];
    all.insert(all.end(), gyro.begin(), gyro.end());
  }
  const auto limit = all.end() - static_cast<std::ptrdiff_t>(count) - 1;
  std::nth_element(all.begin(), limit, all.end());
  for (Recording& recording : scene.recordings) {
    for (double& x : recording[kSubject]) x = std::min(x, *limit);
  }
  return of_count(delta, static_cast<double>(count));
}

// The rate itself is rounded, to steps of delta/4 times its own white noise: few codes.
Injection hide_coarse_codes(Scene& scene, double delta) {
  const double step = 0.25 * delta * scene.floor();
  for (Recording& recording : scene.recordings) {
    for (double& x : recording[kSubject]) x = step * std::round(x / step);
  }
  return {delta, delta, {{"step", step, "rad/s"}}};
}

}  // namespace

// Lost samples are not here: without a counter or a clock in the file nothing shows them.
std::vector<HiddenEffect> integrity_effects() {
  const auto effect = [](const char* id, const char* variant, auto hide) {
    HiddenEffect out;
    out.id = id;
    out.variant = variant;
    out.kind = Kind::kIntegrity;
    out.hide = hide;
    return out;
  };
  return {
      effect("duplicated_samples", "", hide_duplicates),
      effect("stuck", "", hide_stuck),
      effect("saturation", "", hide_saturation),
      effect("quantisation", "codes", hide_coarse_codes),
  };
}

}  // namespace imunoise::hidden
