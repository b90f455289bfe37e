#include "core/inference/moment_draws.h"

#include "core/support/linear_algebra.h"

namespace imunoise {

MomentDraws::MomentDraws(const Model& model, std::span<const WaveletVariance> replicates,
                         const MomentCovariances& covariances)
    : expected_(replicates.begin(), replicates.end()),
      distributions_(PerReplicate<Distribution>::of(replicates, [&](std::size_t k) {
        const Eigen::MatrixXd& v = covariances[k];
        const Eigen::ArrayXd deviation = v.diagonal().array().sqrt();
        const Eigen::ArrayXd nu = variance(model, replicates[k].scales.half_widths());
        const Eigen::VectorXd scale = deviation.inverse().matrix();
        return Distribution{(deviation / nu).square() / 9.0,
                            square_root(scale.asDiagonal() * v * scale.asDiagonal())};
      })) {
  for (WaveletVariance& wv : expected_) {
    wv.variance = variance(model, wv.scales.half_widths());
    set_chi_square_interval(wv);
  }
}

std::vector<WaveletVariance> MomentDraws::draw(RandomStream& stream) const {
  std::vector<WaveletVariance> out = expected_;
  for (std::size_t k = 0; k < out.size(); ++k) {
    const Distribution& of = distributions_[k];
    Eigen::VectorXd normal(of.root.cols());
    for (double& z : normal) z = stream.normal();
    const Eigen::ArrayXd z = (of.root * normal).array();
    const Eigen::ArrayXd ratio = (1.0 - of.spread + of.spread.sqrt() * z).max(0.0).cube();
    out[k].variance *= ratio;
    out[k].lower *= ratio;
    out[k].upper *= ratio;
  }
  return out;
}

}  // namespace imunoise
