// Couplings to what a witness measures: gyro_x follows the surroundings themselves, the witness
// shows them with its own sensor's noise.

#include <cmath>

#include "tests/hidden_effects/generator/apply.h"
#include "tests/hidden_effects/generator/draw.h"

namespace imunoise::hidden {
namespace {

constexpr double kReference = 298.15;  // K, where a quadratic coupling has its vertex

// The same coefficient in every replicate, of either sign.
Injection couple(Scene& scene, double delta, const std::string& unit,
                 Series (*shape_of)(const Surroundings&, double), double number = 0.0) {
  std::vector<Series> shapes;
  for (const Surroundings& around : scene.surroundings) {
    shapes.push_back(shape_of(around, number));
  }
  const double coefficient = add_shapes(scene, shapes, sign(scene.random) * delta);
  return of_mean(delta, {{"coefficient", coefficient, unit}});
}

Series temperature(const Surroundings& around, double) { return around.temperature; }

// First-order lag; `time` in samples.
Series lagged_temperature(const Surroundings& around, double time) {
  Series out = around.temperature;
  double state = out.front();
  for (double& x : out) x = state += (x - state) * (1.0 - std::exp(-1.0 / time));
  return out;
}

Series squared_temperature(const Surroundings& around, double) {
  Series out = around.temperature;
  for (double& x : out) x = (x - kReference) * (x - kReference);
  return out;
}

Injection hide_temperature(Scene& scene, double delta) {
  return couple(scene, delta, "rad/s/K", temperature);
}

Injection hide_lagged_temperature(Scene& scene, double delta) {
  const double lag = log_uniform(scene.random, 4.0, 20.0);  // s
  Injection out = couple(scene, delta, "rad/s/K", lagged_temperature, lag * scene.rate_hz);
  out.parameters.push_back({"lag_s", lag, "s"});
  return out;
}

Injection hide_squared_temperature(Scene& scene, double delta) {
  return couple(scene, delta, "rad/s/K^2", squared_temperature);
}

Injection hide_supply(Scene& scene, double delta) {
  return couple(scene, delta, "rad/s/V",
                [](const Surroundings& around, double) { return around.supply; });
}

Injection hide_magnetic(Scene& scene, double delta) {
  return couple(scene, delta, "rad/s/T",
                [](const Surroundings& around, double) { return around.field; });
}

Injection hide_acceleration(Scene& scene, double delta) {
  return couple(scene, delta, "rad/s/(m/s^2)",
                [](const Surroundings& around, double) { return around.acceleration; });
}

}  // namespace

std::vector<HiddenEffect> witness_effects() {
  const auto effect = [](const char* id, const char* variant, const char* witness, auto hide) {
    HiddenEffect out;
    out.id = id;
    out.variant = variant;
    out.family = Family::kWitness;
    out.witness = witness;
    out.hide = hide;
    return out;
  };
  return {
      effect("temperature", "static", "temperature", hide_temperature),
      effect("temperature", "lagged", "temperature", hide_lagged_temperature),
      effect("temperature", "quadratic", "temperature", hide_squared_temperature),
      effect("supply_voltage", "", "supply", hide_supply),
      effect("magnetic", "", "mag_x", hide_magnetic),
      effect("g_sensitivity", "", "acc_x", hide_acceleration),
  };
}

}  // namespace imunoise::hidden
