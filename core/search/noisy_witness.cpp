#include "core/search/noisy_witness.h"

#include <cmath>

#include "core/effect/witness_spectrum.h"
#include "core/search/band_gains.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

// What one coefficient gains in all bands, if this share of the power in each is signal.
NoisyWitness with_signal(const BandSums& all, const Eigen::ArrayXd& signal, double variance) {
  const double product = (signal * all.product).sum();
  const double information = (signal.square() * all.square).sum();
  return {variance, information > 0.0 ? 0.5 * product * product / information : 0.0, information};
}

}  // namespace

NoisyWitness noisy_witness(const Current& current, const std::vector<SharedVector>& cosines) {
  constexpr double kFiner = 1.2;   // of variances that are tried, one over the next
  constexpr double kRange = 1e10;  // of the strongest band over the least noise
  const WitnessSpectrum spectrum(cosines);
  const BandSums all =
      band_sums(current, cosines, [&](Index samples) { return spectrum.edges(samples); });
  NoisyWitness best = with_signal(all, Eigen::ArrayXd::Ones(spectrum.bands()), 0.0);
  const double strongest = spectrum.power().maxCoeff();
  if (!(strongest > 0.0)) return best;
  const auto at = [&](double variance) {
    return with_signal(all, spectrum.signal(variance), variance);
  };
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
