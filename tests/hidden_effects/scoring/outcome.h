#pragma once

// What the diagnosis said of a case, against what was hidden in it.

#include <string>
#include <vector>

#include "core/support/result.h"
#include "imunoise/v1/diagnosis.pb.h"
#include "tests/hidden_effects/generator/hidden_case.h"

namespace imunoise::hidden {

/// A parameter that was put in and that the report gives with an interval.
struct Covered {
  std::string name;
  double truth = 0.0;
  double lower = 0.0;
  double upper = 0.0;
  bool holds() const { return lower <= truth && truth <= upper; }
};

/// One case, diagnosed.
struct Outcome {
  CaseSpec spec;
  std::vector<Injection> injections;
  std::string error;  ///< The tool's, when it gave no report.
  v1::DiagnosisReport report;

  /// Whether the report says that anything is missing or wrong.
  bool detected() const;

  /// Whether what it puts first (of the first `ranks`) names the hidden effect. A defect of the
  /// samples may be named by an integrity finding.
  bool named(std::size_t ranks) const;

  /// Whether it says "found" and names something else.
  bool confidently_wrong() const;

  /// Whether a cause is given as certain that is not the right one: by the verdict "found", unless
  /// that describes a noise by its spectrum alone, or as a defect of the samples.
  bool wrong_cause() const;

  /// Whether the right name stands first, or among those that "one of" lists.
  bool right_or_listed() const;

  /// Whether it says that something is missing without naming one cause.
  bool abstained() const;

  /// Whether it says "found" and names a noise by its spectrum alone, which claims no cause.
  bool described() const;

  /// The intervals of the first candidate when that is right.
  std::vector<Covered> intervals() const;

  /// One line: the case, what was said.
  std::string describe() const;
};

/// What the tool says of recordings; `automatic`: it goes on after the first effect.
Result<v1::DiagnosisReport> ask(const std::vector<Recording>& recordings, const HiddenCase& made,
                                bool automatic = false);

/// The names that are right for a case: those of any of its effects.
std::vector<std::string> right_names(const CaseSpec& spec);

/// Makes the case, tells the tool the base's model (without values), and keeps what it says.
/// `automatic`: it goes on after the first effect.
Outcome diagnose(const CaseSpec& spec, bool automatic = false);

/// Whether every effect of a case is among what the tool added, with `automatic`.
bool all_named(const Outcome& outcome);

}  // namespace imunoise::hidden
