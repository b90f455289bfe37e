#include "core/array/sensor_misfit.h"

#include "core/array/array_blocks.h"

namespace imunoise {
namespace {

// The noise of one sensor.
Model noise_of(const ArrayModel& model, Eigen::Index sensor) {
  Model out;
  for (const Latent& latent : model.latents) {
    if (!latent.acts_on(sensor)) continue;
    Term& term = out.terms.emplace_back(latent.term);
    std::vector<double> v = values(term.process);
    v[0] = latent.power(sensor, sensor);
    set_values(term.process, v);
  }
  return sorted(std::move(out));
}

}  // namespace

std::vector<TestOutcome> sensor_misfits(const ArrayModel& model,
                                        std::span<const WaveletCovariance> replicates) {
  std::vector<TestOutcome> out;
  for (Eigen::Index i = 0; i < model.sensors; ++i) {
    const Model noise = noise_of(model, i);
    std::vector<WaveletVariance> own;
    for (const WaveletCovariance& one : replicates) own.push_back(own_variance(one, i));
    const auto scores = normal_scores(noise, own, moment_covariances(noise, own));
    out.push_back(goodness_of_fit(ScoreBlocks(noise, own, scores)));
  }
  return out;
}

}  // namespace imunoise
