#include "core/effect/witness_spectrum.h"

#include <algorithm>
#include <cmath>

#include "core/spectrum/bands.h"
#include "core/spectrum/cosine_transform.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

constexpr Index kPerOctave = 16;
constexpr Index kReach = kPerOctave / 4;  // bands that count, to either side

}  // namespace

WitnessSpectrum::WitnessSpectrum(const std::vector<SharedVector>& cosines) {
  Index most = 0;
  for (const SharedVector& one : cosines) most = std::max(most, one.size());
  longest_ = most + 1;
  const auto octaves = static_cast<Index>(std::ceil(std::log2(static_cast<double>(longest_))));
  const Index bands = kPerOctave * octaves;
  Eigen::ArrayXd squares = Eigen::ArrayXd::Zero(bands);
  Eigen::ArrayXd count = Eigen::ArrayXd::Zero(bands);
  power_ = Eigen::ArrayXd::Zero(bands);
  for (const SharedVector& one : cosines) {
    const std::vector<Index> edge = edges(one.size() + 1);
    for (Index b = 0; b < bands; ++b) {
      const auto i = static_cast<std::size_t>(b);
      const Index width = edge[i + 1] - edge[i];
      squares(b) += one.segment(edge[i], width).squaredNorm();
      count(b) += static_cast<double>(width);
    }
  }
  for (Index b = 0; b < bands; ++b) {
    if (count(b) == 0.0) continue;
    const Index begin = std::max<Index>(0, b - kReach);
    const Index width = std::min(bands, b + kReach + 1) - begin;
    power_(b) = squares.segment(begin, width).sum() / count.segment(begin, width).sum();
  }
}

double WitnessSpectrum::frequency(Index band) const {
  const double octave = static_cast<double>(band) / static_cast<double>(kPerOctave);
  return 0.5 / static_cast<double>(longest_) * std::exp2(octave);
}

std::vector<Index> WitnessSpectrum::edges(Index samples) const {
  std::vector<Index> out;
  for (Index b = 0; b < power_.size(); ++b)
    out.push_back(coefficients_below(frequency(b), samples));
  out.push_back(samples - 1);
  return out;
}

Eigen::ArrayXd WitnessSpectrum::signal(double variance) const {
  return (power_ > variance).select(1.0 - variance / power_, 0.0);
}

Witness without_noise(const Witness& witness, double variance) {
  Witness out = witness;
  out.cosines.resize(out.samples.size());
  for_each_index(out.samples.size(), [&](std::size_t k) {
    if (witness.cosines.empty() && out.samples[k].size() > 0)
      out.cosines[k] = cosine_transform(out.samples[k]);
  });
  const WitnessSpectrum spectrum(out.cosines);
  const Eigen::ArrayXd signal = spectrum.signal(variance);
  for_each_index(out.samples.size(), [&](std::size_t k) {
    if (out.samples[k].size() == 0) return;  // a simulation has one replicate at a time
    Eigen::VectorXd cosines = out.cosines[k];
    const std::vector<Index> edge = spectrum.edges(cosines.size() + 1);
    for (Index b = 0; b < signal.size(); ++b) {
      const auto i = static_cast<std::size_t>(b);
      cosines.segment(edge[i], edge[i + 1] - edge[i]) *= signal(b);
    }
    out.samples[k] = inverse_cosine_transform(cosines);
    out.cosines[k] = std::move(cosines);
  });
  return out;
}

}  // namespace imunoise
