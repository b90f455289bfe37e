// Foreign families of slow courses that no witness shows: the board's thermometer and the other
// witnesses are there, and have nothing to do with them.

#include <cmath>
#include <numbers>

#include "tests/hidden_effects/generator/apply.h"
#include "tests/hidden_effects/generator/draw.h"

namespace imunoise::hidden {
namespace {

// A smooth course of the die's own temperature: three slow swings.
Series draw_thermal_course(Scene& scene) {
  constexpr double kSwings[] = {0.7, 1.6, 2.7};  // in a replicate
  constexpr double kSizes[] = {0.7, 1.0, 0.7};
  Series out(scene.samples(), 0.0);
  for (std::size_t j = 0; j < std::size(kSwings); ++j) {
    const double phase = uniform(scene.random, 0.0, 2.0 * std::numbers::pi);
    const double step = 2.0 * std::numbers::pi * kSwings[j] / static_cast<double>(scene.samples());
    for (std::size_t t = 0; t < out.size(); ++t) {
      out[t] += kSizes[j] * std::sin(step * static_cast<double>(t) + phase);
    }
  }
  return out;
}

// The same after every power-on.
Injection hide_common_course(Scene& scene, double delta) {
  add_shapes(scene, std::vector<Series>(scene.replicates(), draw_thermal_course(scene)), delta);
  return of_mean(delta, {});
}

// Another one each time.
Injection hide_own_courses(Scene& scene, double delta) {
  std::vector<Series> shapes;
  for (std::size_t r = 0; r < scene.replicates(); ++r) {
    shapes.push_back(draw_thermal_course(scene));
  }
  add_shapes(scene, shapes, delta);
  return of_mean(delta, {});
}

// The chip warms fast, its case slowly.
Injection hide_two_warm_ups(Scene& scene, double delta) {
  const double n = static_cast<double>(scene.samples());
  const double fast = n * log_uniform(scene.random, 0.01, 0.03);
  const double slow = fast * uniform(scene.random, 6.0, 12.0);
  Series shape(scene.samples());
  for (std::size_t t = 0; t < shape.size(); ++t) {
    const double at = static_cast<double>(t);
    shape[t] = std::exp(-at / fast) + std::exp(-at / slow);
  }
  add_shapes(scene, std::vector<Series>(scene.replicates(), shape), sign(scene.random) * delta);
  return of_mean(delta, {});
}

// Stress lets go once, in one replicate; half of the step creeps back.
Injection hide_relaxing_step(Scene& scene, double delta) {
  const std::size_t where = below(scene.random, scene.replicates());
  const double n = static_cast<double>(scene.samples());
  const auto when = static_cast<std::size_t>(n * uniform(scene.random, 0.15, 0.6));
  const double creep = n * log_uniform(scene.random, 0.02, 0.1);
  std::vector<Series> shapes(scene.replicates(), Series(scene.samples(), 0.0));
  for (std::size_t t = when; t < scene.samples(); ++t) {
    shapes[where][t] = 0.5 + 0.5 * std::exp(-static_cast<double>(t - when) / creep);
  }
  add_shapes(scene, shapes, sign(scene.random) * delta);
  return of_mean(delta, {});
}

}  // namespace

std::vector<HiddenEffect> foreign_courses() {
  return {
      foreign("common_course", "", hide_common_course),
      foreign("thermal_course", "own", hide_own_courses),
      foreign("warm_up", "two_times", hide_two_warm_ups),
      foreign("step", "relaxing", hide_relaxing_step),
  };
}

}  // namespace imunoise::hidden
