#pragma once

// How large a trial is, and from which seeds; by environment variables, because ctest runs it.

#include <cstdint>
#include <string>
#include <vector>

#include "tests/hidden_effects/scoring/outcome.h"

namespace imunoise::hidden {

/// A trial's size. Development seeds are 1, 2, …: the detector may be mended on what they show.
/// Test seeds are run once, and lie in a million of their own for each time: what they show is then
/// known.
struct TrialPlan {
  bool test_seeds = false;          ///< IMUNOISE_TRIAL_SEEDS=test
  std::size_t repeats = 2;          ///< IMUNOISE_TRIAL_REPEATS: seeds for each effect and strength
  std::vector<double> strengths;    ///< IMUNOISE_TRIAL_STRENGTHS: "8 12"; empty: each trial's own
  std::string only;                 ///< IMUNOISE_TRIAL_ONLY: effects whose name holds this text
  std::size_t samples = 1U << 15U;  ///< IMUNOISE_TRIAL_SAMPLES: of a replicate, a power of two
  std::size_t replicates = 4;       ///< IMUNOISE_TRIAL_REPLICATES

  /// A case without effects: of this size, with the seed of a repeat.
  CaseSpec null_case(std::size_t repeat) const;
  /// The same with one effect.
  CaseSpec one_effect(const std::string& name, double delta, std::size_t repeat) const;
  /// The plan's strengths, or `own` where it has none.
  std::vector<double> strengths_or(std::vector<double> own) const;

  std::uint64_t seed(std::size_t repeat) const {
    return (test_seeds ? 9'000'001U : 1U) + static_cast<std::uint64_t>(repeat);
  }
  bool wants(const std::string& name) const { return name.find(only) != std::string::npos; }
};

/// The plan that the environment asks for.
TrialPlan trial_plan();

/// Diagnoses cases, several at a time; in their order. Prints those that gave no report.
/// `automatic`: the tool goes on after the first effect.
std::vector<Outcome> diagnose_all(const std::vector<CaseSpec>& specs, bool automatic = false);

/// Prints the outcomes for which `wrong` holds, a line each, under a heading.
void print_where(const char* heading, const std::vector<Outcome>& outcomes,
                 bool (*wrong)(const Outcome&));

}  // namespace imunoise::hidden
