// Foreign families of couplings: the witness is in the file, the form of the coupling is not in the
// catalogue.

#include <algorithm>
#include <cmath>

#include "tests/hidden_effects/generator/apply.h"
#include "tests/hidden_effects/generator/draw.h"

namespace imunoise::hidden {
namespace {

// The same coefficient in every replicate, of either sign.
Injection hide_form(Scene& scene, double delta,
                    const std::function<Series(const Surroundings&)>& form) {
  std::vector<Series> shapes;
  for (const Surroundings& around : scene.surroundings) shapes.push_back(form(around));
  add_shapes(scene, shapes, sign(scene.random) * delta);
  return of_mean(delta, {});
}

// A vibration that the sensor rectifies: the magnitude of the acceleration, whatever its sign.
Injection hide_rectified_acceleration(Scene& scene, double delta) {
  return hide_form(scene, delta, [](const Surroundings& around) {
    Series out = around.acceleration;
    for (double& x : out) x = std::abs(x - 0.02);
    return out;
  });
}

// The glue of the package gives way and holds: the bias follows temperature with a play of 1 K.
Injection hide_hysteresis(Scene& scene, double delta) {
  return hide_form(scene, delta, [](const Surroundings& around) {
    constexpr double kHalfPlay = 0.5;  // K
    Series out = around.temperature;
    double state = out.front();
    for (double& x : out) x = state = std::clamp(state, x - kHalfPlay, x + kHalfPlay);
    return out;
  });
}

// Heat arrives by air: later, and not smoothed.
Injection hide_delay(Scene& scene, double delta) {
  const double delay = log_uniform(scene.random, 2.0, 10.0);  // s
  const auto samples = static_cast<std::size_t>(delay * scene.rate_hz);
  return hide_form(scene, delta, [samples](const Surroundings& around) {
    Series out = around.temperature;
    std::rotate(out.rbegin(), out.rbegin() + static_cast<std::ptrdiff_t>(samples), out.rend());
    std::fill_n(out.begin(), samples, around.temperature.front());
    return out;
  });
}

// The magnetometer clips what the gyro feels in full.
Injection hide_behind_clipped_witness(Scene& scene, double delta) {
  const Injection out =
      hide_form(scene, delta, [](const Surroundings& around) { return around.field; });
  for (Recording& recording : scene.recordings) {
    for (double& x : recording["mag_x"]) x = std::clamp(x, 1.95e-5, 2.1e-5);
  }
  return out;
}

}  // namespace

std::vector<HiddenEffect> foreign_couplings() {
  const auto coupled = [](const char* id, const char* variant, const char* witness, auto hide) {
    HiddenEffect out = foreign(id, variant, hide);
    out.witness = witness;
    return out;
  };
  return {
      coupled("g_sensitivity", "rectified", "acc_x", hide_rectified_acceleration),
      coupled("temperature", "hysteresis", "temperature", hide_hysteresis),
      coupled("temperature", "delayed", "temperature", hide_delay),
      coupled("magnetic", "clipped_witness", "mag_x", hide_behind_clipped_witness),
  };
}

}  // namespace imunoise::hidden
