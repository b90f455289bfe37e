#include "core/search/noisy_witness.h"

#include <cmath>

#include "core/effect/witness_spectrum.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

// Products of the whitened witness with what is left, and its squares, by bands of its spectrum.
struct BandSums {
  Eigen::ArrayXd product;
  Eigen::ArrayXd square;

  NoisyWitness less(const Eigen::ArrayXd& signal, double variance) const {
    const double with = (signal * product).sum();
    const double information = (signal.square() * square).sum();
    return {variance, information > 0.0 ? 0.5 * with * with / information : 0.0, information};
  }
};

BandSums sums(const Current& current, const std::vector<SharedVector>& cosines,
              const WitnessSpectrum& spectrum) {
  BandSums out{Eigen::ArrayXd::Zero(spectrum.bands()), Eigen::ArrayXd::Zero(spectrum.bands())};
  for (std::size_t k = 0; k < cosines.size(); ++k) {
    const Eigen::VectorXd weighted = (cosines[k].array() / current.spectrum[k]).matrix();
    const std::vector<Index> edge = spectrum.edges(cosines[k].size() + 1);
    for (Index b = 0; b < spectrum.bands(); ++b) {
      const auto i = static_cast<std::size_t>(b);
      const Index begin = edge[i];
      const Index width = edge[i + 1] - begin;
      const auto part = weighted.segment(begin, width);
      out.product(b) += part.dot(current.cosines[k].segment(begin, width));
      out.square(b) += part.dot(cosines[k].segment(begin, width));
    }
  }
  return out;
}

}  // namespace

NoisyWitness noisy_witness(const Current& current, const std::vector<SharedVector>& cosines) {
  constexpr double kFiner = 1.2;   // of variances that are tried, one over the next
  constexpr double kRange = 1e10;  // of the strongest band over the least noise
  const WitnessSpectrum spectrum(cosines);
  const BandSums all = sums(current, cosines, spectrum);
  NoisyWitness best = all.less(Eigen::ArrayXd::Ones(spectrum.bands()), 0.0);
  const double strongest = spectrum.power().maxCoeff();
  if (!(strongest > 0.0)) return best;
  const auto at = [&](double variance) { return all.less(spectrum.signal(variance), variance); };
  for (double variance = strongest / kRange; variance < strongest; variance *= kFiner) {
    const NoisyWitness one = at(variance);
    if (one.gain > best.gain) best = one;
  }
  if (best.variance == 0.0) return best;
  const double curvature =
      (2.0 * best.gain - at(best.variance * kFiner).gain - at(best.variance / kFiner).gain) /
      std::pow(std::log(kFiner), 2);
  if (curvature > 0.0) best.log_error = 1.0 / std::sqrt(curvature);
  constexpr double kMost = 0.95;
  const Eigen::ArrayXd known = spectrum.signal(best.variance).square() * all.square;
  double below = 0.0;
  for (Index b = 0; b < known.size() && below < kMost * best.information; ++b) {
    below += known(b);
    best.to = spectrum.frequency(b + 1);
  }
  return best;
}

}  // namespace imunoise
