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
  bool test_seeds = false;  ///< IMUNOISE_TRIAL_SEEDS=test
  std::size_t repeats = 2;  ///< IMUNOISE_TRIAL_REPEATS: seeds for each effect and strength
  /// δ of the catalogue's effects; IMUNOISE_TRIAL_STRENGTHS: "8 12"
  std::vector<double> strengths = {6.0, 8.0, 10.0, 12.0, 16.0};
  std::string only;  ///< IMUNOISE_TRIAL_ONLY: effects whose name holds this text

  std::uint64_t seed(std::size_t repeat) const {
    return (test_seeds ? 4'000'001U : 1U) + static_cast<std::uint64_t>(repeat);
  }
  bool wants(const std::string& name) const { return name.find(only) != std::string::npos; }
};

/// The plan that the environment asks for.
TrialPlan trial_plan();

/// Diagnoses cases, several at a time; in their order. Prints those that gave no report.
std::vector<Outcome> diagnose_all(const std::vector<CaseSpec>& specs,
                                  const Questions& questions = {});

/// Prints the outcomes for which `wrong` holds, a line each, under a heading.
void print_where(const char* heading, const std::vector<Outcome>& outcomes,
                 bool (*wrong)(const Outcome&));

}  // namespace imunoise::hidden
