#include "core/diagnosis/views/scale_kurtosis.h"

#include <cmath>

namespace imunoise {
namespace {

using Index = Eigen::Index;

constexpr double kFewestCoefficients = 256.0;

// Neighbours taken together, as their sum or their difference.
Eigen::VectorXd paired(const Eigen::VectorXd& x, double sign) {
  const Index n = x.size() / 2;
  const Eigen::Map<const Eigen::VectorXd, 0, Eigen::InnerStride<2>> even(x.data(), n);
  const Eigen::Map<const Eigen::VectorXd, 0, Eigen::InnerStride<2>> odd(x.data() + 1, n);
  return even + sign * odd;
}

ScaleKurtosis kurtosis_of(const std::vector<Eigen::VectorXd>& each, double seconds) {
  double fourth = 0.0;
  double count = 0.0;
  for (const Eigen::VectorXd& x : each) {
    const auto n = static_cast<double>(x.size());
    const double level = x.squaredNorm() / n;
    if (!(level > 0.0)) continue;
    fourth += x.array().square().square().sum() / (level * level);
    count += n;
  }
  return {seconds, count > 0.0 ? fourth / count - 3.0 : 0.0, std::sqrt(24.0 / count)};
}

}  // namespace

std::vector<ScaleKurtosis> scale_kurtosis(const Innovations& innovations, double rate) {
  std::vector<Eigen::VectorXd> sums = innovations.white;
  std::vector<ScaleKurtosis> out;
  double samples = 1.0;
  double left = 0.0;
  for (const Eigen::VectorXd& x : sums) left += static_cast<double>(x.size());
  if (left >= kFewestCoefficients) out.push_back(kurtosis_of(sums, samples / rate));
  for (left /= 2.0; left >= kFewestCoefficients; left /= 2.0) {
    samples *= 2.0;
    std::vector<Eigen::VectorXd> differences;
    for (Eigen::VectorXd& x : sums) {
      differences.push_back(paired(x, -1.0));
      x = paired(x, 1.0);
    }
    out.push_back(kurtosis_of(differences, samples / rate));
  }
  return out;
}

}  // namespace imunoise
