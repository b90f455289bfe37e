#include "core/spectrum/bands.h"

#include <algorithm>
#include <cmath>

namespace imunoise {
namespace {

constexpr Eigen::Index kBandsPerFrequency = 256;

}  // namespace

Bands::Bands(Eigen::Index n) : edges{0} {
  while (edges.back() < n - 1) {
    const Eigen::Index width = 1 + edges.back() / kBandsPerFrequency;
    edges.push_back(std::min(n - 1, edges.back() + width));
  }
  const auto bands = static_cast<Eigen::Index>(edges.size()) - 1;
  Eigen::ArrayXd middle(bands);
  count.resize(bands);
  for (Eigen::Index b = 0; b < bands; ++b) {
    const auto begin = static_cast<double>(edges[static_cast<std::size_t>(b)]);
    count(b) = static_cast<double>(edges[static_cast<std::size_t>(b) + 1]) - begin;
    middle(b) = (begin + 0.5 * (count(b) + 1.0)) / (2.0 * static_cast<double>(n));
  }
  frequency = Frequencies(std::move(middle), scatter_in_bands(count, n));
}

Eigen::ArrayXd scatter_in_bands(const Eigen::ArrayXd& count, Eigen::Index n) {
  return ((count.square() - 1.0) / 12.0).sqrt() / (2.0 * static_cast<double>(n));
}

Eigen::Index coefficients_below(double frequency, Eigen::Index n) {
  // Coefficient k is at k/2n. A frequency that is one of these, but for rounding, is not below.
  constexpr double kRounding = 1e-9;
  const double place = 2.0 * static_cast<double>(n) * frequency;
  const auto first = static_cast<Eigen::Index>(std::ceil(place * (1.0 - kRounding)));
  return std::clamp<Eigen::Index>(first - 1, 0, n - 1);
}

}  // namespace imunoise
