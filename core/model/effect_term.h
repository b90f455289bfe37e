#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/model.h"
#include "core/support/result.h"

namespace imunoise {

/// What a term of a model can be besides a noise process.
enum class EffectKind {
  kRamp,       ///< ramp: a constant slope; ramp(own): one a replicate
  kWarmUp,     ///< warm_up(tau=600): exp(-t/τ) from the first sample on
  kLine,       ///< line(f=0.51): a sine wave; line(f=0.51, harmonics=3): and its multiples
  kStep,       ///< step(replicate=2, t=1234.5)
  kWitness,    ///< witness(temperature): proportional to another channel
  kModulated,  ///< modulated(temperature): the noise's power follows another channel
  kTelegraph,  ///< telegraph: jumps between two levels, the same in all replicates
  kOutliers,   ///< outliers(above=6): single samples beyond so many standard deviations
  kOwnPowers,  ///< own_powers: every replicate has powers of its own
};

/// One such term. Numbers that a kind does not have keep their defaults.
struct EffectTerm {
  EffectKind kind = EffectKind::kRamp;
  std::string witness{};   ///< name of the channel
  double tau = 0.0;        ///< s
  double frequency = 0.0;  ///< Hz
  double harmonics = 1.0;  ///< multiples of the frequency, itself included
  double replicate = 0.0;  ///< counted from 1
  double time = 0.0;       ///< s from the replicate's first sample
  double lag = 0.0;        ///< s: the witness goes through a first-order lag of this time constant
  double from = 0.0;       ///< Hz: only the witness's movements faster than this
  double to = std::numeric_limits<double>::infinity();  ///< Hz: and slower than this
  double above = 0.0;                                   ///< standard deviations
  bool own = false;         ///< a coefficient of its own in every replicate
  bool quadratic = false;   ///< the witness enters squared
  bool derivative = false;  ///< the witness's change per second enters

  friend bool operator==(const EffectTerm&, const EffectTerm&) = default;
};

/// A noise model and effects that add to it.
struct FullModel {
  Model noise;
  std::vector<EffectTerm> effects;
  friend bool operator==(const FullModel&, const FullModel&) = default;
};

/// Reads `WN + RW + line(f=0.51) + witness(temperature, lag=300)`: terms of parse_model() and
/// effects in any order. DR is the effect ramp(own). Error: as parse_model(), or what is wrong with
/// an effect.
Result<FullModel> parse_full_model(std::string_view text, Hertz rate);

/// The term with numbers that are worth reading: time constants to four digits, a frequency to a
/// fiftieth of its error in Hz, a step's time to as few as still mean the same sample.
EffectTerm rounded(EffectTerm term, double frequency_error, Hertz rate);

std::string print(const EffectTerm& term);
std::string print(const FullModel& model);
/// The same with every value of the noise.
std::string print_with_values(const FullModel& model);

}  // namespace imunoise
