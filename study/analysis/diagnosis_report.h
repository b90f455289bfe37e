#pragma once

// A diagnosis as a message.

#include "core/diagnosis/diagnose.h"
#include "core/diagnosis/heldout.h"
#include "core/diagnosis/views/left_over.h"
#include "imunoise/v1/diagnosis.pb.h"

namespace imunoise::study {

/// Fills verdict, summary, candidates and limits of a report whose unit is set.
void add_diagnosis(const Diagnosis& diagnosis, const Subject& subject, v1::DiagnosisReport& to);

/// Tells in the summary what the whole ladder found (the report's findings), and what a look at its
/// last rung showed; unset: the ladder was long enough, and that was not looked at.
void add_remaining(std::optional<DiagnosisVerdict> verdict, v1::DiagnosisReport& to);

/// How the ladder came to a model.
struct Step {
  std::string added;                   ///< term in the grammar; empty on the first rung
  std::string effect{};                ///< id of what was added
  std::vector<std::string> dropped{};  ///< terms that it made useless
  std::string why;
};

/// A model that was tried, and all that a look at it showed.
struct EvaluatedModel {
  const FittedModel& trial;
  const LeftOver& left;  ///< left_over() of it
  const MisfitReport& misfit;
  const std::optional<HeldOut>& heldout;
};

/// The same for the ladder, without what only a look at the whole ladder shows
/// (tell_unexplained()). `first` is the likelihood of the lowest rung; `replicates` are the names
/// of all.
v1::Rung rung_of(const EvaluatedModel& evaluated, const Step& step, double first,
                 const std::vector<std::string>& replicates);

/// The measured wavelet variance, with the effects taken out, against the noise of a fit.
v1::NoiseBudget budget_of(const FittedModel& trial, const LeftOver& left);

/// What an effect adds to the model, in the grammar.
std::string printed(const AddedTerm& added);

}  // namespace imunoise::study
