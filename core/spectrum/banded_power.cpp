#include "core/spectrum/banded_power.h"

#include <cmath>
#include <utility>
#include <vector>

#include "core/spectrum/bands.h"
#include "core/spectrum/cosine_transform.h"
#include "core/spectrum/cross_power.h"
#include "core/spectrum/roots_of_unity.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

// Of a ramp of slope 1: the k-th coefficient is √(2/n) Σ_t t cos(πk(t + ½)/n), which is zero for
// even k and -√(2/n) cos φ / (2 sin² φ), φ = πk/2n, for odd ones (the derivative of Σ_t sin(x(t +
// ½)) = sin²(nx/2) / sin(x/2) at x = πk/n).
class RampTransform {
 public:
  explicit RampTransform(std::size_t n)
      : roots_(4 * n), half_scale_(-std::sqrt(0.5 / static_cast<double>(n))) {}
  double operator()(Index k) const {
    if (k % 2 == 0) return 0.0;
    const std::complex<double> root = roots_(static_cast<std::size_t>(k));
    return half_scale_ * root.real() / (root.imag() * root.imag());
  }

 private:
  RootsOfUnity roots_;
  double half_scale_;
};

}  // namespace

BandedPower bands_of(std::size_t n, Hertz rate) {
  const std::size_t quick = quick_length(n);
  const Bands bands(static_cast<Index>(quick));
  const Eigen::ArrayXd zero = Eigen::ArrayXd::Zero(bands.size());
  BandedPower out{bands.frequency, bands.count, zero, zero, zero, quick, rate};
  const RampTransform ramp(quick);
  for (Index b = 0; b < bands.size(); ++b) {
    const Index end = bands.edges[static_cast<std::size_t>(b) + 1];
    for (Index place = bands.edges[static_cast<std::size_t>(b)]; place < end; ++place)
      out.ramp_power(b) += ramp(place + 1) * ramp(place + 1);
  }
  out.ramp_power /= bands.count;
  return out;
}

BandedPower in_wider_bands(const BandedPower& fine) {
  constexpr double kBandsPerFrequency = 64.0;
  std::vector<Index> edges = {0};  // places of the first band of each wider one, and the end
  double below = 0.0;              // coefficients below it
  double here = 0.0;
  for (Index b = 0; b < fine.count.size(); ++b) {
    here += fine.count(b);
    if (here < 1.0 + std::floor(below / kBandsPerFrequency)) continue;
    edges.push_back(b + 1);
    below += std::exchange(here, 0.0);
  }
  if (edges.back() < fine.count.size()) edges.push_back(fine.count.size());
  const auto size = static_cast<Index>(edges.size()) - 1;
  const auto joined = [&](const Eigen::ArrayXd& of_bands, bool mean) {
    Eigen::ArrayXd out(size);
    for (Index b = 0; b < size; ++b) {
      const Index begin = edges[static_cast<std::size_t>(b)];
      const Index count = edges[static_cast<std::size_t>(b) + 1] - begin;
      const auto weights = fine.count.segment(begin, count);
      out(b) =
          mean ? (weights * of_bands.segment(begin, count)).sum() / weights.sum() : weights.sum();
    }
    return out;
  };
  Eigen::ArrayXd count = joined(fine.count, false);
  Eigen::ArrayXd scatter = scatter_in_bands(count, static_cast<Index>(fine.samples));
  return {Frequencies(joined(fine.frequency.cycles(), true), std::move(scatter)),
          std::move(count),
          joined(fine.power, true),
          joined(fine.ramp_cross, true),
          joined(fine.ramp_power, true),
          fine.samples,
          fine.rate};
}

BandedPower banded_power(const Signal& signal) {
  BandedPower out = bands_of(signal.size(), signal.rate());
  const Eigen::VectorXd cosines = cosine_transform(samples_of(signal));
  const Bands bands(cosines.size() + 1);
  const RampTransform ramp(out.samples);
  for (Index b = 0; b < bands.size(); ++b) {
    const Index begin = bands.edges[static_cast<std::size_t>(b)];
    const Index end = bands.edges[static_cast<std::size_t>(b) + 1];
    out.power(b) = cosines.segment(begin, end - begin).squaredNorm();
    for (Index place = begin; place < end; ++place)
      out.ramp_cross(b) += cosines(place) * ramp(place + 1);
  }
  out.power /= bands.count;
  out.ramp_cross /= bands.count;
  return out;
}

}  // namespace imunoise
