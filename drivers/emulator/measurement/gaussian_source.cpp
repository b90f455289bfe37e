#include "drivers/emulator/measurement/gaussian_source.h"

namespace imunoise::emulator {

GaussianSource::GaussianSource(const Measurement& mean, const Measurement& standard_deviation,
                               std::uint64_t seed)
    : mean_(mean), standard_deviation_(standard_deviation), random_(seed) {}

Measurement GaussianSource::measure(double /*time*/) {
  const auto draw = [&](double mean, double deviation) {
    return mean + deviation * random_.normal();
  };
  const auto draw_vector = [&](const Vector& mean, const Vector& deviation) {
    Vector out;
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = draw(mean[i], deviation[i]);
    return out;
  };
  Measurement out;
  out.rate = draw_vector(mean_.rate, standard_deviation_.rate);
  out.specific_force = draw_vector(mean_.specific_force, standard_deviation_.specific_force);
  out.field = draw_vector(mean_.field, standard_deviation_.field);
  out.temperature = draw(mean_.temperature, standard_deviation_.temperature);
  out.supply = draw(mean_.supply, standard_deviation_.supply);
  out.auxiliary = draw(mean_.auxiliary, standard_deviation_.auxiliary);
  return out;
}

}  // namespace imunoise::emulator
