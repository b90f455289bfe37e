#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/diagnosis/diagnose.h"

namespace imunoise {

/// What the next rung of a ladder is.
struct NextTerm {
  MisfitReport misfit;             ///< of the model as it is
  std::optional<HeldOut> heldout;  ///< of the model as it is
  std::optional<RankedTerm> best;  ///< none: nothing that is worth adding was found
  /// Of the model as it is, where nothing is worth adding: kNone or kUnknown.
  DiagnosisVerdict verdict = DiagnosisVerdict::kNone;
};

/// Finds one term after the other, as diagnose() would, with less work: a ladder does not ask what
/// else a term could be. It takes what one look at everything found, term by term. Each is sought
/// again under the model of its rung, and taken if it still explains at least half as much. Where
/// none does, everything is sought again. Deterministic.
class Climb {
 public:
  /// `first`: what the first look found; its best term is taken. Of recordings of more than twice
  /// `beginning` samples, all replicates together, so many are looked at first.
  Climb(const Diagnosis& first, const FittedModel& model, double level,
        Eigen::Index beginning = 1 << 18);

  /// `heldout`: of the model, where it is known.
  NextTerm next(const FittedModel& model, const std::optional<HeldOut>& heldout = std::nullopt,
                const Progress& progress = {});

 private:
  /// What a look at everything found worth adding, and did not take.
  struct Lead {
    std::string found;               ///< the cause that its search names, and its witness
    const Effect* effect = nullptr;  ///< null: noise
    double evidence = 0.0;           ///< nats
  };
  struct Look;

  std::optional<RankedTerm> by_beginnings(Look look, const Progress& progress);
  std::optional<RankedTerm> by_leads(Look look, const Progress& progress);
  std::optional<RankedTerm> by_everything(Look look, const Progress& progress);
  /// `thorough`: also what promises little, and what was refuted, sought beside a coupling.
  std::vector<TriedTerm> tried(const Look& look, Suggestions wanted, const Progress& progress,
                               bool thorough = false) const;
  std::optional<RankedTerm> best_of(const Look& look, std::vector<TriedTerm> tried);
  const Lead* lead_to(const Suggestion& one) const;  ///< null: none
  void follow(const TriedTerm& one);
  void leave_behind(const TriedTerm& taken);
  void refute(const Suggestion& one);

  Levels levels_;
  Eigen::Index beginning_;  ///< samples; 0: what is missing does not show there
  double searches_ = 0.0;   ///< of the last look at everything
  std::vector<Lead> leads_;
  std::vector<std::string> refuted_;  ///< promised much, and proved nothing: asked last
};

}  // namespace imunoise
