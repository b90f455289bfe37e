#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <variant>

#include "core/regression/fitted_model.h"
#include "core/search/evidence.h"

namespace imunoise {

/// Noise that may be missing.
struct NoiseChange {
  Model start;    ///< the whole noise with it, every value set
  Process added;  ///< it alone
  /// What another sensor feels of it, where it is shared.
  std::optional<EffectTerm> shared{};
};

/// A term of a model: of its noise, or beside it.
using AddedTerm = std::variant<EffectTerm, NoiseChange>;

/// How a suggestion takes a witness that may feel the same motion.
enum class MotionCoupling {
  kNone,
  kWhole,    ///< just as it is, at all frequencies,
  kBand,     ///< or at some
  kTurning,  ///< its change: gravity turns in it
};

/// What may be missing, as a search found it: a term that could be added, at the place where it
/// explains most. To first order only; the joint fit with it is what counts.
struct Suggestion {
  std::string_view cause;  ///< its id, see Cause
  AddedTerm added;
  double score_nats = 0.0;  ///< log-likelihood that it would gain, to first order, as it counts
  double dof = 1.0;         ///< coefficients, or powers, that it adds
  bool power = false;       ///< it is a power: one-sided
  /// How much more such a search gains by chance than under the fitted noise: likelihood gained
  /// counts divided by it.
  double inflation = 1.0;
  double noise_dof = INFINITY;  ///< degrees of freedom behind the inflation
  Search search{};
  /// 1/variance of its coefficient or power under the current noise; 0 where that has no meaning.
  double information = 0.0;
  /// Standard error of its frequency, Hz, or of the logarithm of its time constant; 0 where none.
  double shape_error = 0.0;
  bool backwards = false;  ///< a witness that explains more when it comes after its effect
  MotionCoupling coupling = MotionCoupling::kNone;
};

/// Each search suggests at most a few terms, the best of a kind, and also where that gains nothing
/// (score_nats is 0 then): every one is a chance of a false alarm.
using Suggestions = std::vector<Suggestion>;

/// A suggestion that was tried: fitted together with the current model.
struct TriedTerm {
  std::string cause;  ///< its id; the fit may show a better one than the search
  Suggestion suggestion;
  FittedModel fitted;            ///< the current model with it added
  double likelihood_gain = 0.0;  ///< nats
  double log_p = 0.0;            ///< logarithm of the p-value: noise makes this search gain as much
  double gain = 0.0;             ///< nats that it gains over what such a search gains by chance
  double noise_dof = 0.0;        ///< degrees of freedom behind the noise level there
  std::string shared_with{};     ///< noise: the witness that feels it too; empty where none does
  bool slow = false;             ///< an unrecorded temperature could have done it
  bool steady = true;            ///< noise: it is there all the time; jumps: between two levels
  /// It may be what wanders by itself, and is tested against that; once beyond it, all that it
  /// explains counts against what wanders.
  bool against_wander = false;
  double next_gain = 0.0;  ///< nats that one more of its kind gains, where two may belong together
  std::vector<std::string_view> could_be{};  ///< causes that its data cannot exclude

  /// The term, or null where it is noise.
  const EffectTerm* term() const { return std::get_if<EffectTerm>(&suggestion.added); }
};

}  // namespace imunoise
