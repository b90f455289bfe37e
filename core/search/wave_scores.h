#pragma once

#include <complex>

#include "core/regression/current.h"

namespace imunoise {

/// Some samples of one replicate.
struct Stretch {
  std::size_t replicate;
  Eigen::Index begin;
  Eigen::Index length;
};

/// A wave of fewer periods than this in a replicate is a trend like any other there.
inline constexpr double kFewestPeriods = 3.0;

/// The shortest quick_length() ≥ n.
Eigen::Index padded_length(Eigen::Index n);

/// Spectrum of the current noise in a replicate at a frequency in cycles per sample, unit² per
/// cycle/sample.
double noise_level(const Current& current, std::size_t replicate, double frequency);

/// Σ u_t exp(-2πift) over a stretch of what the current model leaves, weighted by the noise; t
/// counts from the first sample of the stretch.
std::complex<double> wave_sum(const Current& current, const Stretch& stretch, double frequency);

/// Log-likelihood gained in a stretch by a wave of any phase and size at one frequency, nats.
double wave_gain(const Current& current, const Stretch& stretch, double frequency);
/// The same at the frequencies i/padded, i = 0 … padded/2.
Eigen::ArrayXd wave_gains(const Current& current, const Stretch& stretch, Eigen::Index padded);

/// The same over all replicates, each where it has enough periods (kFewestPeriods), from the first
/// frequency on that has enough in the longest one. Empty where none has.
struct AllWaves {
  Eigen::Index first = 0;  ///< number of the first frequency
  Eigen::ArrayXd gain{};   ///< nats at the frequencies (first + i)/padded, all below a half
};
AllWaves all_wave_gains(const Current& current, Eigen::Index padded);

}  // namespace imunoise
