#pragma once

// The noise that is there without any effect, by its own recursions.

#include <cstddef>
#include <string>
#include <vector>

#include "core/support/random.h"
#include "tests/hidden_effects/generator/recording.h"

namespace imunoise::hidden {

/// x_t = φ x_{t-1} + e_t, stationary.
struct Markov {
  double deviation = 0.0;  ///< Standard deviation of x, in the channel's unit.
  double tau = 1.0;        ///< φ = exp(-1/tau); samples.
};

/// x_t = 2r cos(ω) x_{t-1} - r² x_{t-2} + e_t, stationary: a resonance that noise keeps ringing.
struct Ringing {
  double deviation = 0.0;  ///< Standard deviation of x, in the channel's unit.
  double radius = 0.9;     ///< r
  double omega = 1.0;      ///< ω, rad per sample
};

/// A sum of independent noises. Powers are per sample, in the channel's unit squared.
struct BaseNoise {
  double white = 0.0;          ///< σ: standard deviation of white noise.
  double walk = 0.0;           ///< γ: standard deviation of a random walk's increments.
  std::vector<Markov> markov;  ///< Several octaves of them make flicker.
  std::vector<Ringing> ringing;
  std::string model;  ///< The same in the tool's grammar, without values.

  /// A realisation. The walk starts at zero.
  Series simulate(RandomStream& random, std::size_t samples) const;

  /// Variance of the cosine coefficients k = 1 … samples-1 (entry k-1), unit². Exact for the white
  /// noise and the walk, the spectrum at k/2n cycles per sample for the others.
  Series spectrum(std::size_t samples) const;

  /// The parts whose levels a fit of `model` may change, each as `spectrum` has it.
  std::vector<Series> parts(std::size_t samples) const;
};

/// Adds a part of as many samples.
void add(Series& to, const Series& part);

/// A realisation of `markov`.
Series simulate(const Markov& markov, RandomStream& random, std::size_t samples);

/// Its spectrum s²/(1 - 2φ cos ω + φ²) at ω = πk/n, k = 1 … n-1 (entry k-1), unit².
Series spectrum(const Markov& markov, std::size_t samples);

/// A realisation of `ringing`.
Series simulate(const Ringing& ringing, RandomStream& random, std::size_t samples);

/// Its spectrum, as above.
Series spectrum(const Ringing& ringing, std::size_t samples);

/// The laws that cases are built on.
enum class Base {
  kWhite,       ///< WN
  kWhiteWalk,   ///< WN + RW: the usual one
  kMarkovWalk,  ///< AR1 + RW, nothing white
  kMarkov,      ///< AR1 + WN + RW
  kFlicker,     ///< WN + RW + 1/f noise as a Markov noise every octave
};

/// One of its laws: levels drawn within a factor of a few of a consumer gyro's, rad/s.
BaseNoise draw_base(Base base, std::size_t samples, RandomStream& random);

/// Markov noises, one an octave from 1 sample to eight times the recording, whose sum has the
/// two-sided spectrum level²·f^slope (f in cycles per sample, -2 < slope < 0) between those ends.
std::vector<Markov> octaves_of_power_law(double slope, double level, std::size_t samples);

/// The same of slope -1.
std::vector<Markov> octaves_of_flicker(double level, std::size_t samples);

}  // namespace imunoise::hidden
