#pragma once

// What the diagnosis said of a case, against what was hidden in it.

#include <cmath>
#include <optional>
#include <string>
#include <vector>

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

/// How the error fell when the right effect was added.
struct ErrorFall {
  double share = 0.0;     ///< of the fall of `unexplained` that an oracle sees
  std::string failing{};  ///< the view that failed most before; empty: none did (p ≥ 1e-3)
  bool at_floor = false;  ///< that view lies within chance after it
  std::string risen{};    ///< another view that rose beyond chance; empty: none
};

/// One case, diagnosed.
struct Outcome {
  CaseSpec spec;
  std::vector<Injection> injections;
  std::string error;  ///< The tool's, when it gave no report.
  v1::DiagnosisReport report;
  std::optional<double> clean_nats;  ///< Held-out, of the base model on the data without effects.

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

  /// Held-out nats that an oracle gains: those of the data without the effect where it shifts the
  /// mean; elsewhere what is expected, δ²/2, which a set of data misses by δ (standard deviation).
  double oracle_gain() const;

  /// What adding the effect that it puts first does to the ladder's number and to the views; absent
  /// when that is not right, or nothing was held out.
  std::optional<ErrorFall> error_fall() const;

  /// The intervals of the first candidate when that is right.
  std::vector<Covered> intervals() const;

  /// One line: the case, what was said.
  std::string describe() const;
};

/// What a trial asks of a case.
struct Questions {
  bool automatic = false;  ///< Let the tool go on after the first effect.
  /// Diagnose the clean data as well, from this δ on: their likelihood is what an oracle reaches.
  double oracle_from = INFINITY;
};

/// Makes the case, tells the tool the base's model (without values), and keeps what it says.
Outcome diagnose(const CaseSpec& spec, const Questions& questions = {});

/// Whether every effect of a case is among what the tool added, with `automatic`.
bool all_named(const Outcome& outcome);

}  // namespace imunoise::hidden
