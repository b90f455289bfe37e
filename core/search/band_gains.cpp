#include "core/search/band_gains.h"

#include <algorithm>
#include <cmath>

#include "core/spectrum/bands.h"

namespace imunoise {

BandSums band_sums(const Current& current, const std::vector<SharedVector>& regressor,
                   const std::function<std::vector<Eigen::Index>(Eigen::Index)>& edges) {
  BandSums out;
  for (std::size_t k = 0; k < regressor.size(); ++k) {
    const Eigen::VectorXd weighted = (regressor[k].array() / current.spectrum[k]).matrix();
    const std::vector<Eigen::Index> edge = edges(weighted.size() + 1);
    const auto bands = static_cast<Eigen::Index>(edge.size()) - 1;
    if (k == 0) out = {Eigen::ArrayXd::Zero(bands), Eigen::ArrayXd::Zero(bands)};
    for (Eigen::Index b = 0; b < bands; ++b) {
      const Eigen::Index begin = edge[static_cast<std::size_t>(b)];
      const Eigen::Index width = edge[static_cast<std::size_t>(b) + 1] - begin;
      const auto part = weighted.segment(begin, width);
      out.product(b) += part.dot(current.cosines[k].segment(begin, width));
      out.square(b) += part.dot(regressor[k].segment(begin, width));
    }
  }
  return out;
}

BandGains::BandGains(const Current& current, const std::vector<SharedVector>& regressor) {
  const auto length = static_cast<double>(current.subject().length(current.longest()));
  const double rate = current.subject().rate.value;
  first_hertz_ = 0.5 * rate / length;
  const auto octaves = static_cast<Index>(std::ceil(std::log2(length)));
  const BandSums sums = band_sums(current, regressor, [&](Index samples) {
    std::vector<Index> edges;
    for (Index i = 0; i <= octaves; ++i)
      edges.push_back(coefficients_below(hertz(i) / rate, samples));
    return edges;
  });
  product_ = Eigen::ArrayXd::Zero(octaves + 1);
  square_ = Eigen::ArrayXd::Zero(octaves + 1);
  for (Index i = 0; i < octaves; ++i) {
    product_(i + 1) = product_(i) + sums.product(i);
    square_(i + 1) = square_(i) + sums.square(i);
  }
}

double BandGains::hertz(Index octave) const {
  return std::exp2(static_cast<double>(octave)) * first_hertz_;
}

double BandGains::gain(Index from, Index to) const {
  const double product = product_(to) - product_(from);
  const double square = information(from, to);
  return square > 0.0 ? 0.5 * product * product / square : 0.0;
}

BandGains::Octaves BandGains::best_octaves() const {
  constexpr Index kMost = 8;
  // All ends and numbers, and one coefficient for all, which was tried as well.
  const Search search{0.0, std::log(2.0 * static_cast<double>((end() - kFirst) * (kMost - 1)))};
  Octaves best;
  for (Index to = kFirst + 1; to <= end(); ++to) {
    double above = 0.0;  // in all octaves but the first
    for (Index count = 2; count <= std::min(kMost, to - kFirst + 1); ++count) {
      above += gain(to - count + 1, to - count + 2);
      const double all = gain(0, to - count + 1) + above;
      const double log_p = log_p_value(all, static_cast<double>(count), INFINITY, false, search);
      if (log_p < best.log_p) best = {to, count, all, search, log_p};
    }
  }
  return best;
}

}  // namespace imunoise
