#include "core/diagnosis/views/left_over.h"

#include "core/inference/normal_scores.h"
#include "core/regression/fitted_model.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

WaveletVariance variance_of(const Eigen::VectorXd& samples, const Subject& subject,
                            const Scales& scales) {
  const std::span<const double> all(samples.data(), static_cast<std::size_t>(samples.size()));
  return wavelet_variance(Signal(all, subject.rate, subject.quantity), scales);
}

}  // namespace

LeftOver left_over(const FittedModel& fitted) {
  const Subject& subject = fitted.regression.subject();
  LeftOver out{std::vector<WaveletVariance>(subject.replicates()), {}, {}};
  std::vector<WaveletVariance> all(subject.replicates());
  const Scales run_off = run_off_scales(subject);
  for_each_index(subject.replicates(), [&](std::size_t k) {
    const Eigen::VectorXd left = fitted.regression.residual_samples(fitted.fit.effects.value, k);
    const Scales octaves = Scales::for_samples(static_cast<std::size_t>(left.size()));
    all[k] = variance_of(left, subject, octaves.with(run_off));
    out.variances[k] = at_scales(all[k], octaves);
  });
  out.covariances = moment_covariances(fitted.fit.model.noise, out.variances);
  out.run_off = run_off_of(fitted, all);
  return out;
}

double training_error(const FittedModel& fitted, const LeftOver& left) {
  const Model& common = fitted.fit.model.noise;
  const std::vector<Model>& own = fitted.fit.own_noise;
  const auto scores = normal_scores(common, left.variances, left.covariances);
  double out = 0.0;
  for (std::size_t k = 0; k < left.variances.size(); ++k) {
    const WaveletVariance& measured = left.variances[k];
    const Model& noise = own.empty() ? common : own[k];
    const Eigen::VectorXd z =
        scores[k].residual(measured.variance, variance(noise, measured.scales.half_widths()));
    out += z.size() > 0 ? z.squaredNorm() / static_cast<double>(z.size()) : 1.0;
  }
  return out / static_cast<double>(left.variances.size());
}

}  // namespace imunoise
