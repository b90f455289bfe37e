// What time alone explains: the same course in every replicate, counted from its power-on.

#include <cmath>

#include "tests/hidden_effects/generator/apply.h"
#include "tests/hidden_effects/generator/draw.h"

namespace imunoise::hidden {
namespace {

Injection hide_ramp(Scene& scene, double delta) {
  Series shape(scene.samples());
  for (std::size_t t = 0; t < shape.size(); ++t) {
    shape[t] = static_cast<double>(t) / scene.rate_hz;
  }
  const double slope =
      add_shapes(scene, std::vector<Series>(scene.replicates(), shape), sign(scene.random) * delta);
  return of_mean(delta, {{"coefficient", slope, "rad/s/s"}});
}

Injection hide_warm_up(Scene& scene, double delta) {
  const double tau = scene.seconds() * log_uniform(scene.random, 0.03, 0.15);
  Series shape(scene.samples());
  for (std::size_t t = 0; t < shape.size(); ++t) {
    shape[t] = std::exp(-static_cast<double>(t) / (tau * scene.rate_hz));
  }
  const double amplitude =
      add_shapes(scene, std::vector<Series>(scene.replicates(), shape), sign(scene.random) * delta);
  return of_mean(delta, {{"tau_s", tau, "s"}, {"amplitude", amplitude, "rad/s"}});
}

}  // namespace

std::vector<HiddenEffect> slow_effects() {
  HiddenEffect ramp;
  ramp.id = "rate_ramp";
  ramp.family = Family::kSlow;
  ramp.hide = hide_ramp;
  HiddenEffect warm_up = ramp;
  warm_up.id = "warm_up";
  warm_up.hide = hide_warm_up;
  return {ramp, warm_up};
}

}  // namespace imunoise::hidden
