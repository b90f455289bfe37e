#pragma once

// The contract of effects: what a model can hold beside its noise processes. An effect is a
// constant descriptor in a file of its own in core/effects, which holds all of it: how it is
// written, what it adds to the mean or the variance, how a search finds it, which physical causes
// it has and which numbers a report shows. Nothing else asks which effect it has.

#include <Eigen/Core>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/random.h"
#include "core/support/result.h"
#include "core/support/shared_vector.h"

namespace imunoise {

class Regression;
class SearchView;
struct Columns;
struct Current;
struct EffectTerm;
struct FittedEffect;
struct FittedModel;
struct JointFit;
struct Regressors;
struct ReportedNumber;
struct Subject;
struct VarianceCourse;
struct Suggestion;
struct TriedTerm;

/// What the value of a parameter can be.
enum class ParameterForm {
  kNumber,
  kWholeNumber,
  kFlag,  ///< written without a value: it is there or not
};

/// To how many digits a search writes what it found.
enum class Rounding {
  kNone,
  kFourDigits,
  kByError,   ///< to a fiftieth of its standard error
  kBySample,  ///< to as few digits as still mean the same sample
};

/// How the standard error that a search gives (Suggestion::shape_error) enters a parameter.
enum class ShapeError {
  kNone,
  kAbsolute,
  kLogarithm,  ///< it is that of the parameter's logarithm
};

/// One parameter of an effect.
struct EffectParameter {
  std::string_view name;     ///< in the grammar: "tau"
  std::string_view meaning;  ///< a noun phrase: "time constant"
  std::string_view unit{};   ///< "s"; empty for counts and flags, and where `truth` says the unit
  ParameterForm form = ParameterForm::kNumber;
  bool required = false;  ///< it must be given, and be > 0
  double absent = 0.0;    ///< its value where it is not given
  double lower = 0.0;
  double upper = 1e15;
  std::string_view reported{};  ///< its name among reported numbers; empty: not reported as given
  Rounding rounding = Rounding::kNone;
  ShapeError error = ShapeError::kNone;
  /// A size, which a simulation needs and a fit estimates; its unit follows from the channel.
  /// Parameters that are no truth give the effect its shape.
  bool truth = false;
};

/// A physical cause behind what a model misses.
struct Cause {
  std::string_view id;                         ///< "temperature"
  std::string_view title;                      ///< "coupling to temperature"
  std::string_view physics;                    ///< a sentence
  std::string_view record_next;                ///< what to record to be sure
  std::vector<std::string_view> looks_like{};  ///< ids
  std::string_view family{};  ///< causes whose difference is a matter of words share one
  bool slow = false;          ///< an unrecorded temperature could have done it
  bool by_spectrum = false;   ///< only its spectrum shows it: whatever couples in looks the same
};

/// One replicate of a simulation.
struct SimulatedReplicate {
  const Subject& beside;  ///< rate, witnesses and parts; its samples do not matter
  std::size_t replicate;
  RandomStream& random;  ///< the term's own
};

/// An effect. Functions that it does not need are null.
struct Effect {
  std::string_view name;     ///< in the grammar: "warm_up"
  std::string_view title;    ///< "warm-up"
  std::string_view meaning;  ///< what it does to the samples, one sentence
  bool witness = false;      ///< it names another channel, the first word in its brackets
  std::vector<EffectParameter> parameters{};
  std::string_view coefficient{};  ///< name of what a fit estimates: "slope"
  bool anywhere = false;  ///< a search tries all its places alike: a limit of detection names none
  double fewest_periods = 0.0;  ///< of a wave: one with fewer in a replicate is not sought
  std::vector<Cause> causes{};

  /// What is wrong with a term beyond the bounds of its parameters; empty where nothing is.
  std::string_view (*fault)(const EffectTerm& term) = nullptr;
  /// Error: why these recordings cannot show the term.
  Result<void> (*check)(const EffectTerm& term, const Subject& subject) = nullptr;
  /// Unit of the coefficient. Null: that of the channel.
  std::string (*unit)(const EffectTerm& term, const Subject& subject) = nullptr;

  // What it adds to the mean.
  /// Regressors of each replicate.
  Regressors (*regressors)(const EffectTerm& term, const Subject& subject) = nullptr;
  /// Adds its columns of one replicate times `coefficients` to `to`, up to a constant. Null: from
  /// the columns themselves.
  void (*add)(const EffectTerm& term, const Subject& subject, std::size_t replicate,
              const Eigen::VectorXd& coefficients, Eigen::VectorXd& to) = nullptr;
  /// A model with this term more, fitted, where its regressors must be sought in the samples under
  /// the noise of the fit. Null: regressors() says it all.
  FittedModel (*fit_with)(const EffectTerm& term, const Regression& regression,
                          const JointFit& fit) = nullptr;
  /// The subject without the samples that the effect disturbed.
  std::shared_ptr<const Subject> (*cleaned)(const EffectTerm& term,
                                            const Current& current) = nullptr;

  // What it does to the variance.
  /// A course in each replicate that the logarithm of the noise's variance is proportional to.
  VarianceCourse (*variance_course)(const EffectTerm& term, const Subject& subject) = nullptr;
  /// Gives each replicate noise of its own, and the likelihood of that. `fit`: its own noise, if
  /// any, is where the search may begin.
  void (*own_noise)(const EffectTerm& term, const Regression& regression, JointFit& fit) = nullptr;

  // Simulation.
  /// Puts the term's truth into one replicate; every required truth is given.
  void (*simulate)(const EffectTerm& term, const SimulatedReplicate& at,
                   Eigen::VectorXd& samples) = nullptr;

  // Search and report.
  /// Where the term would explain most, a few suggestions at most.
  std::vector<Suggestion> (*search)(const SearchView& view) = nullptr;
  /// What only the fit of a suggestion shows: a better name, its price, what else it could be.
  void (*review)(const Current& current, TriedTerm& tried) = nullptr;
  /// What a fit found of it. Null: its coefficients, each with its error.
  std::vector<ReportedNumber> (*numbers)(const FittedEffect& effect) = nullptr;
  /// Beside those, what only the search knows; `first` come before the fitted ones, `last` after.
  void (*more_numbers)(const TriedTerm& tried, std::vector<ReportedNumber>& first,
                       std::vector<ReportedNumber>& last) = nullptr;
};

}  // namespace imunoise
