#include "core/array/dependence.h"

#include "core/support/holm.h"
#include "core/support/linear_algebra.h"

namespace imunoise {
namespace {

constexpr double kLeastDegrees = 10.0;

ArrayModel without_correlation(ArrayModel model) {
  for (Latent& latent : model.latents) {
    const Eigen::VectorXd own = latent.power.diagonal();
    latent.power = own.asDiagonal();
  }
  return model;
}

void adjust(std::vector<PairDependence>& tests) {
  std::vector<double> p_values;
  for (const PairDependence& one : tests) p_values.push_back(one.test.p_value);
  const std::vector<double> adjusted = holm(p_values);
  for (std::size_t i = 0; i < tests.size(); ++i) tests[i].adjusted_p = adjusted[i];
}

}  // namespace

std::vector<PairDependence> dependence(const ArrayModel& model,
                                       std::span<const WaveletCovariance> replicates) {
  const ArrayModel independent = without_correlation(model);
  const WaveletCovariance& first = replicates.front();
  const Eigen::ArrayXd degrees = equivalent_degrees(first.scales, first.samples);
  std::vector<bool> used;
  for (const double d : degrees) used.push_back(d >= kLeastDegrees);
  const Scales scales = first.scales.where(used);
  const auto n = static_cast<Eigen::Index>(scales.size());  // the largest scales are left out
  const auto count = static_cast<double>(replicates.size());

  std::vector<PairDependence> out;
  for (const Pair& pair : all_pairs(model.sensors)) {
    if (pair.a == pair.b) continue;
    PairDependence one{pair, {}, 1.0, Eigen::ArrayXd::Zero(n), Eigen::ArrayXd::Zero(n)};
    if (n == 0) {  // too short to tell
      out.push_back(std::move(one));
      continue;
    }
    Eigen::ArrayXd cross = Eigen::ArrayXd::Zero(n);
    Eigen::ArrayXd own_a = Eigen::ArrayXd::Zero(n);
    Eigen::ArrayXd own_b = Eigen::ArrayXd::Zero(n);
    for (const WaveletCovariance& replicate : replicates) {
      cross += replicate.of(pair.a, pair.b).head(n) / count;
      own_a += replicate.of(pair.a, pair.a).head(n) / count;
      own_b += replicate.of(pair.b, pair.b).head(n) / count;
    }
    const Eigen::MatrixXd v =
        array_moment_covariance(independent, {pair}, scales, first.samples) / count;
    const Eigen::VectorXd whitened = whiten(v).matrix * cross.matrix();
    one.test = chi_square_test(whitened.squaredNorm(), whitened.size());
    one.z = cross / v.diagonal().array().sqrt();
    one.correlation = cross / (own_a * own_b).sqrt();
    out.push_back(std::move(one));
  }
  adjust(out);
  return out;
}

}  // namespace imunoise
