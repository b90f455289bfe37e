#include "core/search/band_gains.h"

#include <algorithm>
#include <cmath>

#include "core/spectrum/bands.h"

namespace imunoise {

BandGains::BandGains(const Current& current, const std::vector<SharedVector>& regressor) {
  const auto length = static_cast<double>(current.subject().length(current.longest()));
  const double rate = current.subject().rate.value;
  first_hertz_ = 0.5 * rate / length;
  const auto octaves = static_cast<Index>(std::ceil(std::log2(length)));
  product_ = Eigen::ArrayXd::Zero(octaves + 1);
  square_ = Eigen::ArrayXd::Zero(octaves + 1);
  for (std::size_t k = 0; k < current.cosines.size(); ++k) {
    const Eigen::ArrayXd weighted = regressor[k].array() / current.spectrum[k];
    Index begin = 0;
    double product = 0.0;
    double square = 0.0;
    for (Index i = 0; i <= octaves; ++i) {
      const Index end = coefficients_below(hertz(i) / rate, weighted.size() + 1);
      const auto part = weighted.segment(begin, end - begin).matrix();
      product += part.dot(current.cosines[k].segment(begin, end - begin));
      square += part.dot(regressor[k].segment(begin, end - begin));
      product_(i) += product;
      square_(i) += square;
      begin = end;
    }
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
