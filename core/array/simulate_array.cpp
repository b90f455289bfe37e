#include "core/array/simulate_array.h"

#include <cmath>

#include "core/support/linear_algebra.h"

namespace imunoise {

Eigen::MatrixXd simulate(const ArrayModel& model, std::size_t n, std::uint64_t seed,
                         std::uint32_t replicate) {
  const auto rows = static_cast<Eigen::Index>(n);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows, model.sensors);
  Eigen::VectorXd unit(rows);
  for (std::uint32_t t = 0; t < model.latents.size(); ++t) {
    const Latent& latent = model.latents[t];
    // One column a source of noise: what it is worth in each sensor.
    Eigen::MatrixXd sources = Eigen::MatrixXd::Zero(model.sensors, 1);
    if (latent.matrix()) {
      sources = square_root(latent.power);
    } else {
      for (const Eigen::Index sensor : latent.sensors)
        sources(sensor, 0) = std::sqrt(latent.scalar());
    }
    for (Eigen::Index source = 0; source < sources.cols(); ++source) {
      unit.setZero();
      RandomStream random(seed, {replicate, t, static_cast<std::uint32_t>(source)});
      add_samples(latent.term.process, random, std::span(unit.data(), n));
      out.noalias() += unit * sources.col(source).transpose();
    }
  }
  return out;
}

}  // namespace imunoise
