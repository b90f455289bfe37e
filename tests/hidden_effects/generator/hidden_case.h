#pragma once

// One case of the blind trial: data, and what is hidden in them.

#include <cstdint>
#include <string>
#include <vector>

#include "tests/hidden_effects/generator/effect.h"

namespace imunoise::hidden {

/// What to make.
struct CaseSpec {
  std::vector<std::string> effects;  ///< Names, as HiddenEffect::name(); none for a null case.
  double delta = 0.0;                ///< Of each effect.
  std::uint64_t seed = 1;
  Base null_base = Base::kWhiteWalk;      ///< Of a null case; else the first effect says.
  Weather null_weather = Weather::kCalm;  ///< Of a null case; else lively.
  bool withhold = false;                  ///< Leaves the effects' witnesses out of the files.
  std::size_t replicates = 4;
  std::size_t samples = 1U << 15U;  ///< In each; a power of two.
};

/// What was made.
struct HiddenCase {
  CaseSpec spec;
  double rate_hz = 100.0;
  BaseNoise base;                     ///< Its `model` is the base in the tool's grammar.
  std::vector<Injection> injections;  ///< One an effect.
  std::vector<Recording> recordings;  ///< One a replicate.
  std::vector<Recording> clean;       ///< The same noise without the effects.
};

/// Makes a case: the same from the same spec, on every machine. Precondition: the effects exist.
HiddenCase make_case(const CaseSpec& spec);

/// "WN+RW": a base by its noises.
const char* name_of(Base base);

/// "calm", "lively" or "slow".
const char* name_of(Weather weather);

/// "temperature/lagged, δ = 12, seed 7", for tables and messages.
std::string describe(const CaseSpec& spec);

}  // namespace imunoise::hidden
