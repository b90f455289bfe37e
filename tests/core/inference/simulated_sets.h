#pragma once

// Simulated recordings of known models, with their moments: what the trials of inference are made
// of.

#include <cmath>
#include <string>
#include <vector>

#include "core/inference/fit.h"
#include "core/wavelet/wavelet_variance.h"

namespace imunoise::testing {

inline constexpr Hertz kTrialRate{100};

/// The model that a trusted text names.
inline Model model_of(const std::string& text) { return parse_model(text, kTrialRate).value(); }

/// The same terms with every parameter free: what a user who does not know the values would ask
/// for.
inline Model freed(Model model) {
  for (Term& term : model.terms) term.given.assign(term.given.size(), false);
  return model;
}

/// Moments of `lengths.size()` simulated replicates of one truth.
inline std::vector<WaveletVariance> simulated_set(const Model& truth,
                                                  const std::vector<std::size_t>& lengths,
                                                  int per_octave, std::uint64_t seed) {
  std::vector<WaveletVariance> out;
  for (std::size_t k = 0; k < lengths.size(); ++k) {
    const std::vector<double> x = simulate(truth, lengths[k], seed, static_cast<std::uint32_t>(k));
    out.push_back(wavelet_variance(Signal(std::span<const double>(x), kTrialRate),
                                   Scales::for_samples(lengths[k], per_octave)));
  }
  return out;
}

/// Moments that equal a model's theory, as if the recording had been endless.
inline WaveletVariance theory(const Model& truth, std::size_t samples, int per_octave = 1) {
  WaveletVariance out;
  out.samples = samples;
  out.scales = Scales::for_samples(samples, per_octave);
  out.rate = kTrialRate;
  out.variance = variance(truth, out.scales.half_widths());
  set_chi_square_interval(out);
  return out;
}

/// How far a share of n trials may lie from its nominal value: 3.3 binomial standard errors (1 in
/// 1,000).
inline double binomial_allowance(double nominal, double n) {
  return 3.3 * std::sqrt(nominal * (1.0 - nominal) / n);
}

}  // namespace imunoise::testing
