#include "tests/hidden_effects/generator/apply.h"

#include <cmath>

#include "tests/hidden_effects/generator/oracle.h"

namespace imunoise::hidden {

double add_shapes(Scene& scene, const std::vector<Series>& shapes, double delta) {
  const double factor = delta / mean_strength(shapes, scene.spectrum);
  for (std::size_t r = 0; r < scene.replicates(); ++r) {
    Series& gyro = scene.recordings[r][kSubject];
    for (std::size_t t = 0; t < gyro.size(); ++t) gyro[t] += factor * shapes[r][t];
  }
  return factor;
}

Injection of_mean(double delta, std::vector<TrueParameter> parameters) {
  return {delta, delta, std::move(parameters)};
}

double spectral_strength(const Scene& scene, const Series& after) {
  return strength(divergence(scene.spectrum, after), static_cast<double>(scene.replicates()));
}

Injection of_spectrum(const Scene& scene, const Series& after) {
  const double left = identifiable_divergence(after, scene.base.parts(scene.samples()));
  return {
      spectral_strength(scene, after), strength(left, static_cast<double>(scene.replicates())), {}};
}

Injection add_noise(Scene& scene, double delta,
                    const std::function<BaseNoise(double deviation)>& shape, double& deviation) {
  const Series unit = shape(1.0).spectrum(scene.samples());
  const auto after = [&](double size) {
    Series out = scene.spectrum;
    for (std::size_t k = 0; k < out.size(); ++k) out[k] += size * size * unit[k];
    return out;
  };
  deviation = solve_strength(delta, 1e-9 * scene.floor(), 1e3 * scene.floor(),
                             [&](double size) { return spectral_strength(scene, after(size)); });
  for (Recording& recording : scene.recordings) {
    const Series noise = shape(deviation).simulate(scene.random, scene.samples());
    Series& gyro = recording[kSubject];
    for (std::size_t t = 0; t < gyro.size(); ++t) gyro[t] += noise[t];
  }
  return of_spectrum(scene, after(deviation));
}

}  // namespace imunoise::hidden
